#include "cli/app/man_page.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "cli/app/parse_options.h"
#include "cli/app/program.h"
#include "core/option_table.h"
#include "core/version.h"

namespace whit::cli {

namespace {

// As running text: one line that troff takes as it is, characters that it would make typographical
// kept as they are typed.
std::string roff(const std::string& text) {
  static const std::map<char, std::string> kWritten{{'\\', "\\e"},  {'-', "\\-"},   {'\'', "\\(aq"},
                                                    {'"', "\\(dq"}, {'`', "\\(ga"}, {'^', "\\(ha"},
                                                    {'~', "\\(ti"}, {'\n', " "}};
  std::string out = text.starts_with('.') ? "\\&" : "";
  for (const char c : text) {
    const auto found = kWritten.find(c);
    out += found == kWritten.end() ? std::string(1, c) : found->second;
  }
  return out;
}

std::string sentence(const std::string& text) {
  return roff(text) + (text.empty() || text.back() == '.' ? "\n" : ".\n");
}

std::string section(const std::string& heading) { return ".SH \"" + roff(heading) + "\"\n"; }

std::string upperCase(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string entryText(const OptionList::Entry& entry) {
  std::string names = entry.shortName.empty() ? "" : "-" + entry.shortName + ", ";
  names += "--" + entry.name;
  std::string text = ".TP\n\\fB" + roff(names) + "\\fR";
  if (!entry.placeholder.empty()) text += " \\fI" + roff(entry.placeholder) + "\\fR";
  return text + "\n" + sentence(entry.help);
}

bool sameEntry(const OptionList::Entry& a, const OptionList::Entry& b) {
  return a.group == b.group && a.name == b.name && a.placeholder == b.placeholder &&
         a.help == b.help;
}

template <typename T>
bool addIfNew(std::vector<T>& all, const T& one) {
  if (std::find(all.begin(), all.end(), one) != all.end()) return false;
  all.push_back(one);
  return true;
}

// The sections of a page that hold the common options are called by their groups.
std::string referenceText(const std::vector<std::string>& groups) {
  std::string text;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    if (i > 0) text += i + 1 < groups.size() ? ", " : " and ";
    text += "\\fB" + roff(upperCase(groups[i])) + "\\fR";
  }
  return ".PP\nAlso the options of " + text + " below.\n";
}

}  // namespace

std::string manOpening(const ManPage& page) {
  return ".\\\" Written by " + page.name + " \\-\\-man.\n.TH " + upperCase(roff(page.name)) +
         " 1 \"\" \"whit " + versionText() + "\" \"User Commands\"\n" + section("NAME") +
         roff(page.name) + " \\- " + roff(page.summary) + "\n" + section("SYNOPSIS") + ".B " +
         roff(page.synopsis) + "\n" + section("DESCRIPTION") + roff(page.description) + "\n";
}

std::string manOptions(const std::string& usage, const std::string& summary,
                       const OptionList& list) {
  CommonOptions common;
  OptionList shared;
  listCommonOptions(shared, common);
  std::string text = ".B " + roff(usage) + "\n.PP\n" + roff(summary) + "\n";
  if (list.operand.most > 0) {
    text += ".PP\n\\fI" + roff(list.operand.placeholder) + "\\fR: " + sentence(list.operand.help);
  }
  std::vector<std::string> references;
  for (const OptionList::Entry& entry : list.entries) {
    const bool common = std::any_of(shared.entries.begin(), shared.entries.end(),
                                    [&](const auto& known) { return sameEntry(known, entry); });
    if (common) {
      addIfNew(references, entry.group);
    } else {
      text += entryText(entry);
    }
  }
  return references.empty() ? text : text + referenceText(references);
}

std::string manTerms(const std::string& heading,
                     const std::vector<std::pair<std::string, std::string>>& terms) {
  std::string text = section(heading);
  for (const auto& [term, meaning] : terms) {
    text += ".TP\n\\fB" + roff(term) + "\\fR\n" + sentence(meaning);
  }
  return text;
}

std::string manClosing(const ManPage& page) {
  CommonOptions common;
  OptionList shared;
  listCommonOptions(shared, common);
  std::string text;
  std::vector<std::string> groups;
  for (const OptionList::Entry& entry : shared.entries) {
    if (addIfNew(groups, entry.group)) text += section(upperCase(entry.group));
    text += entryText(entry);
  }
  std::vector<std::pair<std::string, std::string>> statuses;
  for (const ExitMeaning& e : kExitMeanings) {
    statuses.emplace_back(std::to_string(e.status), e.meaning);
  }
  std::vector<std::pair<std::string, std::string>> presets;
  for (const QualityPreset& preset : qualityPresets()) {
    presets.emplace_back("--quality " + preset.name,
                         preset.options.empty() ? "the defaults" : preset.options);
  }
  text += manTerms("PRESETS", presets);
  text += manTerms("EXIT STATUS", statuses);
  text += manTerms("ENVIRONMENT",
                   {{"WHIT_SCENES", "folder in which shipped scenes are looked for first"},
                    {"WHIT_DATA", "folder of models that scenes may name as $WHIT_DATA/..."}});
  return text + section("SEE ALSO") + ".BR " + roff(page.seeAlso) + " (1)\n";
}

}  // namespace whit::cli
