// The report's tables.
#include <algorithm>
#include <cmath>

#include "accuracy/report.h"
#include "core/formatted.h"

namespace whit::accuracy {

namespace {

std::string cell(const std::string& text) { return "<td>" + text + "</td>"; }
template <typename Value, typename... Values>
std::string cell(const char* format, Value value, Values... values) {
  return cell(formatted(format, value, values...));
}

// A number with a bar behind it, as long as `share` of the cell.
std::string barCell(const std::string& text, double share) {
  return formatted("<td class=\"bar\" style=\"--v:%.1f%%\">%s</td>",
                   100 * std::clamp(share, 0.0, 1.0), text.c_str());
}

// Where a value lies between the least and the most of its column, in logarithms.
struct LogRange {
  double least = HUGE_VAL, most = 0;
  void include(double value) {
    if (value > 0) least = std::min(least, value), most = std::max(most, value);
  }
  double share(double value) const {
    if (!(value > 0)) return 0;
    if (!(most > least)) return 1;
    return 0.04 + 0.96 * std::log(value / least) / std::log(most / least);
  }
};

std::string differenceCells(const ImageDifference* d) {
  if (!d) return cell("") + cell("") + cell("") + cell("");
  return cell("%.5f", d->flipMean) + cell("%.2e", d->rmse) + cell("%.3f", d->pixelsGe1CodePct) +
         cell("%.3f", d->pixelsGe2CodesPct);
}

std::string rowOf(const Point& point, const LogRange& times, const LogRange& errors) {
  const Timing& t = point.timing;
  const char* const kind = point.kind == PointKind::baseline ? "base" : "";
  std::string html = formatted("<tr class=\"%s %s\">", point.onFront ? "front" : "", kind);
  html += cell(escaped(point.label()));
  html += barCell(formatted("%.2f", t.settledMs), times.share(t.settledMs));
  html += formatted("<td%s>%s%s</td>", t.noisy() ? " class=\"noisy\"" : "",
                    t.hasSpread() ? formatted("%.1f", t.spreadPct()).c_str() : "unknown",
                    t.hasSpread() && t.noisy() ? " noisy" : "");
  html += cell("%d", t.frames) + cell("%.2f", t.ratio);
  for (const RayTally& tally : point.stats.meter.tally)
    html += cell(tally.rays ? formatted("%.1f", static_cast<double>(tally.rays) / 1e3) : "");
  const ImageDifference& d = point.total;
  html += barCell(formatted("%.5f", d.flipMean), errors.share(d.flipMean));
  html += cell("%.5f", point.totalHdrFlip) + cell("%.2e", d.rmse) + cell("%.2e", d.relmse) +
          cell("%.1f", d.psnrDb) + cell("%.2f", d.pixelsGe1CodePct) + cell("%d", d.maxCode) +
          cell("%.5f", d.energyRatio);
  html += differenceCells(point.sameSamples ? &*point.sameSamples : nullptr);
  html += cell("%llu", static_cast<unsigned long long>(d.nonFinite));
  return html + "</tr>\n";
}

}  // namespace

std::string pointTable(const SceneSweep& sweep) {
  const std::string head =
      "<thead><tr class=\"groups\"><th></th><th colspan=\"4\">time</th>"
      "<th colspan=\"4\">thousand rays</th><th colspan=\"8\">against " +
      std::string(sweep.transport ? "all transport" : "the reference") +
      "</th>"
      "<th colspan=\"4\">at equal samples</th><th></th></tr>\n"
      "<tr><th>point</th><th>ms</th><th>&plusmn; %</th><th>frames</th><th>&times; base</th>"
      "<th>primary</th><th>shadow</th><th>reflected</th><th>refracted</th><th>FLIP</th>"
      "<th>HDR-FLIP</th><th>RMSE</th><th>relMSE</th><th>PSNR</th><th>&ge;1 code %</th>"
      "<th>max code</th><th>energy</th><th>FLIP</th><th>RMSE</th><th>&ge;1 code %</th>"
      "<th>&ge;2 codes %</th><th>not finite</th></tr></thead>\n";
  LogRange times, errors;
  for (const Point& point : sweep.points) {
    times.include(point.timing.settledMs);
    errors.include(point.total.flipMean);
  }
  std::string named, joint;
  for (const Point& point : sweep.points)
    (point.kind == PointKind::joint ? joint : named) += rowOf(point, times, errors);
  std::string html = "<div class=\"scroll\"><table>" + head + "<tbody>\n" + named +
                     "</tbody><caption>&#9679; on the front of FLIP over time. Times are the "
                     "median ratio to the baseline's frames before and after, times the "
                     "baseline's median: what the machine does to both cancels. &plusmn;: half "
                     "the interval that holds the median with 90 % confidence, over the median; " +
                     formatted(
                         "noisy above %g %%; unknown with fewer than %d rounds, and then on "
                         "no front",
                         kNoisyPct, kLeastRounds) +
                     ".</caption></table></div>\n";
  if (!joint.empty()) {
    html += "<details><summary>Combinations of knobs</summary><div class=\"scroll\"><table>" +
            head + "<tbody>\n" + joint + "</tbody></table></div></details>\n";
  }
  return html;
}

std::string causeTable(const SceneSweep& sweep) {
  std::string html =
      "<div class=\"scroll\"><table><thead><tr class=\"groups\"><th></th>"
      "<th colspan=\"3\">sampling</th><th colspan=\"3\">algorithm</th>"
      "<th colspan=\"3\">arithmetic, same path</th>" +
      std::string(sweep.transport ? "<th colspan=\"3\">transport</th>" : "") +
      "<th colspan=\"3\">ulps of a pixel</th>"
      "<th colspan=\"2\">other path</th></tr><tr><th>point</th>";
  for (int i = 0; i < (sweep.transport ? 4 : 3); ++i)
    html += "<th>FLIP</th><th>RMSE</th><th>max code</th>";
  html +=
      "<th>median</th><th>99.9 %</th><th>worst</th><th>pixels</th><th>in a million</th></tr>"
      "</thead><tbody>\n";
  const auto group = [](const ImageDifference* d) {
    if (!d) return cell("") + cell("") + cell("");
    return cell("%.5f", d->flipMean) + cell("%.2e", d->rmse) + cell("%d", d->maxCode);
  };
  for (const Point& point : sweep.points) {
    if (point.kind == PointKind::joint && !point.onFront) continue;
    const ArithmeticError* a = point.arithmetic ? &*point.arithmetic : nullptr;
    html += point.kind == PointKind::baseline ? "<tr class=\"base\">" : "<tr>";
    html += cell(escaped(point.label())) + group(&point.sampling) + group(&point.algorithm) +
            group(a ? &a->samePath : nullptr);
    if (sweep.transport) html += group(point.transport ? &*point.transport : nullptr);
    html += a ? cell("%.3g", a->medianUlp) + cell("%.3g", a->ulp999) + cell("%.3g", a->worstUlp) +
                    cell("%llu", static_cast<unsigned long long>(a->divergences)) +
                    cell("%.1f", a->divergencesPerMpx)
              : cell("") + cell("") + cell("") + cell("") + cell("");
    html += "</tr>\n";
  }
  return html +
         "</tbody><caption>Sampling: the pipeline without approximations, at the point's samples, "
         "against what more of them lead to. Algorithm: the point against the same without "
         "approximations. Arithmetic: packets in single against the scalar reference in double "
         "precision, same "
         "options, same samples; pixels that saw another triangle, shadow or impulse anywhere on "
         "their way are counted as another path and left out of the rest. Empty: not measured, "
         "because the knob does not touch arithmetic." +
         (sweep.transport ? " Transport, what the model leaves out: what more samples of the point "
                            "lead to, the reference or where it has all transport that picture, "
                            "against the picture with all transport."
                          : "") +
         "</caption></table></div>\n";
}

std::string stageTable(const SceneSweep& sweep) {
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th>stage</th><th>column</th><th>values</th>"
      "<th>worst ulp</th><th>limit</th><th>at pixel</th><th>depth</th></tr></thead><tbody>\n";
  for (const StageDifference& row : sweep.stages) {
    html += "<tr>" + cell(std::string(kStageNames[static_cast<std::size_t>(row.stage)])) +
            cell(escaped(row.column)) + cell("%llu", static_cast<unsigned long long>(row.slots)) +
            formatted("<td%s>%.3g</td>", row.worstUlp > row.limitUlp ? " class=\"over\"" : "",
                      row.worstUlp) +
            cell("%.3g", row.limitUlp) + cell("%d, %d", row.pixelX, row.pixelY) +
            cell("%d", row.depth) + "</tr>\n";
  }
  return html +
         "</tbody><caption>The worst difference between a vector stage and its scalar twin on the "
         "same input, in units of the last place of the column's magnitude.</caption></table>"
         "</div>\n";
}

}  // namespace whit::accuracy
