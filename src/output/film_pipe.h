// Films, which ffmpeg makes of pictures that it gets through a pipe, one after the other.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "command_line/program.h"
#include "io/files.h"

namespace whit {

// True if ffmpeg is in $PATH.
bool hasFfmpeg();

class FilmPipe {
 public:
  // Starts ffmpeg. The film appears at `path` with finish(). Width and height are even. Throws
  // Error(io).
  FilmPipe(const std::string& path, int width, int height, double fps);
  // Ends ffmpeg and removes what it has written, unless the film was finished.
  ~FilmPipe();
  FilmPipe(const FilmPipe&) = delete;
  FilmPipe& operator=(const FilmPipe&) = delete;

  // Adds a picture: r, g, b, 255 of each pixel, in rows from the top. Throws Error(io) if ffmpeg
  // has ended; its own messages go to standard error.
  void add(std::span<const std::uint8_t> rgba);
  void finish();

 private:
  int wait();

  std::string path_;
  std::optional<cli::ChildScope> scope_;  // before the file, because it must live longer
  std::optional<AtomicFile> file_;
  int pipe_ = -1, process_ = 0;
};

}  // namespace whit
