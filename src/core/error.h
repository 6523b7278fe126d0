// The one exception type, whose status is the exit status of the programs (see `whit --help`), and
// what other exceptions amount to.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

namespace whit {

enum class ExitStatus { done = 0, checkFailed = 1, usage = 2, badScene = 3, io = 4, limit = 5 };

// The place of an error; a member is empty if it is unknown. The members are the file, the line
// ("12", "12:5") or JSON pointer ("/lights/0") in it or the element of a scene without a file
// ("light 'lamp'"), and the content that was expected there.
struct ErrorPlace {
  std::string file, place, expected;
};

class Error : public std::runtime_error {
 public:
  Error(ExitStatus status, const std::string& what) : std::runtime_error(what), status_(status) {}
  Error(ExitStatus status, const std::string& what, ErrorPlace place)
      : std::runtime_error(what), status_(status), place_(std::move(place)) {}

  ExitStatus status() const { return status_; }
  const ErrorPlace& place() const { return place_; }

 private:
  ExitStatus status_;
  ErrorPlace place_;
};

[[noreturn]] inline void throwUsage(const std::string& what) {
  throw Error(ExitStatus::usage, what);
}
inline void refuseIf(bool isWrong, const std::string& why) {
  if (isWrong) throwUsage(why);
}
// `where` is "file", "file:line" or "file#/json/pointer"; `what` says what was expected there.
[[noreturn]] void throwBadScene(const std::string& where, const std::string& what);
[[noreturn]] inline void throwIo(const std::string& what) { throw Error(ExitStatus::io, what); }
// Reports a file that cannot be read or written.
[[noreturn]] inline void throwIo(const std::string& file, const std::string& what) {
  throw Error(ExitStatus::io, what, {file, "", ""});
}
[[noreturn]] inline void throwLimit(const std::string& what) {
  throw Error(ExitStatus::limit, what);
}

// Any exception as an exit status and a line for people.
struct Failure {
  ExitStatus status = ExitStatus::checkFailed;
  std::string what;
  ErrorPlace place = {};
};

// An Error as it is; memory and threads that ran out are limits; all else is checkFailed.
Failure failureOf(const std::exception& error);

}  // namespace whit
