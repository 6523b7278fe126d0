// whit scenes: the list of the shipped scenes.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/commands.h"
#include "command_line/option_list.h"
#include "command_line/parse_options.h"
#include "core/text.h"
#include "io/files.h"
#include "output/image_output.h"
#include "output/json_report.h"

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
  std::string json;
  OptionList list;
  list.value({"json", "FILE"}, "name, file and meaning of each scene as JSON; - is standard output",
             json);
  if (!parseOptions("whit scenes [options]", "Lists the shipped scenes.", list, words)) return 0;
  requireJsonWritable(json);

  Json scenes = Json::array();
  for (const std::filesystem::path& file : shippedScenes()) {
    scenes.push_back({{"name", file.stem().string()},
                      {"file", file.string()},
                      {"about", aboutOf(readTextFile(file.string(), kSceneBytesLimit))}});
  }

  if (!json.empty()) writeJson(json, {{"scenes", scenes}});
  if (json == "-") return 0;
  for (const Json& scene : scenes) {
    std::printf("%-16s%s\n", printable(scene["name"].get<std::string>()).c_str(),
                printable(scene["about"].get<std::string>()).c_str());
  }
  return 0;
}

}  // namespace whit::cli
