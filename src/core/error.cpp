#include "core/error.h"

#include <algorithm>
#include <new>
#include <string_view>
#include <system_error>

namespace whit {

namespace {

// Some places are a thing in a file or in a scene that a program made: "a.png: byte 12",
// "scene: light 'lamp'".
ErrorPlace placeIn(const std::string& where) {
  // "file#/lights/0": a JSON pointer follows the sign.
  if (const std::size_t sign = where.rfind('#'); sign != std::string::npos) {
    const std::string pointer = where.substr(sign + 1);
    if (pointer.empty() || pointer[0] == '/') return {where.substr(0, sign), pointer, ""};
  }

  // "a.png: byte 12": the text before the colon is a file if it looks like a path.
  if (const std::size_t thing = where.rfind(": "); thing != std::string::npos) {
    const std::string file = where.substr(0, thing);
    const bool isFile = file.find_first_of("./") != std::string::npos;
    return {isFile ? file : "", where.substr(thing + 2), ""};
  }

  // "file:12:5": the numbers of line and column begin at a colon.
  std::size_t begin = where.find_last_not_of("0123456789:") + 1;
  begin = std::min(where.find(':', begin), where.size());
  return {where.substr(0, begin), where.substr(std::min(begin + 1, where.size())), ""};
}

// Returns X of a message "expected X, found Y", which is the form of all messages.
std::string expectedIn(const std::string& what) {
  constexpr std::string_view kExpected = "expected ", kFound = ", found ";
  if (!what.starts_with(kExpected)) return "";

  const std::size_t end = std::min(what.rfind(kFound), what.size());
  return what.substr(kExpected.size(), end - kExpected.size());
}

}  // namespace

void throwBadScene(const std::string& where, const std::string& what) {
  ErrorPlace place = placeIn(where);
  place.expected = expectedIn(what);
  throw Error(ExitStatus::badScene, where + ": " + what, std::move(place));
}

Failure failureOf(const std::exception& error) {
  if (const auto* own = dynamic_cast<const Error*>(&error)) {
    return {own->status(), own->what(), own->place()};
  }

  if (dynamic_cast<const std::bad_alloc*>(&error)) return {ExitStatus::limit, "out of memory"};

  // A std::thread that cannot be started reports the error EAGAIN.
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  if (system && system->code() == std::errc::resource_unavailable_try_again) {
    return {ExitStatus::limit, std::string("cannot start another thread: ") + error.what()};
  }

  return {ExitStatus::checkFailed, error.what()};
}

}  // namespace whit
