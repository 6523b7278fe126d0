// whit: the command line program.
#include <cstdio>

#include "cli/app/completion.h"
#include "cli/app/man_page.h"
#include "cli/app/program.h"
#include "cli/commands.h"
#include "core/error.h"
#include "core/nearest_name.h"
#include "core/version.h"

namespace whit::cli {

namespace {

const ManPage kPage{
    "whit", "real-time Whitted ray tracing on CPUs", "whit COMMAND ...",
    "Renders scenes with Embree packets and SIMD kernels, measures where the time "
    "goes, and checks itself against a scalar reference in double precision. "
    "SCENE is a scene file (.json), a model (.obj, .gltf, .glb, .ply), or the name of "
    "a shipped scene (atrium). Standard output carries results, standard error everything for "
    "people. Files appear under their name only when complete.",
    "whit-view"};

void showHelp() {
  std::printf("whit %s: %s\n\nUsage: %s\n\nCommands:\n", versionText(), kPage.summary.c_str(),
              kPage.synopsis.c_str());
  for (const Command& c : kCommands) std::printf("  %-10s%s\n", c.name, c.summary);
  std::printf(
      "\nSCENE is a scene file (.json), a model (.obj, .gltf, .glb, .ply), or the name of\n"
      "a shipped scene (atrium).\n"
      "Options of a command: whit COMMAND --help, all of them: whit COMMAND --help-all. Version:\n"
      "whit --version. The manual page: whit --man. Completion: whit --completion bash|zsh|fish.\n"
      "\nExit status:\n");
  for (const ExitMeaning& e : kExitMeanings) std::printf("  %-5d%s\n", e.status, e.meaning);
}

void showManual() {
  std::fputs(manOpening(kPage).c_str(), stdout);
  std::fputs(manTerms("OPTIONS",
                      {{"--help", "what there is; of a command: its options of every day"},
                       {"--help-all", "of a command: all its options"},
                       {"--version", "the version"},
                       {"--man", "this page, for man -l"},
                       {"--completion SHELL", "what bash, zsh or fish completes command lines by"}})
                 .c_str(),
             stdout);
  std::puts(".SH COMMANDS");
  for (const Command& command : kCommands) {
    std::printf(".SS %s\n", command.name);
    command.run({"--man"});
  }
  std::fputs(manClosing(kPage).c_str(), stdout);
}

void showCompletion(const std::string& shell) {
  const Shell named = shellNamed(shell);
  std::vector<CommandSummary> commands;
  for (const Command& c : kCommands) commands.push_back({c.name, c.summary});
  std::fputs(completionOpening(named, kPage.name, commands).c_str(), stdout);
  for (const Command& c : kCommands) c.run({"--completion", shell, kPage.name, c.name});
  std::fputs(completionClosing(named, kPage.name).c_str(), stdout);
}

int run(const Words& words) {
  if (words.empty()) {
    showHelp();
    return static_cast<int>(ExitStatus::usage);
  }
  if (words[0] == "--help" || words[0] == "--help-all" || words[0] == "-h" || words[0] == "help") {
    showHelp();
    return 0;
  }
  if (words[0] == "--version") {
    std::printf("whit %s\n", versionText());
    return 0;
  }
  if (words[0] == "--man") {
    showManual();
    return 0;
  }
  if (words[0] == "--completion") {
    if (words.size() != 2) throwUsage("--completion: expected bash, zsh or fish after it");
    showCompletion(words[1]);
    return 0;
  }
  std::vector<std::string> names;
  for (const Command& command : kCommands) {
    if (words[0] == command.name) return command.run(Words(words.begin() + 1, words.end()));
    names.emplace_back(command.name);
  }
  if (words[0] == "stress") throwUsage("whit stress is the program whit-verify now");
  if (words[0][0] == '-') names = {"--help", "--version", "--man", "--completion"};
  throwUsage("there is no command '" + words[0] + "'; nearest: '" + nearestName(words[0], names) +
             "' (whit --help lists them)");
}

}  // namespace

}  // namespace whit::cli

int main(int argc, char** argv) {
  return whit::cli::runProgram("whit",
                               [&] { return whit::cli::run(whit::cli::wordsOf(argc, argv)); });
}
