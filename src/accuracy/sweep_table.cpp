// A sweep as a table of text.
#include <algorithm>

#include "accuracy/report.h"
#include "core/formatted.h"

namespace whit::accuracy {

namespace {

std::string thousands(std::uint64_t rays) {
  return rays == 0 ? "-" : formatted("%.1f", static_cast<double>(rays) / 1e3);
}

std::string rowOf(const Point& point, std::size_t labelWidth) {
  const Timing& t = point.timing;
  std::string row =
      formatted("%-*s %s%9.2f %5.1f%s %8.2f", static_cast<int>(labelWidth), point.label().c_str(),
                point.onFront ? "*" : " ", t.settledMs, t.iqrPct, t.noisy() ? "~" : " ", t.ratio);
  for (const RayTally& tally : point.stats.meter.tally)
    row += formatted(" %8s", thousands(tally.rays).c_str());
  const ImageDifference& d = point.total;
  row += formatted("  %9.2e %9.2e %6.1f %7.2f %4d %8.5f %8.5f", d.rmse, d.relmse, d.psnrDb,
                   d.pixelsGe1CodePct, d.maxCode, d.flipMean, point.totalHdrFlip);
  if (point.sameSamples) {
    row += formatted("  %8.5f %7.3f %7.3f", point.sameSamples->flipMean,
                     point.sameSamples->pixelsGe1CodePct, point.sameSamples->pixelsGe2CodesPct);
  } else {
    row += formatted("  %8s %7s %7s", "-", "-", "-");
  }
  row += point.arithmetic ? formatted(" %7.1f", point.arithmetic->divergencesPerMpx)
                          : formatted(" %7s", "-");
  return row + formatted(" %5llu\n", static_cast<unsigned long long>(d.nonFinite));
}

std::string causesOf(const Point& point) {
  const auto line = [](const char* cause, const char* how, const ImageDifference& d) {
    return formatted(
        "  %-11s%9.2e RMSE %9.5f FLIP %8.3f %% off by a code or more, at most %d  %s\n", cause,
        d.rmse, d.flipMean, d.pixelsGe1CodePct, d.maxCode, how);
  };
  std::string text = "errors of '" + point.label() + "' by cause\n";
  text += line("sampling", "without approximations, against the reference", point.sampling);
  text += line("algorithm", "against the same without approximations", point.algorithm);
  if (point.arithmetic) {
    const ArithmeticError& a = *point.arithmetic;
    text += line("arithmetic", "packets against doubles, pixels of the same path", a.samePath);
    text += formatted(
        "  %-11s%llu pixels saw another surface (%.1f in a million); of the others "
        "half are within %.3g ulp, 99.9 %% within %.3g, all within %.3g\n",
        "", static_cast<unsigned long long>(a.divergences), a.divergencesPerMpx, a.medianUlp,
        a.ulp999, a.worstUlp);
  }
  return text;
}

}  // namespace

std::string referenceText(const SceneSweep& sweep) {
  return formatted(
      "reference: scalar, double precision, depth %d, cutoff %g, %d samples a pixel, "
      "%.1f s%s, %.8s",
      kDepthLimit, static_cast<double>(sweep.referenceCutoff), sweep.referenceSamples,
      sweep.referenceMs / 1e3, sweep.referenceFromFile ? " (by an earlier run)" : "",
      sweep.referenceDigest.c_str());
}

std::string sweepTable(const SceneSweep& sweep, std::uint32_t seed) {
  std::size_t width = 12;
  for (const Point& point : sweep.points) width = std::max(width, point.label().size());
  std::string text = formatted("%s, %dx%d, %d thread%s, %s, Embree %s\n%s\n", sweep.scene.c_str(),
                               sweep.width, sweep.height, sweep.machine.threads,
                               sweep.machine.threads == 1 ? "" : "s", sweep.machine.simd.c_str(),
                               sweep.machine.embree.c_str(), referenceText(sweep).c_str());
  const int label = static_cast<int>(width);
  text += formatted("\n%-*s  %25s %35s   %57s  %24s\n", label, "", "time", "thousand rays",
                    "against the reference", "at equal samples");
  text += formatted("%-*s  %9s %6s %8s", label, "", "ms", "IQR %", "x base");
  for (const char* kind : {"primary", "shadow", "reflect", "refract"})
    text += formatted(" %8s", kind);
  text += formatted("  %9s %9s %6s %7s %4s %8s %8s", "RMSE", "relMSE", "PSNR", ">=1 %", "max",
                    "FLIP", "HDR-FLIP");
  text += formatted("  %8s %7s %7s %7s %5s\n", "FLIP", ">=1 %", ">=2 %", "diverge/M", "inf");
  for (const Point& point : sweep.points) text += rowOf(point, width);
  text += formatted(
      "* on the front of FLIP over time; ~ noisy: half of the times spread over more "
      "than %g %%; measured in random order, seed %u\n\n",
      kNoisyPct, seed);
  text += causesOf(sweep.points.front());
  for (const IdleKnob& knob : sweep.idle)
    text += "not swept: " + knob.name + ": " + knob.because + "\n";
  return text;
}

}  // namespace whit::accuracy
