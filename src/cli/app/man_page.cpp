#include "cli/app/man_page.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <map>

#include "cli/app/parse_options.h"
#include "cli/app/program.h"
#include "core/option_table.h"
#include "core/version.h"

namespace whit::cli {

namespace {

// One line that troff takes as it is: it would turn some characters into typographical ones.
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

std::string heading(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return ".SH \"" + roff(text) + "\"\n";
}

std::string termText(const std::string& term, const std::string& meaning) {
  return ".TP\n" + term + "\n" + roff(meaning) + (meaning.ends_with('.') ? "\n" : ".\n");
}

std::string entryText(const OptionList::Entry& entry) {
  const std::string letter = entry.shortName.empty() ? "" : "-" + entry.shortName + ", ";
  std::string term = "\\fB" + roff(letter + "--" + entry.name) + "\\fR";
  if (!entry.placeholder.empty()) term += " \\fI" + roff(entry.placeholder) + "\\fR";
  return termText(term, entry.help);
}

}  // namespace

std::string manSection(const std::string& title, const Terms& terms) {
  std::string text = heading(title);
  for (const auto& [term, meaning] : terms) text += termText("\\fB" + roff(term) + "\\fR", meaning);
  return text;
}

std::string manOptions(const std::string& usage, const std::string& summary,
                       const OptionList& list) {
  std::string text = ".B " + roff(usage) + "\n.PP\n" + roff(summary) + "\n";
  if (list.operand.most > 0) {
    text +=
        ".PP\n\\fI" + roff(list.operand.placeholder) + "\\fR: " + roff(list.operand.help) + ".\n";
  }
  std::string group, shared;
  for (const OptionList::Entry& entry : list.entries) {
    if (!entry.common) text += entryText(entry);
    if (entry.common && entry.group != group) shared += (shared.empty() ? "" : ", ") + entry.group;
    if (entry.common) group = entry.group;
  }
  return shared.empty() ? text : text + ".PP\nAlso the options described below: " + shared + ".\n";
}

void printManual(const ManPage& page, const std::function<void()>& body) {
  std::string text = ".TH " + roff(page.name) + " 1 \"\" \"whit " + versionText() +
                     "\" \"User Commands\"\n" + heading("name") + roff(page.name) + " \\- " +
                     roff(page.summary) + "\n" + heading("synopsis") + ".B " + roff(page.synopsis) +
                     "\n" + heading("description") + roff(page.description) + "\n";
  text += manSection("options",
                     {{"--help", "commands, or the options of a command that are used every day"},
                      {"--help-all", "all options of a command"},
                      {"--version", "the version"},
                      {"--man", "this page, for man -l"},
                      {"--completion SHELL", "a script for completion in bash, zsh or fish"}});
  std::fputs(text.c_str(), stdout);
  body();
  CommonOptions common;
  OptionList shared;
  listCommonOptions(shared, common);
  std::string group;
  text.clear();
  for (const OptionList::Entry& entry : shared.entries) {
    if (entry.group != group) text += heading(group = entry.group);
    text += entryText(entry);
  }
  Terms statuses, presets;
  for (const ExitMeaning& e : kExitMeanings) {
    statuses.emplace_back(std::to_string(e.status), e.meaning);
  }
  for (const QualityPreset& preset : qualityPresets()) {
    presets.emplace_back("--quality " + preset.name,
                         preset.options.empty() ? "the defaults" : preset.options);
  }
  text += manSection("presets", presets) + manSection("exit status", statuses) +
          manSection("environment",
                     {{"WHIT_SCENES", "folder that is searched first for shipped scenes"},
                      {"WHIT_DATA", "folder of models that scenes may name as $WHIT_DATA/..."}}) +
          heading("see also") + ".BR " + roff(page.seeAlso) + " (1)\n";
  std::fputs(text.c_str(), stdout);
}

}  // namespace whit::cli
