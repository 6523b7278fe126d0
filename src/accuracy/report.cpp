#include "accuracy/report.h"

#include <cstdint>

#include "core/formatted.h"

namespace whit::accuracy {

namespace {

std::string machineList(const std::vector<SceneSweep>& sweeps, const RunFacts& facts) {
  const Machine& machine = sweeps.front().machine;
  std::string html = "<h2>Machine and measurement</h2>\n<dl>\n";
  const auto row = [&](const char* name, const std::string& value) {
    html += "<dt>" + escaped(name) + "</dt><dd>" + escaped(value) + "</dd>\n";
  };
  row("processor", facts.cpu);
  row("cores, threads", formatted("%d, %d", facts.cores, machine.threads));
  row("kernels", machine.simd + formatted(", packets of %d", machine.packet));
  row("Embree", machine.embree);
  row("compiler", facts.compiler);
  row("sources", facts.commit);
  row("sweep", facts.full ? "full" : "quick");
  row("order",
      formatted("random, seed %u; every point between frames of the baseline", facts.seed));
  for (const SceneSweep& sweep : sweeps) {
    std::string order;
    for (const std::string& label : sweep.order) order += (order.empty() ? "" : ", ") + label;
    row(("order of " + sweep.scene).c_str(), order);
  }
  return html + "</dl>\n";
}

const char* const kIntroduction =
    "<p>Each scene is rendered with one knob of accuracy changed at a time and with the presets of "
    "<code>--quality</code>. Time is that of a frame, beside frames of the baseline. Error is the "
    "mean FLIP against a double-precision reference without approximations: how visible a "
    "difference "
    "is when two pictures alternate on a screen, 0 for none, 1 for the most (Andersson et al. "
    "2020).</p>\n";

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else
      safe += c;
  }
  return safe;
}

std::string dataUri(const std::string& png) {
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text = "data:image/png;base64,";
  text.reserve(text.size() + png.size() * 4 / 3 + 4);
  for (std::size_t i = 0; i < png.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < png.size() ? static_cast<unsigned char>(png[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= png.size() ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string reportHtml(const std::vector<SceneSweep>& sweeps, const RunFacts& facts) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<title>whit: what accuracy costs in time</title>\n<style>" +
      std::string(kReportStyle) + "</style></head>\n<body><main>\n" +
      "<h1>What accuracy costs in time</h1>\n" + kIntroduction + "<nav>";
  for (std::size_t i = 0; i < sweeps.size(); ++i)
    html += formatted("<a href=\"#s%zu\">%s</a>", i, escaped(sweeps[i].scene).c_str());
  html += "</nav>\n";
  for (std::size_t i = 0; i < sweeps.size(); ++i) html += sceneSection(sweeps[i], i);
  html += machineList(sweeps, facts);
  return html + "</main><script>" + kReportScript + "</script></body></html>\n";
}

}  // namespace whit::accuracy
