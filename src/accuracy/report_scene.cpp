// A scene's section of the report: verdicts, charts, pictures.
#include <algorithm>

#include "accuracy/pareto.h"
#include "accuracy/report.h"
#include "core/formatted.h"

namespace whit::accuracy {

namespace {

// What is called good enough, at equal samples.
constexpr double kWithinACodePct = 99.9, kGoodFlip = 0.01, kFastFlip = 0.03;

std::string verdict(bool holds, const std::string& claim, const std::string& found) {
  return formatted("<li class=\"%s\"><b>%s</b> %s: %s</li>\n", holds ? "holds" : "fails",
                   holds ? "&#10003;" : "&#10007;", claim.c_str(), escaped(found).c_str());
}

std::string saysOf(const Point& point) {
  std::string text = formatted(
      "%s: %.2f ms, %.2f times standard; FLIP %.5f and RMSE %.2e against "
      "the reference",
      point.label().c_str(), point.timing.settledMs, point.timing.ratio, point.total.flipMean,
      point.total.rmse);
  if (point.sameSamples) {
    text += formatted("; FLIP %.5f and %.2f %% of pixels off by a code or more at equal samples",
                      point.sameSamples->flipMean, point.sameSamples->pixelsGe1CodePct);
  }
  return text;
}

std::string gallery(const SceneSweep& sweep) {
  std::string html = "<div class=\"gallery\">\n";
  for (const Point& point : sweep.points) {
    if (point.imagePng.empty()) continue;
    const std::string label = escaped(point.label());
    html += formatted("<figure%s><button type=\"button\" aria-pressed=\"%s\" data-label=\"%s\" ",
                      point.onFront ? " class=\"front\"" : "",
                      point.kind == PointKind::baseline ? "true" : "false", label.c_str());
    html += "data-says=\"" + escaped(saysOf(point)) + "\" data-total=\"" +
            dataUri(point.totalMapPng) + "\"";
    if (!point.sameSamplesMapPng.empty())
      html += " data-same=\"" + dataUri(point.sameSamplesMapPng) + "\"";
    html += "><img alt=\"" + label + "\" src=\"" + dataUri(point.imagePng) + "\">";
    html += formatted("<figcaption><b>%s</b>%.2f ms, FLIP %.4f</figcaption></button></figure>\n",
                      label.c_str(), point.timing.settledMs, point.total.flipMean);
  }
  return html + "</div>\n";
}

std::string pictures(const SceneSweep& sweep) {
  const Point& base = sweep.points.front();
  if (base.imagePng.empty()) return {};
  std::string html =
      "<h3>Pictures</h3>\n<p class=\"screen\">Move over the left picture, or the "
      "slider, to wipe between a result and the reference; choose the result "
      "below.</p>\n<div class=\"compare\">\n<figure>\n";
  html += "<div class=\"wipe\"><img alt=\"reference\" src=\"" + dataUri(sweep.referencePng) +
          "\"><img class=\"over\" alt=\"result\" src=\"" + dataUri(base.imagePng) +
          "\"><span class=\"l\">" + escaped(base.label()) +
          "</span><span class=\"r\">reference</span></div>\n"
          "<div class=\"screen\"><input type=\"range\" min=\"0\" max=\"100\" value=\"50\" "
          "aria-label=\"wipe between result and reference\">"
          "<label class=\"toggle\"><input type=\"checkbox\"> let them blink in turn</label></div>\n"
          "<figcaption class=\"says\">" +
          escaped(saysOf(base)) + "</figcaption>\n</figure>\n<div>\n";
  const auto map = [&](const char* kind, const std::string& png, const char* caption) {
    html += formatted("<figure%s><img class=\"map\" data-kind=\"%s\" alt=\"heat map\" ",
                      png.empty() ? " hidden" : "", kind);
    if (!png.empty()) html += "src=\"" + dataUri(png) + "\"";
    html += formatted("><figcaption>%s</figcaption></figure>\n", caption);
  };
  html += "<div class=\"compare\">";
  map("total", base.totalMapPng,
      "Off the reference, in 8-bit codes (0 to 16, logarithmic, the same scale everywhere)");
  map("same", base.sameSamplesMapPng,
      "Off the exact picture with equal samples: what algorithm and arithmetic do");
  return html + "</div></div></div>\n" + gallery(sweep);
}

}  // namespace

std::string verdictList(const SceneSweep& sweep) {
  const Point& base = sweep.points.front();
  std::string html = "<ul class=\"verdicts\">\n";
  if (base.sameSamples) {
    const ImageDifference& d = *base.sameSamples;
    html += verdict(100 - d.pixelsGe2CodesPct >= kWithinACodePct && d.flipMean < kGoodFlip,
                    formatted("<i>%s</i> is within one code of the exact picture at equal samples "
                              "in %g %% of pixels, with a mean FLIP below %g",
                              escaped(base.label()).c_str(), kWithinACodePct, kGoodFlip),
                    formatted("%.3f %%, FLIP %.5f", 100 - d.pixelsGe2CodesPct, d.flipMean));
  }
  if (base.arithmetic) {
    const ArithmeticError& a = *base.arithmetic;
    html += verdict(a.samePath.maxCode <= 1,
                    "arithmetic alone moves no pixel of the same path by more than a code",
                    formatted("at most %d; %llu pixels saw another surface", a.samePath.maxCode,
                              static_cast<unsigned long long>(a.divergences)));
  }
  const Point* fast = nullptr;
  for (const Point& point : sweep.points) {
    if (!point.sameSamples || point.sameSamples->flipMean >= kFastFlip) continue;
    if (!fast || point.timing.ratio < fast->timing.ratio) fast = &point;
  }
  if (fast) {
    html +=
        verdict(fast->timing.ratio <= 0.5,
                formatted("half the time with a mean FLIP below %g at equal samples", kFastFlip),
                formatted("the cheapest is %s, %.2f times the time, FLIP %.5f",
                          fast->label().c_str(), fast->timing.ratio, fast->sameSamples->flipMean));
  }
  return html + "</ul>\n";
}

std::string sceneSection(const SceneSweep& sweep, std::size_t number) {
  std::string html =
      formatted("<section id=\"s%zu\"><h2>%s</h2>\n", number, escaped(sweep.scene).c_str());
  html += formatted("<p class=\"soft\">%dx%d pixels; %s</p>\n", sweep.width, sweep.height,
                    escaped(referenceText(sweep)).c_str());
  html += verdictList(sweep);
  html += "<h3>What accuracy costs</h3>\n" + paretoSvg(sweep, Against::reference);
  html += paretoSvg(sweep, Against::sameSamples);
  html += pictures(sweep);
  html += "<h3>Every point</h3>\n" + pointTable(sweep);
  html += "<h3>Errors by cause</h3>\n" + causeTable(sweep);
  if (!sweep.stages.empty())
    html += "<h3>Stages against their scalar twins</h3>\n" + stageTable(sweep);
  if (!sweep.idle.empty()) {
    html += "<h3>Not swept</h3>\n<dl>\n";
    for (const IdleKnob& knob : sweep.idle)
      html += "<dt>" + escaped(knob.name) + "</dt><dd>" + escaped(knob.because) + "</dd>\n";
    html += "</dl>\n";
  }
  return html + "</section>\n";
}

}  // namespace whit::accuracy
