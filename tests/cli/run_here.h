// Runs commands in this process, which spares what starting the program takes.
#pragma once

#include "cli/commands.h"
#include "core/error.h"
#include "run_command.h"

namespace whit::cli {

inline const std::map<std::string, int (*)(const Words&)> kCommandsHere{
    {"render", renderCommand},    {"turntable", turntableCommand}, {"bench", benchCommand},
    {"compare", compareCommand},  {"info", infoCommand},           {"merge", mergeCommand},
    {"explain", explainCommand},  {"effects", effectsCommand},     {"scenes", scenesCommand},
    {"accuracy", accuracyCommand}};

// Runs `whit LINE` in a folder; the first word is one of these commands.
inline Outcome runHere(const std::string& line, const TemporaryFolder& folder) {
  const Words words = split(line);
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();

  Outcome outcome;
  try {
    outcome.status = kCommandsHere.at(words[0])({words.begin() + 1, words.end()});
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    outcome.status = static_cast<int>(failure.status);
    std::fputs(("whit: " + failure.what + "\n").c_str(), stderr);
  }

  outcome.out = testing::internal::GetCapturedStdout();
  outcome.err = testing::internal::GetCapturedStderr();
  std::filesystem::current_path(before);
  return outcome;
}

}  // namespace whit::cli
