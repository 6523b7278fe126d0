// whit: the command line program.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <utility>

#include "cli/commands.h"
#include "command_line/help_text.h"
#include "command_line/program.h"
#include "core/error.h"
#include "core/text.h"
#include "io/files.h"

namespace whit::serve {

// Defined in viewer/serve/serve_command.cpp: the commands include nothing of the viewer, and this
// program links it.
int serveCommand(const std::vector<std::string>& words);

}  // namespace whit::serve

namespace whit::cli {

namespace {

struct Command {
  const char *name, *summary;
  int (*run)(const Words& words);
};

constexpr Command kCommands[] = {
    {"render", "one image, or the frames of a film", renderCommand},
    {"turntable", "a film of a model on a turntable", turntableCommand},
    {"bench", "time of a frame by stage and by kind of ray", benchCommand},
    {"compare", "packets against the scalar reference, or two images", compareCommand},
    {"info", "contents of a scene, its effects and the kernels that run", infoCommand},
    {"scenes", "list of the shipped scenes", scenesCommand},
    {"serve", "the viewer in a browser", serve::serveCommand},
    {"explain", "tree of the rays of one pixel", explainCommand},
    {"effects", "cost of each effect of a scene", effectsCommand},
    {"accuracy", "report on accuracy against time", accuracyCommand},
    {"merge", "one image from its crops", mergeCommand},
};

const ManPage kPage{
    "whit",
    "real-time Whitted ray tracing on CPUs",
    "whit COMMAND ...",
    "Renders scenes with Embree packets and SIMD kernels, measures the time of each stage, and "
    "checks itself against a scalar reference in double precision. "
    "SCENE is a scene file (.json), a model (.gltf, .glb, .vrm, .obj, .ply; .stl, .fbx, .dae, .3ds "
    "and .off by the library assimp), or the name of a shipped scene (atrium). Standard output "
    "carries results, standard error everything for "
    "people. Files appear under their name only when complete.",
    "whit-view",
    {{"whit render helmet.glb",
      "a picture of a model, as helmet.png; adds lights, a sky and a camera"},
     {"whit render helmet.glb -o helmet.jpg --size 1280x960 --quality good",
      "the same to show: antialiased, with soft shadows and ambient occlusion"},
     {"whit render chess.glb -o chess.exr --channels depth,normal,object",
      "the picture, and what the camera sees in each pixel, in one EXR file"},
     {"whit render orrery --frames 0..239 --fps 24 -o orrery.mp4",
      "a film of an animated scene, by ffmpeg"},
     {"whit explain whitted --pixel 355,240 --html lesson.html",
      "a page on the rays behind one pixel"},
     {"whit bench atrium --size 1280x720", "where the time of a frame goes"}}};

void showHelp() {
  std::printf("whit %s: %s\n\nUsage: %s\n\nCommands:\n", WHIT_VERSION, kPage.summary.c_str(),
              kPage.synopsis.c_str());
  for (const Command& c : kCommands) std::printf("  %-10s%s\n", c.name, c.summary);
  std::printf(
      "\nSCENE is a scene file (.json), a model (.gltf, .glb, .vrm, .obj, .ply; .stl, .fbx,\n"
      ".dae, .3ds and .off by the library assimp), or the name of a shipped scene (atrium).\n"
      "Options of a command: whit COMMAND --help, all of them: whit COMMAND --help-all. Version:\n"
      "whit --version. The manual page: whit --man. Completion: whit --completion bash|zsh|fish.\n"
      "\nExit status:\n");
  for (const ExitMeaning& e : kExitMeanings) std::printf("  %-5d%s\n", e.status, e.meaning);
}

void showManual() {
  printManual(kPage, [] {
    std::puts(".SH COMMANDS");
    for (const Command& command : kCommands) {
      std::printf(".SS %s\n", command.name);
      command.run({"--man"});
    }
  });
}

const Command* commandNamed(const std::string& name) {
  const auto found =
      std::ranges::find_if(kCommands, [&](const Command& command) { return name == command.name; });
  return found == std::end(kCommands) ? nullptr : found;
}

int complete(const Words& words) {
  // After the name of a command, the command itself completes.
  if (words.size() > 2) {
    const Command* const command = commandNamed(words[1]);
    Words rest{"--complete"};
    rest.insert(rest.end(), words.begin() + 2, words.end());
    return command ? command->run(rest) : 0;
  }

  const std::string word = words.size() == 2 ? words[1] : "";
  std::string lines;
  for (const Command& c : kCommands) lines += completionLine(word, c.name, c.summary);
  // Options are offered only once a word has begun.
  for (const std::string option : {"--help", "--version", "--man", "--completion"}) {
    if (!word.empty()) lines += completionLine(word, option);
  }

  std::fputs(lines.c_str(), stdout);
  return 0;
}

[[noreturn]] void throwNoCommand(const std::string& word) {
  for (const auto& [command, program] :
       {std::pair{"stress", "whit-verify"}, std::pair{"view", "whit-view"}}) {
    if (word == command) throwUsage("whit " + word + " is a program of its own: " + program);
  }

  std::vector<std::string> names = namesIn(kCommands);
  if (word.starts_with('-')) names = {"--help", "--version", "--man", "--completion"};

  // A word that looks like a file, or is the name of a shipped scene, is meant to be rendered.
  const bool isFile = word.find_first_of("./") != std::string::npos && word[0] != '-';
  const bool isScene = std::ranges::any_of(
      shippedScenes(), [&](const std::filesystem::path& scene) { return scene.stem() == word; });
  const std::string meant =
      isFile || isScene ? "; did you mean 'whit render " + word + "'?" : didYouMean(word, names);

  throwUsage("'" + word + "' is not a command" +
             (meant.empty() ? "; whit --help lists the commands" : meant));
}

int run(const Words& words) {
  if (words.empty()) {
    showHelp();
    return static_cast<int>(ExitStatus::usage);
  }

  if (words[0] == "help" && words.size() == 2) return run({words[1], "--help"});
  if (words[0] == "--help" || words[0] == "--help-all" || words[0] == "-h" || words[0] == "help") {
    showHelp();
    return 0;
  }

  if (words[0] == "--version" || words[0] == "version" || words[0] == "-V") {
    std::printf("whit %s\n", WHIT_VERSION);
    const std::string leftOut = WHIT_LEFT_OUT;
    if (!leftOut.empty()) std::printf("Left out of this build: %s\n", leftOut.c_str());
    return 0;
  }
  if (words[0] == "--man") {
    showManual();
    return 0;
  }
  if (words[0] == "--completion") {
    if (words.size() != 2) throwUsage("--completion: expected bash, zsh or fish after it");
    std::fputs(completionScript(words[1], kPage.name).c_str(), stdout);
    return 0;
  }

  if (words[0] == "--complete") return complete(words);
  if (const Command* const command = commandNamed(words[0])) {
    return command->run(Words(words.begin() + 1, words.end()));
  }

  throwNoCommand(words[0]);
}

}  // namespace

}  // namespace whit::cli

int main(int argc, char** argv) {
  return whit::cli::runProgram("whit",
                               [&] { return whit::cli::run(whit::cli::wordsOf(argc, argv)); });
}
