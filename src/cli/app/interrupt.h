// Control-C and SIGTERM: the program ends at once with status 130, and leaves no half-written file.
#pragma once

#include <string>

namespace whit::cli {

inline constexpr int kInterruptedStatus = 130;

// Call from the main thread before any other thread is started.
void installInterruptHandlers();

// While one is alive an interruption waits: files are being written. The destructor catches up. To
// be made on the main thread; any may destroy it.
class WriteScope {
 public:
  WriteScope();
  ~WriteScope();
  WriteScope(const WriteScope&) = delete;
  WriteScope& operator=(const WriteScope&) = delete;
};

// While it is alive an interruption removes the file, and ends the process that writes it, too. One
// at a time.
class ChildScope {
 public:
  explicit ChildScope(const std::string& file);
  ~ChildScope();
  static void begun(int process);
  static void ended();
  ChildScope(const ChildScope&) = delete;
  ChildScope& operator=(const ChildScope&) = delete;
};

}  // namespace whit::cli
