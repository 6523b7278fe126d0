#include "core/option_table.h"

#include <algorithm>
#include <type_traits>

#include "core/error.h"
#include "core/nearest_name.h"
#include "core/option_values.h"

namespace whit {

namespace {

// True if the values of the options, in their order, initialize a RenderOptions completely.
struct AreAllMembers {
  template <typename... Fields>
  constexpr auto operator()(const Option<Fields>&...) const {
    return std::bool_constant < requires { RenderOptions{std::declval<Fields&>()...}; }
    &&!requires { RenderOptions{std::declval<Fields&>()..., {}}; }
    > ();
  }
};
static_assert(
    decltype(withOptions(std::declval<RenderOptions&>(), AreAllMembers()))::value,
    "a member of RenderOptions or of ShadingChoices has no entry in withOptions(), or the "
    "entries are not in the order of the members");

// Calls visit(spec, field) for the option of this name.
template <typename Options, typename Visitor>
void visitOption(Options& options, const std::string& name, Visitor&& visit) {
  std::vector<std::string> names;
  bool found = false;
  forEachOption(options, [&](const OptionSpec& spec, auto& field) {
    names.emplace_back(spec.name);
    if (spec.name != name) return;
    found = true;
    visit(spec, field);
  });
  if (found) return;
  refuseFormerName(name);
  throwUsage("there is no option '" + name + "'" + didYouMean(name, names));
}

// Calls visit(spec, a's, b's) for each option.
template <typename A, typename B, typename Visitor>
void forEachPair(A& a, B& b, Visitor&& visit) {
  withOptions(a, [&](const auto&... ofA) {
    withOptions(b, [&](const auto&... ofB) { (visit(ofA.spec, ofA.field, ofB.field), ...); });
  });
}

}  // namespace

void refuseFormerName(const std::string& name) {
  for (const auto& [former, present] :
       {std::pair{"verdicts", "shadow-cache"}, std::pair{"ab-verdicts", "ab-shadow-cache"}}) {
    if (name == former) {
      throwUsage("--" + name + " is now called --" + present);
    }
  }
}

void setOption(RenderOptions& options, const std::string& name, const std::string& text) {
  visitOption(options, name,
              [&](const OptionSpec& spec, auto& field) { parseValue(spec, text, field); });
}

std::string optionText(const RenderOptions& options, const std::string& name) {
  std::string text;
  visitOption(options, name,
              [&](const OptionSpec& spec, const auto& field) { text = formatValue(spec, field); });
  return text;
}

std::vector<std::pair<std::string, std::string>> pictureOptions(const RenderOptions& options) {
  std::vector<std::pair<std::string, std::string>> said;
  forEachOption(options, [&](const OptionSpec& spec, const auto& field) {
    if (!spec.changesPicture) return;
    const std::string value = formatValue(spec, field);
    if (!value.empty()) said.emplace_back(spec.name, value);
  });
  return said;
}

Rebuild rebuildNeeded(const RenderOptions& a, const RenderOptions& b) {
  Rebuild needed = Rebuild::nothing;
  forEachPair(a, b, [&](const OptionSpec& spec, const auto& before, const auto& after) {
    if (!(before == after)) needed = std::max(needed, spec.rebuilds);
  });
  return needed;
}

void takeOver(const RenderOptions& from, Rebuild most, RenderOptions& to) {
  forEachPair(from, to, [&](const OptionSpec& spec, const auto& source, auto& target) {
    if (spec.rebuilds <= most) target = source;
  });
}

}  // namespace whit
