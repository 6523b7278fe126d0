// whit scenes: the list of the shipped scenes.
#include <algorithm>
#include <cstdio>
#include <sstream>

#include "cli/commands.h"
#include "command_line/option_list.h"
#include "command_line/parse_options.h"
#include "core/text.h"
#include "io/files.h"

namespace whit::cli {

namespace {

constexpr std::uint64_t kSceneBytesLimit = 1u << 20;

// The comment that opens a scene file, as far as the first colon or the end of the first sentence.
std::string aboutOf(const std::string& text) {
  std::string comment;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line) && line.starts_with("//");) {
    comment += line.substr(2);
  }

  const std::size_t end =
      std::min({comment.find(": "), comment.find(". "), comment.find_last_of('.')});
  // The first character is the blank behind the slashes.
  return comment.substr(std::min<std::size_t>(comment.size(), 1), end - 1);
}

}  // namespace

int scenesCommand(const Words& words) {
  const OptionList list;
  if (!parseOptions("whit scenes", "Lists the shipped scenes.", list, words)) return 0;

  for (const std::filesystem::path& scene : shippedScenes()) {
    const std::string about = aboutOf(readTextFile(scene.string(), kSceneBytesLimit));
    std::printf("%-16s%s\n", printable(scene.stem().string()).c_str(), printable(about).c_str());
  }
  return 0;
}

}  // namespace whit::cli
