// The one exception type, whose status is the exit status of the programs (see `whit --help`), and
// what other exceptions amount to.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

namespace whit {

enum class ExitStatus { done = 0, checkFailed = 1, usage = 2, badScene = 3, io = 4, limit = 5 };

class Error : public std::runtime_error {
 public:
  Error(ExitStatus status, const std::string& what) : std::runtime_error(what), status_(status) {}
  ExitStatus status() const { return status_; }

 private:
  ExitStatus status_;
};

[[noreturn]] inline void throwUsage(const std::string& what) {
  throw Error(ExitStatus::usage, what);
}
// `where` is "file", "file:line" or "file#/json/pointer"; `what` says what was expected there.
[[noreturn]] inline void throwBadScene(const std::string& where, const std::string& what) {
  throw Error(ExitStatus::badScene, where + ": " + what);
}
[[noreturn]] inline void throwIo(const std::string& what) { throw Error(ExitStatus::io, what); }
[[noreturn]] inline void throwLimit(const std::string& what) {
  throw Error(ExitStatus::limit, what);
}

// Any exception as an exit status and a line for people.
struct Failure {
  ExitStatus status = ExitStatus::checkFailed;
  std::string what;
};

// An Error as it is; memory and threads that ran out are limits; all else is checkFailed.
Failure failureOf(const std::exception& error);

}  // namespace whit
