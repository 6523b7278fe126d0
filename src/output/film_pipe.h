// How frames are written: one at a time beside the tracing of the next, and films through ffmpeg,
// to which pictures go by a pipe, one after the other.
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "command_line/program.h"
#include "core/stopwatch.h"
#include "io/files.h"

namespace whit {

// True if ffmpeg is in $PATH.
bool hasFfmpeg();

class FilmPipe {
 public:
  // Starts ffmpeg. The film appears at `path` with finish(). Width and height are even. Throws
  // Error(io).
  FilmPipe(const std::string& path, int width, int height, double fps);
  // Ends the program, and leaves nothing, unless the film was finished.
  ~FilmPipe();
  FilmPipe(const FilmPipe&) = delete;
  FilmPipe& operator=(const FilmPipe&) = delete;

  // A picture: r, g, b, 255 of each pixel, rows from the top. Throws Error(io) if ffmpeg has ended;
  // its own messages go to standard error.
  void add(std::span<const std::uint8_t> rgba);
  void finish();

 private:
  int wait();

  std::string path_;
  std::optional<cli::ChildScope> scope_;  // before the file: it lives longer
  std::optional<AtomicFile> file_;
  int pipe_ = -1, process_ = 0;
};

// One job at a time, on a thread of its own, in the order in which they come: at most one picture
// is held beside the one that is traced, and a file is there only if all before it are.
// Interruptions wait for a job that was started, and for no more (command_line/program.h).
class BackgroundWriter {
 public:
  BackgroundWriter() = default;
  // Waits for the job; what it throws is lost. Call finish() first.
  ~BackgroundWriter() {
    if (job_.valid()) job_.wait();
  }
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  // As finish(), then starts `write`. From the main thread.
  void start(std::function<void()> write) {
    finish();

    // The scope is opened here and not by the job: an interruption between the two would not know
    // of the files.
    job_ = std::async(std::launch::async, [write = std::move(write),
                                           scope = std::make_shared<cli::WriteScope>()]() mutable {
      const std::shared_ptr<cli::WriteScope> held = std::move(scope);
      const Stopwatch stopwatch;
      write();
      return stopwatch.ms();
    });
  }

  // Waits for the job that was started last, and throws what it threw.
  void finish() {
    if (!job_.valid()) return;
    const Stopwatch waiting;
    job_.wait();
    const double waitedMs = waiting.ms();
    times_.push_back({job_.get(), waitedMs});
  }

  // How long each finished job took, and how long start() or finish() waited for it.
  struct Times {
    double spentMs = 0, waitedMs = 0;
  };
  const std::vector<Times>& times() const { return times_; }

 private:
  std::future<double> job_;  // milliseconds
  std::vector<Times> times_;
};

}  // namespace whit
