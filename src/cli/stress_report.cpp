#include "cli/stress_report.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

#include "accuracy/report.h"
#include "core/display.h"
#include "core/formatted.h"
#include "io/image/image_file.h"

namespace whit::cli {

namespace {

bool closer(const StressRow& a, const StressRow& b) {
  if (a.finding.holds() != b.finding.holds()) return !a.finding.holds();
  return a.finding.worst() > b.finding.worst();
}

using accuracy::escaped;

std::string number(double value) { return std::isinf(value) ? "-" : formatted("%.4g", value); }

// Without a bound there is nothing to hold.
bool isReported(const StressRow& row) { return std::isinf(row.finding.bound()); }

const char* holdsText(const StressRow& row) {
  if (!row.finding.holds()) return "BROKEN";
  return isReported(row) ? "reported" : "yes";
}

std::string packetText(const stress::Setup& setup) {
  return setup.packet == 0 ? "auto" : std::to_string(setup.packet);
}

constexpr const char* kStyle =
    "<style>:root{color-scheme:light dark}"
    "body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:75rem;padding:0 1rem}"
    "table{border-collapse:collapse;width:100%}"
    "th,td{text-align:left;padding:.3rem .6rem;border-bottom:1px solid #8884;vertical-align:top}"
    "td.n{text-align:right;font-variant-numeric:tabular-nums;white-space:nowrap}"
    "small{opacity:.7}code{font-size:.8em;overflow-wrap:anywhere}"
    ".pictures{display:grid;grid-template-columns:repeat(auto-fill,minmax(10rem,1fr));gap:.6rem}"
    "figure{margin:0}figure img{width:100%}figcaption{font-size:.85em;opacity:.8}"
    "tr.broken td{background:#d3222233}tr.family th{padding-top:1.2rem}</style>";

}  // namespace

std::vector<StressRow> worstRows(const std::vector<StressRow>& rows) {
  std::vector<StressRow> worst;
  for (const StressRow& row : rows) {
    if (worst.empty() || worst.back().hardCase != row.hardCase) {
      worst.push_back(row);
    } else if (closer(row, worst.back())) {
      worst.back() = row;
    }
  }
  return worst;
}

std::string stressTable(const std::vector<StressRow>& rows) {
  std::string text = "case   worst       bound       holds     simd   packet  what must hold\n";
  for (const StressRow& row : worstRows(rows)) {
    text += formatted("%-6s %-11s %-11s %-9s %-6s %-7s %s\n", row.hardCase->name.data(),
                      number(row.finding.worst()).c_str(), number(row.finding.bound()).c_str(),
                      holdsText(row), row.setup.simd.c_str(), packetText(row.setup).c_str(),
                      row.hardCase->title.data());
    if (!row.finding.holds()) text += "       input: " + row.finding.input() + "\n";
  }
  return text + stressSummary(rows) + "\n";
}

std::string stressSummary(const std::vector<StressRow>& rows) {
  std::size_t held = 0, broken = 0, reported = 0;
  for (const StressRow& row : worstRows(rows)) {
    ++(!row.finding.holds() ? broken : isReported(row) ? reported : held);
  }
  std::string text = formatted("%zu cases in %zu runs: %zu hold, %zu broken",
                               held + broken + reported, rows.size(), held, broken);
  if (reported > 0) text += formatted(", %zu reported without a bound", reported);
  return text;
}

Json stressJson(const Machine& machine, const std::vector<StressRow>& rows) {
  Json cases = Json::array();
  for (const StressRow& row : rows) {
    const double worst = row.finding.worst(), bound = row.finding.bound();
    const auto finite = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
    cases.push_back({{"case", row.hardCase->name},
                     {"title", row.hardCase->title},
                     {"family", row.family},
                     {"input", row.finding.input()},
                     {"worst", finite(worst)},
                     {"bound", finite(bound)},
                     {"margin", finite(bound - worst)},
                     {"simd", row.setup.simd},
                     {"packet", row.setup.packet == 0 ? Json("auto") : Json(row.setup.packet)},
                     {"tried", row.finding.seen()},
                     {"holds", row.finding.holds()}});
  }
  return {{"machine", machineJson(machine)}, {"cases", cases}};
}

std::string stressHtmlTable(const std::vector<StressRow>& rows) {
  std::string html =
      "<table><thead><tr><th>case<th>what must hold<th>worst<th>bound<th>holds<th>at<th>worst input"
      "</tr></thead><tbody>\n";
  std::string_view family;
  for (const StressRow& row : worstRows(rows)) {
    if (row.family != family) {
      family = row.family;
      html += "<tr class=family><th colspan=7>" + escaped(family) + "</th></tr>\n";
    }
    html += std::string("<tr") + (row.finding.holds() ? "" : " class=broken") + "><td>" +
            escaped(row.hardCase->name) + "<td>" + escaped(row.hardCase->title) + "<br><small>" +
            escaped(row.hardCase->construction) + "</small><td class=n>" +
            number(row.finding.worst()) + "<td class=n>" + number(row.finding.bound()) + "<td>" +
            holdsText(row) + "<td>" + row.setup.simd + ", " + packetText(row.setup) + "<td><code>" +
            escaped(row.finding.input()) + "</code></tr>\n";
  }
  return html + "</tbody></table>\n";
}

std::string stressHtml(const Machine& machine, const std::vector<StressRow>& rows,
                       const std::vector<StressPicture>& pictures) {
  const Json facts = machineJson(machine);
  std::string html =
      "<!doctype html><html lang=en><meta charset=utf-8>"
      "<meta name=viewport content=\"width=device-width,initial-scale=1\">"
      "<title>whit: hard cases</title>" +
      std::string(kStyle) + "<h1>Hard cases</h1><p>";
  for (const auto& [key, value] : facts.items()) {
    html +=
        escaped(key + ": " + (value.is_string() ? value.get<std::string>() : value.dump())) + "; ";
  }
  html += "</p><p>" + stressSummary(rows) + ".</p>\n<div class=pictures>";
  for (const StressPicture& picture : pictures) {
    html += "<figure><img alt=\"" + escaped(picture.name) + "\" src=\"" +
            accuracy::dataUri(encodePng(toDisplay(picture.image, 0, ToneCurve::none))) +
            "\"><figcaption>" + escaped(picture.name) + "</figcaption></figure>";
  }
  return html + "</div>\n" + stressHtmlTable(rows) + "</html>\n";
}

std::vector<StressRow> runCatalogue(const std::vector<std::string>& only, Progress* progress) {
  std::vector<StressRow> rows;
  const std::vector<stress::Family> families = stress::families();
  std::size_t count = 0, done = 0;
  for (const stress::Family& family : families) count += family.cases.size();
  for (const stress::Family& family : families) {
    for (const stress::Case& c : family.cases) {
      reportProgress(progress, std::string(c.name),
                     static_cast<double>(done++) / static_cast<double>(count));
      if (!only.empty() && std::find(only.begin(), only.end(), c.name) == only.end()) continue;
      for (const stress::Setup& setup : stress::setupsOf(c.runs)) {
        rows.push_back({family.name, &c, setup, stress::runCase(c, setup)});
      }
    }
  }
  return rows;
}

}  // namespace whit::cli
