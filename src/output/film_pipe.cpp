#include "output/film_pipe.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"

extern char** environ;

namespace whit {

bool hasFfmpeg() { return std::system("command -v ffmpeg >/dev/null 2>&1") == 0; }

FilmPipe::FilmPipe(const std::string& path, int width, int height, double fps) : path_(path) {
  const cli::WriteScope starting;  // interruptions wait until they would undo everything
  file_.emplace(path);
  if (file_->temporaryPath() != path) scope_.emplace(file_->temporaryPath());

  // All players show H.264 in yuv420p. They take its colors by BT.709, some of them only if the
  // file says so; by itself ffmpeg would convert by BT.601 and say nothing. Without -xerror it
  // takes a full disk for success.
  std::vector<std::string> words =
      split(formatted("ffmpeg -v error -xerror -f rawvideo -pix_fmt rgb0 -s %dx%d -r %.17g -i - "
                      "-vf scale=out_color_matrix=bt709:out_range=tv -colorspace bt709 "
                      "-color_primaries bt709 -color_trc iec61966-2-1 -color_range tv -c:v libx264 "
                      "-crf 18 -pix_fmt yuv420p -movflags +faststart -f mp4 -y",
                      width, height, fps),
            ' ');
  // Otherwise a leading dash would make the path an option, and a colon in it a protocol.
  words.push_back("file:" + file_->temporaryPath());
  std::vector<char*> arguments(words.size() + 1);  // null is the last
  std::ranges::transform(words, arguments.begin(), [](std::string& word) { return word.data(); });

  signal(SIGPIPE, SIG_IGN);  // a program that has ended is then an error of the write
  // The ends close on exec, so that no other process keeps the pipe open after this one closes it.
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throwIo(std::string("cannot make a pipe: ") + strerror(errno));
  pipe_ = ends[1];

  // The program reads pictures from its standard input. Its messages go to standard error, because
  // standard output is for results.
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  const int error = posix_spawnp(&process_, "ffmpeg", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[0]);

  if (error != 0) {
    close(pipe_);
    process_ = 0;
    throwIo(std::string("cannot start ffmpeg: ") + std::strerror(error));
  }
  cli::ChildScope::begun(process_);
}

FilmPipe::~FilmPipe() {
  if (process_ == 0) return;
  kill(process_, SIGKILL);
  wait();
}

int FilmPipe::wait() {
  // The end of the input tells ffmpeg that the film is complete.
  if (pipe_ >= 0) close(pipe_);
  pipe_ = -1;
  int status = 0;
  while (waitpid(process_, &status, 0) < 0 && errno == EINTR) continue;

  process_ = 0;
  cli::ChildScope::ended();
  return status;
}

void FilmPipe::add(std::span<const std::uint8_t> rgba) {
  while (!rgba.empty()) {
    const ssize_t count = write(pipe_, rgba.data(), rgba.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      wait();
      throwIo("cannot write '" + path_ + "': ffmpeg ended early");
    }

    rgba = rgba.subspan(count);
  }
}

void FilmPipe::finish() {
  const int status = wait();
  if (status != 0) throwIo("cannot write '" + path_ + "': ffmpeg has failed");

  const cli::WriteScope scope;
  file_->commit();
}

}  // namespace whit
