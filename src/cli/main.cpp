// whit: the command line program.
#include <cstdio>

#include "cli/commands.h"
#include "cli/program.h"
#include "core/error.h"
#include "core/nearest_name.h"

namespace whit::cli {

namespace {

void showHelp() {
  std::printf(
      "whit %s: real-time Whitted ray tracing on CPUs\n\n"
      "Usage: whit COMMAND ...\n\nCommands:\n",
      versionText());
  for (const Command& c : kCommands) std::printf("  %-10s%s\n", c.name, c.summary);
  std::printf(
      "\nSCENE is a scene file (.json), a model (.obj, .gltf, .glb, .ply), or the name of\n"
      "a shipped scene (atrium).\n"
      "Options of a command: whit COMMAND --help. Version: whit --version.\n\n"
      "Exit status: 0 done; 1 a comparison or check failed; 2 wrong usage; 3 a bad scene or "
      "image;\n"
      "4 cannot read or write; 5 a limit or memory ran out; 130 interrupted.\n");
}

int run(const Words& words) {
  if (words.empty()) {
    showHelp();
    return static_cast<int>(ExitStatus::usage);
  }
  if (words[0] == "--help" || words[0] == "-h" || words[0] == "help") {
    showHelp();
    return 0;
  }
  if (words[0] == "--version") {
    std::printf("whit %s\n", versionText());
    return 0;
  }
  std::vector<std::string> names;
  for (const Command& command : kCommands) {
    if (words[0] == command.name) return command.run(Words(words.begin() + 1, words.end()));
    names.emplace_back(command.name);
  }
  if (words[0][0] == '-') names = {"--help", "--version"};
  throwUsage("there is no command '" + words[0] + "'; nearest: '" + nearestName(words[0], names) +
             "' (whit --help lists them)");
}

}  // namespace

}  // namespace whit::cli

int main(int argc, char** argv) {
  return whit::cli::runProgram("whit",
                               [&] { return whit::cli::run(whit::cli::wordsOf(argc, argv)); });
}
