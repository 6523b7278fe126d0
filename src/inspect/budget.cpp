#include "inspect/budget.h"

#include <cmath>
#include <regex>

#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"

namespace whit {

namespace {

constexpr double kMostMs = 1e9;
// Most pictures have between half and twice the modelled error.
constexpr double kModelError = 1;

}  // namespace

Budget parseBudget(const std::string& time, const std::string& target) {
  static const std::regex times("([0-9.]+)(ms|s|min)"), errors("flip=([0-9.e-]+)|([0-9.]+)codes");
  if (!time.empty() && !target.empty()) {
    throwUsage("--budget gives the time and --target the error: give one of them");
  }

  Budget budget;
  std::smatch parts;
  if (std::regex_match(time, parts, times) && readNumber(parts[1].str(), budget.ms)) {
    if (parts[2] == "s") budget.ms *= 1e3;
    if (parts[2] == "min") budget.ms *= 60e3;
  }
  if (!time.empty() && !(budget.ms >= 1 && budget.ms <= kMostMs)) {
    throwUsage("--budget: expected a time of at least 1 ms, as 50ms, 10s or 2min, found '" + time +
               "'");
  }

  if (std::regex_match(target, parts, errors)) {
    budget.inCodes = parts[2].matched;
    readNumber(parts[budget.inCodes ? 2 : 1].str(), budget.error);
  }
  if (!target.empty() && !(budget.error > 0 && budget.error <= (budget.inCodes ? 255 : 1))) {
    throwUsage("--target: expected an error above 0, as 0.5codes or flip=0.01, found '" + target +
               "'");
  }

  return budget;
}

void Receipt::setError(double value) {
  error = value;
  low = value / (1 + kModelError);
  high = value * (1 + kModelError);
}

std::string receiptText(const Receipt& r, const std::string& words) {
  const char* const unit = r.budget.inCodes ? "codes" : "FLIP";
  std::string text = "  chosen ";
  std::string options;
  for (const auto& [name, value] : r.chosen) options += " --" + name + " " + value;
  text += options.empty() ? "nothing: every option was given" : options.substr(1);

  text += "\n  left out";
  for (const Receipt::Knob& knob : r.approximate) {
    text += " " + knob.name + " " + knob.exact;
    if (knob.error > 0) text += formatted(" (%s %.4f)", unit, knob.error);
  }
  if (r.approximate.empty()) text += " nothing but samples";

  text += formatted("\n  time %.0f ms: %.0f to choose, %.0f for the picture (expected %.0f)",
                    r.usedMs(), r.probeMs, r.measuredMs, r.expectedMs);
  if (r.budget.ms > 0) text += formatted(", %.0f %% of the budget", 100 * r.usedMs() / r.budget.ms);

  text += formatted("\n  error %.4f %s, ", r.error, unit);
  text += std::isinf(r.high) ? "by what the samples tell; not known"
                             : formatted("between %.4f and %.4f", r.low, r.high);
  if (r.ended) text += formatted("; --depth and --cutoff left out at most %.4f", *r.ended);

  text += "\n";
  if (!r.note.empty()) text += "  note: " + r.note + "\n";
  // The options come first, because the user's words may end options by "--".
  if (!words.empty()) text += "  the same picture: whit render" + options + words + "\n";
  return text;
}

}  // namespace whit
