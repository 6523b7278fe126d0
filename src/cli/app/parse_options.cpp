#include "cli/app/parse_options.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "cli/app/completion.h"
#include "cli/app/help_text.h"
#include "cli/app/man_page.h"
#include "core/error.h"
#include "core/nearest_name.h"
#include "core/option_table.h"

namespace whit::cli {

namespace {

bool looksLikeOption(const std::string& word) { return word.size() > 1 && word[0] == '-'; }

[[noreturn]] void throwUnknownOption(const std::string& word, const OptionList& list) {
  std::vector<std::string> names{"--help", "--help-all"};
  for (const OptionList::Entry& e : list.entries) names.push_back("--" + e.name);
  const std::string name = word.substr(0, word.find('='));
  throwUsage("there is no option '" + name + "'; nearest: '" + nearestName(name, names) + "'");
}

// The parser says "--size: 1 required TEXT missing".
[[noreturn]] void throwNoValue(const std::string& said, const OptionList& list) {
  const std::string name = said.substr(0, said.find(':'));
  for (const OptionList::Entry& e : list.entries) {
    if (name == "--" + e.name && !e.placeholder.empty()) {
      throwUsage(name + ": expected " + e.placeholder + " after it");
    }
  }
  throwUsage(said);
}

std::string optionNames(const OptionList::Entry& entry) {
  return (entry.shortName.empty() ? "" : "-" + entry.shortName + ",") + "--" + entry.name;
}

// The parser for `list`, with its options in the order of list.entries.
std::vector<CLI::Option*> declare(CLI::App& app, const OptionList& list) {
  app.allow_extras();
  app.set_help_flag("-h,--help");
  app.set_help_all_flag("--help-all");
  std::vector<CLI::Option*> options;
  for (const OptionList::Entry& entry : list.entries) {
    CLI::Option* option = nullptr;
    if (entry.placeholder.empty()) {
      option = app.add_flag(optionNames(entry));
    } else {
      option = app.add_option(optionNames(entry), CLI::callback_t());
    }
    option->multi_option_policy(entry.repeats ? CLI::MultiOptionPolicy::TakeAll
                                              : CLI::MultiOptionPolicy::TakeLast);
    options.push_back(option);
  }
  return options;
}

// What stands alone; an unknown option among it is an error. Words after "--" are never options.
void takeOperands(const std::vector<std::string>& rest, const OptionList& list) {
  bool onlyOperands = false;
  std::vector<std::string> operands;
  for (const std::string& word : rest) {
    if (!onlyOperands && word == "--") {
      onlyOperands = true;
    } else if (!onlyOperands && looksLikeOption(word)) {
      throwUnknownOption(word, list);
    } else {
      operands.push_back(word);
    }
  }
  const OptionList::Operand& wanted = list.operand;
  if (operands.size() < wanted.least) {
    throwUsage("expected " + wanted.placeholder + ": " + wanted.help);
  }
  if (operands.size() > wanted.most) {
    throwUsage("one word too many: '" + operands[wanted.most] + "'");
  }
  if (wanted.values) *wanted.values = operands;
}

}  // namespace

void listReportOptions(OptionList& list, CommonOptions& common) {
  list.group("Reporting");
  list.flag("quiet", "nothing on standard error but errors", common.quiet);
  list.value({"progress", "auto|never"}, "progress bar (auto: on a terminal)", common.progress);
}

void listCommonOptions(OptionList& list, CommonOptions& common) {
  list.group("Rendering");
  forEachOption(common.render, [&](const OptionSpec& spec, auto& field) {
    OptionList::Entry& entry = list.value(spec, std::string(spec.help), field);
    entry.everyday = spec.everyday;
    entry.set = [set = std::move(entry.set), &common, name = entry.name](const std::string& text) {
      set(text);
      common.given.insert(name);
    };
  });
  list.group("Loading");
  list.flag("allow-outside", "the scene may name files outside its own folder",
            common.load.allowOutside)
      .everyday = false;
  list.many(
      {"set", "POINTER=VALUE"},
      "a member of the scene's description, by JSON pointer, and what it is to be instead, in "
      "JSON: /lights/0/intensity=40; may be repeated",
      common.load.settings);
  list.value({"sky", "FILE"},
             "what is around the scene in place of its own sky: nothing, a studio with soft boxes "
             "to be mirrored, or an equirectangular image (default: the scene's own; of models the "
             "studio)",
             common.load.sky)
      .placeholder = "none|studio|FILE";
  list.value({"time", "SECONDS", -1e9, 1e9},
             "the instant at which animations and the camera's path are looked at (default: models "
             "stand as their files have them, without animations)",
             common.load.instant.seconds);
  list.value({"animation", "NAME"},
             "which animation of models is played (default: the first of each)",
             common.load.instant.animation);
  list.value({"max-memory", "GB", 0.001, 1e6}, "what geometry and images may take",
             common.maxMemoryGb)
      .everyday = false;
  listReportOptions(list, common);
}

void settleOptions(CommonOptions& common) {
  applyQuality(common.render, common.given);
  common.load.threads = common.render.threads;
  common.load.sphereSegments = common.render.sphereSegments;
  common.load.maxMemoryBytes = static_cast<std::uint64_t>(common.maxMemoryGb * 1e9);
}

Parsed parseOptions(const std::string& usage, const std::string& summary, const OptionList& list,
                    const std::vector<std::string>& words) {
  if (words == std::vector<std::string>{"--man"}) {
    std::fputs(manOptions(usage, summary, list).c_str(), stdout);
    return Parsed::helpShown;
  }
  if (words.size() == 4 && words[0] == "--completion") {
    std::fputs(completionOptions(shellNamed(words[1]), words[2], words[3], list).c_str(), stdout);
    return Parsed::helpShown;
  }
  CLI::App app;
  const std::vector<CLI::Option*> options = declare(app, list);
  const auto showHelp = [&](HelpTier tier) {
    std::fputs(helpText(usage, summary, list, tier, helpWidth()).c_str(), stdout);
  };
  try {
    std::vector<std::string> reversed(words.rbegin(), words.rend());
    app.parse(std::move(reversed));
  } catch (const CLI::CallForHelp&) {
    showHelp(HelpTier::everyday);
    return Parsed::helpShown;
  } catch (const CLI::CallForAllHelp&) {
    showHelp(HelpTier::all);
    return Parsed::helpShown;
  } catch (const CLI::ArgumentMismatch& error) {
    throwNoValue(error.what(), list);
  } catch (const CLI::ParseError& error) {
    throwUsage(error.what());
  }
  takeOperands(app.remaining(), list);
  for (std::size_t i = 0; i < options.size(); ++i) {
    if (options[i]->count() == 0) continue;
    for (const std::string& text : options[i]->reduced_results()) list.entries[i].set(text);
  }
  return Parsed::run;
}

}  // namespace whit::cli
