#include "viewer/knob_costs.h"

#include <algorithm>
#include <utility>

#include "core/option_values.h"

namespace whit::view {

namespace {

// Of every option, as on the command line.
std::map<std::string, std::string> valuesOf(const RenderOptions& options) {
  std::map<std::string, std::string> values;
  forEachOption(options, [&](const OptionSpec& spec, const auto& field) {
    const std::string value = formatValue(spec, field);
    values[std::string(spec.name)] = value.empty() ? "none" : value;
  });
  return values;
}

// Whether nothing but options can make the two cost different amounts.
bool comparable(const FrameRequest& a, FrameRequest b) {
  b.options = a.options;
  return sameSubject(a, b);
}

void append(std::string& list, const std::string& word) {
  list += (list.empty() ? "" : ", ") + word;
}

}  // namespace

void KnobCosts::learn(const TracedFrame& frame) {
  const FrameRequest& request = frame.request;
  if (!frame.costs.empty()) {
    measured_ = frame.costs;
    measuredFor_ = request;
  } else if (!comparable(measuredFor_, request)) {
    measured_.clear();
  }
  if (!request.interruptible || request.coarse || request.spp != request.options.spp) return;
  const auto before = std::exchange(baseline_, Baseline{request, frame.stats});
  if (!before || before->request.options.size != request.options.size ||
      !comparable(before->request, request)) {
    return;
  }
  const auto old = valuesOf(before->request.options), now = valuesOf(request.options);
  std::string name;
  KnobChange change{"", "", before->stats, frame.stats};
  for (const auto& [option, value] : now) {
    if (old.at(option) == value) continue;
    append(name, option);
    append(change.from, old.at(option));
    append(change.to, value);
  }
  if (name.empty()) return;
  lastChanged_ = name;
  changes_[name] = change;
}

void KnobCosts::learn(const UnfinishedFrame& frame) {
  measured_ = frame.costs;
  measuredFor_ = frame.request;
}

const KnobCost* KnobCosts::measured(const std::string& name) const {
  const auto found = std::find_if(measured_.begin(), measured_.end(),
                                  [&](const KnobCost& cost) { return cost.name == name; });
  return found == measured_.end() ? nullptr : &*found;
}

}  // namespace whit::view
