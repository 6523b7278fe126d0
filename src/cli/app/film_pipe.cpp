#include "cli/app/film_pipe.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "core/error.h"
#include "core/option_values.h"

extern char** environ;

namespace whit::cli {

namespace {

std::string rateText(double fps) { return formatValue(OptionSpec{}, fps); }

std::vector<std::string> argumentsFor(const std::string& program, const std::string& to, int width,
                                      int height, double fps) {
  std::vector<std::string> words{
      program, "-v",          "error",
      "-f",    "rawvideo",    "-pix_fmt",
      "rgb0",  "-s",          std::to_string(width) + "x" + std::to_string(height),
      "-r",    rateText(fps), "-i",
      "-"};
  words.insert(words.end(), std::begin(kFilmCodec), std::end(kFilmCodec));
  words.insert(words.end(), {"-f", "mp4", "-y", to});
  return words;
}

// Whatever begins with a dash would be an option to it.
std::string asFile(const std::string& path) { return path[0] == '-' ? "./" + path : path; }

// With its standard input at `in` and what it says in `said`. An error number.
int start(std::vector<std::string> words, int in, int said, int& process) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, said, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, said, STDERR_FILENO);
  const int error =
      posix_spawn(&process, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error;
}

std::string quotedForShell(const std::string& word) {
  const auto isPlain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("-_./+:%=,", c);
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), isPlain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::optional<std::string> findProgram(const std::string& name) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string file = (std::filesystem::path(folder.empty() ? "." : folder) / name).string();
    std::error_code error;
    if (std::filesystem::is_regular_file(file, error) && access(file.c_str(), X_OK) == 0)
      return file;
  }
  return std::nullopt;
}

std::string filmCommand(const std::string& pattern, double fps, const std::string& film) {
  std::vector<std::string> words{"ffmpeg", "-framerate", rateText(fps), "-i", asFile(pattern)};
  words.insert(words.end(), std::begin(kFilmCodec), std::end(kFilmCodec));
  words.push_back(asFile(film));
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + quotedForShell(word);
  return text;
}

FilmPipe::FilmPipe(const std::string& program, const std::string& path, int width, int height,
                   double fps)
    : path_(path), said_(std::tmpfile()) {
  const WriteScope starting;  // until it is known what an interruption has to undo
  file_.emplace(path);
  if (file_->temporaryPath() != path) scope_.emplace(file_->temporaryPath());
  if (!said_) throwIo(std::string("cannot make a temporary file: ") + std::strerror(errno));
  signal(SIGPIPE, SIG_IGN);  // a program that has ended is then an error of the write
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throwIo(std::string("cannot make a pipe: ") + strerror(errno));
  pipe_ = ends[1];
  const int error = start(argumentsFor(program, asFile(file_->temporaryPath()), width, height, fps),
                          ends[0], fileno(said_.get()), process_);
  close(ends[0]);
  if (error != 0) {
    close(pipe_);
    process_ = 0;
    throwIo("cannot start " + program + ": " + std::strerror(error));
  }
  ChildScope::begun(process_);
}

FilmPipe::~FilmPipe() {
  if (process_ == 0) return;
  kill(process_, SIGKILL);
  wait();
}

int FilmPipe::wait() {
  if (pipe_ >= 0) close(pipe_);
  pipe_ = -1;
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;
  process_ = 0;
  ChildScope::ended();
  return status;
}

void FilmPipe::fail(const std::string& what) {
  std::string said(4096, '\0');
  std::rewind(said_.get());
  said.resize(std::fread(said.data(), 1, said.size(), said_.get()));
  while (!said.empty() && std::isspace(static_cast<unsigned char>(said.back()))) said.pop_back();
  throwIo("cannot write '" + path_ + "': " + what + (said.empty() ? "" : ": " + said));
}

void FilmPipe::add(std::span<const std::uint8_t> rgba) {
  while (!rgba.empty()) {
    const ssize_t count = write(pipe_, rgba.data(), rgba.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      wait();
      fail("ffmpeg has ended before its time");
    }
    rgba = rgba.subspan(static_cast<std::size_t>(count));
  }
}

void FilmPipe::finish() {
  const int status = wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail("ffmpeg has failed");
  const WriteScope scope;
  file_->commit();
}

}  // namespace whit::cli
