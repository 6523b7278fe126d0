// Control-C and SIGTERM: the program ends at once with status 130, and leaves no half-written file.
#pragma once

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

}  // namespace whit::cli
