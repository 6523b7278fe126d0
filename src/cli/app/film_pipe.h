// Films through ffmpeg: pictures go to it by a pipe, one after the other.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "cli/app/program.h"
#include "io/atomic_file.h"

namespace whit::cli {

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
  std::optional<ChildScope> scope_;  // before the file: it lives longer
  std::optional<AtomicFile> file_;
  int pipe_ = -1, process_ = 0;
};

}  // namespace whit::cli
