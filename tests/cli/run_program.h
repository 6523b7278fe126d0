// Runs the built whit, and gives it scenes and folders of its own.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "as_json.h"
#include "temporary_folder.h"

namespace whit::cli {

inline std::string readFile(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

using whit::TemporaryFolder;

// Starts the program (whit) with standard output and error going to files in `folder`, after
// `prepare` has been called in the new process; returns the process.
inline pid_t startWhit(
    const std::vector<std::string>& words, const TemporaryFolder& folder,
    const std::function<void()>& prepare = [] {}, const char* program = WHIT_PROGRAM) {
  std::vector<std::string> all{program};
  all.insert(all.end(), words.begin(), words.end());

  std::vector<char*> argv;
  for (std::string& word : all) argv.push_back(word.data());
  argv.push_back(nullptr);
  const std::string out = folder / "stdout", err = folder / "stderr";

  const pid_t child = fork();
  if (child == 0) {
    dup2(open(out.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600), STDERR_FILENO);
    prepare();
    execv(argv[0], argv.data());
    _exit(127);
  }
  return child;
}

// Returns the exit status, or minus the number of the signal that ended the process.
inline int waitFor(pid_t child) {
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  return -WTERMSIG(status);
}

// Waits for `happened` for a minute at most, which is far longer than it ever takes. Ends the
// process if it does not happen.
template <typename Condition>
bool waitUntil(pid_t child, Condition&& happened) {
  for (int i = 0; i < 60'000; ++i) {
    if (happened()) return true;
    usleep(1000);
  }

  kill(child, SIGKILL);
  waitFor(child);
  return false;
}

struct Outcome {
  int status = 0;
  std::string out, err;
};

inline Outcome runWhit(
    const std::vector<std::string>& words, const std::function<void()>& prepare = [] {},
    const char* program = WHIT_PROGRAM) {
  const TemporaryFolder folder;
  const int status = waitFor(startWhit(words, folder, prepare, program));
  return {status, readFile(folder / "stdout"), readFile(folder / "stderr")};
}

// Writes a scene with a floor, a mirrored ball, a light with shadows, two cameras and a path. It
// traces primary, shadow and reflected rays, onto a few hundred triangles.
inline std::string writeTinyScene(const TemporaryFolder& folder) {
  std::ofstream(folder / "tiny.json") << asJson(
      "{'whit': 1, 'size': [48, 32],"
      "'cameras': {'front': {'eye': [0, 2, 6], 'at': [0, 1, 0], 'fov': 40},"
      "            'side': {'eye': [6, 2, 0], 'at': [0, 1, 0], 'fov': 40}},"
      "'path': [{'time': 0, 'eye': [0, 2, 6], 'at': [0, 1, 0], 'fov': 40},"
      "         {'time': 1, 'eye': [6, 2, 0]}],"
      "'lights': [{'name': 'lamp', 'position': [3, 6, 4], 'intensity': [60, 60, 60]}],"
      "'materials': {'floor': {'diffuse': 0.5}, 'mirror': {'diffuse': 0.1, 'mirror': 0.8}},"
      "'scene': [{'shape': 'quad', 'width': 8, 'depth': 8, 'material': 'floor'},"
      "          {'shape': 'icosphere', 'radius': 1, 'level': 2, 'material': 'mirror',"
      "           'transform': {'translate': [0, 1, 0]}}]}");
  return folder / "tiny.json";
}

}  // namespace whit::cli
