// A scene's section of the report: verdicts, charts, pictures.
#include <algorithm>

#include "accuracy/cause_chart.h"
#include "accuracy/choice.h"
#include "accuracy/front_chart.h"
#include "accuracy/knob_chart.h"
#include "accuracy/report.h"
#include "core/formatted.h"

namespace whit::accuracy {

namespace {

// What is called good enough, at equal samples.
constexpr double kWithinACodePct = 99.9, kGoodFlip = 0.01, kFastFlip = 0.03;

// Of the tables; before the first of them.
const char* const kReportWords =
    "<dl class=\"words\">"
    "<dt>FLIP</dt><dd>how visible a difference is, the mean over the pixels; HDR-FLIP (2021) is "
    "the "
    "worst over a range of exposures</dd>"
    "<dt>RMSE</dt><dd>root of the mean squared difference of linear radiance: how far off the "
    "light "
    "is, seen or not; a few bright pixels decide it. relMSE: the mean of squared differences over "
    "squares of the reference. PSNR: of displayed values, in dB</dd>"
    "<dt>code</dt><dd>one of the 256 steps of an 8-bit sRGB channel: the least that a picture on a "
    "screen can differ by</dd>"
    "<dt>at equal samples</dt><dd>against the exact picture with as many samples a pixel: with one "
    "sample the steps at edges outweigh everything else; here they cancel</dd>"
    "<dt>path divergence</dt><dd>a pixel whose rays meet an edge or pass a cutoff within rounding, "
    "so "
    "that packets and reference see another surface (the columns <i>other path</i>)</dd></dl>\n";

std::string verdict(bool holds, const std::string& claim, const std::string& found) {
  return formatted("<li class=\"%s\"><b>%s</b> %s: %s</li>\n", holds ? "holds" : "fails",
                   holds ? "&#10003;" : "&#10007;", claim.c_str(), escaped(found).c_str());
}

// Every point's picture, as the choice for the place where it stands beside the reference.
std::string gallery(const SceneSweep& sweep, std::size_t number) {
  std::string html = "<details class=\"gallery\"><summary>All pictures</summary>\n<div>\n";
  for (const Point& point : sweep.points) {
    if (point.imagePng.empty()) continue;
    const std::string label = escaped(point.label());
    html +=
        formatted("<figure id=\"%s\"%s><button type=\"button\" aria-pressed=\"%s\" ",
                  pictureId(number, sweep, point).c_str(), point.onFront ? " class=\"front\"" : "",
                  point.kind == PointKind::baseline ? "true" : "false");
    html += "data-label=\"" + label + "\" data-says=\"" + escaped(numbersOf(point)) +
            "\" data-total=\"" + dataUri(point.totalMapPng) + "\"";
    if (!point.sameSamplesMapPng.empty())
      html += " data-same=\"" + dataUri(point.sameSamplesMapPng) + "\"";
    html += "><img alt=\"" + label + "\" src=\"" + dataUri(point.imagePng) + "\">";
    html += formatted("<figcaption><b>%s</b>%.2f ms, FLIP %.4f</figcaption></button></figure>\n",
                      label.c_str(), point.timing.settledMs, point.total.flipMean);
  }
  return html + "</div></details>\n";
}

// A result beside the reference, and where they differ: the baseline's until another is chosen.
std::string pictures(const SceneSweep& sweep) {
  const Point& base = sweep.points.front();
  if (base.imagePng.empty()) return {};
  std::string html = "<figure class=\"beside\">\n";
  const std::string truth = sweep.transport ? "all transport" : "reference";
  html += "<div class=\"wipe\"><img alt=\"" + truth + "\" src=\"" + dataUri(sweep.truthPng) +
          "\"><img class=\"over\" alt=\"result\" src=\"" + dataUri(base.imagePng) +
          "\"><span class=\"l\">" + escaped(base.label()) + "</span><span class=\"r\">" + truth +
          "</span></div>\n"
          "<div class=\"screen\"><input type=\"range\" min=\"0\" max=\"100\" value=\"50\" "
          "aria-label=\"wipe between result and reference\">"
          "<label class=\"toggle\"><input type=\"checkbox\"> let them blink in turn</label></div>\n"
          "<figcaption class=\"says\">" +
          escaped(numbersOf(base)) + "</figcaption>\n";
  const auto map = [&](const char* kind, const std::string& png, const char* caption) {
    html += formatted("<figure%s><img class=\"map\" data-kind=\"%s\" alt=\"heat map\" ",
                      png.empty() ? " hidden" : "", kind);
    if (!png.empty()) html += "src=\"" + dataUri(png) + "\"";
    html += formatted("><figcaption>%s</figcaption></figure>\n", caption);
  };
  html += "<div class=\"pair\">";
  map("total", base.totalMapPng,
      "Off the reference, in codes, the steps of an 8-bit sRGB channel (0 to 16, logarithmic, the "
      "same scale everywhere)");
  map("same", base.sameSamplesMapPng,
      "Off the exact picture with equal samples: what algorithm and arithmetic do");
  return html + "</div></figure>\n";
}

std::string knobCharts(const SceneSweep& sweep, std::size_t number) {
  const std::vector<const Point*> chosen = chosenPoints(sweep);
  if (chosen.empty()) return {};
  const ChartLinks links{number, ""};
  std::string html = "<div class=\"glance\"><div>\n" + knobSvg(sweep, chosen, links);
  html += formatted(
      "<p class=\"soft\">Of each knob the value that saves the most time with no visible harm "
      "(FLIP "
      "up by less than %g); where none saves time, the one with the least error. Click a row to "
      "see "
      "its picture beside the reference.</p>\n",
      kVisibleFlip);
  if (namedPoints(sweep).size() > chosen.size()) {
    html += "<details><summary>All values of all knobs</summary>\n" +
            knobSvg(sweep, namedPoints(sweep), links) + "</details>\n";
  }
  return html + "</div>\n" + pictures(sweep) + "</div>\n";
}

}  // namespace

std::string spreadText(const Timing& timing) {
  if (timing.hasSpread()) return formatted("%.2f to %.2f", timing.ratioLow, timing.ratioHigh);
  return timing.frames == 1 ? "one frame" : "few frames";
}

std::string numbersOf(const Point& point) {
  const Timing& t = point.timing;
  std::string text = formatted("%s: %.2f ms, %.2f times the baseline", point.label().c_str(),
                               t.settledMs, t.ratio);
  text += " (" + spreadText(t) + ")";
  text += formatted("; FLIP %.5f against %s", point.total.flipMean,
                    point.transport ? "all transport" : "the reference");
  if (point.sameSamples) {
    text += formatted("; at equal samples FLIP %.5f, and %.2f %% of pixels off by a code or more",
                      point.sameSamples->flipMean, point.sameSamples->pixelsGe1CodePct);
  }
  return text;
}

std::string verdictList(const SceneSweep& sweep) {
  const Point& base = sweep.points.front();
  std::string html = "<ul class=\"verdicts\">\n";
  if (base.sameSamples) {
    const ImageDifference& d = *base.sameSamples;
    html += verdict(100 - d.pixelsGe2CodesPct >= kWithinACodePct && d.flipMean < kGoodFlip,
                    formatted("<i>%s</i> is within one code (a step of an 8-bit sRGB channel) of "
                              "the exact picture at equal samples in %g %% of pixels, with a mean "
                              "FLIP below %g",
                              escaped(base.label()).c_str(), kWithinACodePct, kGoodFlip),
                    formatted("%.3f %%, FLIP %.5f", 100 - d.pixelsGe2CodesPct, d.flipMean));
  }
  if (base.arithmetic) {
    const ArithmeticError& a = *base.arithmetic;
    html += verdict(
        a.samePath.maxCode <= 1,
        "arithmetic alone moves no pixel of the same path by more than a code",
        formatted("at most %d; path divergences (pixels where rounding at an edge or a cutoff "
                  "led to another surface): %llu",
                  a.samePath.maxCode, static_cast<unsigned long long>(a.divergences)));
  }
  const Point* fast = nullptr;
  for (const Point& point : sweep.points) {
    if (!point.sameSamples || point.sameSamples->flipMean >= kFastFlip) continue;
    if (!point.timing.hasSpread()) continue;
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
  if (sweep.transport) {
    html += "<p class=\"soft\">" + escaped(transportText(sweep)) + "</p>\n<p class=\"choice\">" +
            escaped(choiceText(sweep)) + "</p>\n";
  }
  html += knobCharts(sweep, number) + verdictList(sweep);
  const ChartLinks links{number, ""};
  html +=
      "<h3>Which choices are worth their time</h3>\n"
      "<p class=\"soft\">A point on the line has no other that is both faster and better. The "
      "first "
      "chart has the whole error, the second what depth, cutoffs and rounding do at equal "
      "samples.</p>\n<div class=\"pair\">" +
      frontSvg(sweep, Against::reference, links) + frontSvg(sweep, Against::sameSamples, links) +
      "</div>\n";
  html += gallery(sweep, number);
  html += "<h3>Every point</h3>\n";
  if (number == 0) html += kReportWords;
  html += pointTable(sweep);
  html += "<h3>Errors by cause</h3>\n" + causeSvg(sweep, links) + causeTable(sweep);
  if (!sweep.stages.empty())
    html += "<h3>Stages against their scalar twins</h3>\n" + stageTable(sweep);
  if (!sweep.idle.empty()) {
    html += "<h3>Not swept</h3>\n<dl>\n";
    for (const IdleKnob& group : groupedByReason(sweep.idle))
      html += "<dt>" + escaped(group.because) + "</dt><dd>" + escaped(group.name) + "</dd>\n";
    html += "</dl>\n";
  }
  return html + "</section>\n";
}

}  // namespace whit::accuracy
