// The desktop's dialog for choosing a file: zenity or kdialog, as a process of its own, so that the
// picture goes on.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace whit::view {

class FileDialog {
 public:
  enum class Wanted { any, sky };

  FileDialog() = default;
  ~FileDialog();  // closes it
  FileDialog(const FileDialog&) = delete;
  FileDialog& operator=(const FileDialog&) = delete;

  // Nothing while one is open. Throws Error(usage) that says what to install when there is neither.
  void open(Wanted wanted);
  bool isOpen() const { return child_ > 0; }
  Wanted wanted() const { return wanted_; }
  // The file, once it is chosen; never waits. Throws Error(io) when the dialog itself has failed.
  std::optional<std::string> takeChosen();

 private:
  bool start(const char* const* words);
  void readOn();
  void close();

  Wanted wanted_ = Wanted::any;
  pid_t child_ = -1;
  int output_ = -1;
  std::string text_;  // that it has printed
};

}  // namespace whit::view
