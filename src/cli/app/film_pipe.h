// Films through ffmpeg: pictures go to it by a pipe, one after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/app/interrupt.h"
#include "io/atomic_file.h"

namespace whit::cli {

// Where a program of this name is in $PATH.
std::optional<std::string> findProgram(const std::string& name);

// How films are compressed (H.264 for all players), as ffmpeg is told; what comes in and where it
// goes stands around it.
inline constexpr const char* kFilmCodec[] = {"-c:v",     "libx264", "-crf",      "18",
                                             "-pix_fmt", "yuv420p", "-movflags", "+faststart"};

// The command that makes a film of numbered pictures, for people: "frame%04d.png".
std::string filmCommand(const std::string& pattern, double fps, const std::string& film);

class FilmPipe {
 public:
  // Starts the program. `path` is the film's; it is there after finish() only. Width and height are
  // even. Throws Error(io).
  FilmPipe(const std::string& program, const std::string& path, int width, int height, double fps);
  // Ends the program, and leaves nothing, unless the film was finished.
  ~FilmPipe();
  FilmPipe(const FilmPipe&) = delete;
  FilmPipe& operator=(const FilmPipe&) = delete;

  // A picture: r, g, b, 255 of each pixel, rows from the top. Throws Error(io) with what the
  // program has said if it has ended.
  void add(std::span<const std::uint8_t> rgba);
  void finish();

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  int wait();
  [[noreturn]] void fail(const std::string& what);

  std::string path_;
  std::optional<ChildScope> scope_;  // before the file: it lives longer
  std::optional<AtomicFile> file_;
  std::unique_ptr<std::FILE, CloseFile> said_;  // what the program has to say
  int pipe_ = -1, process_ = 0;
};

}  // namespace whit::cli
