#include "core/error.h"

#include <new>
#include <system_error>

namespace whit {

Failure failureOf(const std::exception& error) {
  if (const auto* own = dynamic_cast<const Error*>(&error)) return {own->status(), own->what()};
  if (dynamic_cast<const std::bad_alloc*>(&error)) return {ExitStatus::limit, "out of memory"};
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  if (system && system->code() == std::errc::resource_unavailable_try_again) {
    return {ExitStatus::limit, std::string("cannot start another thread: ") + error.what()};
  }
  return {ExitStatus::checkFailed, error.what()};
}

}  // namespace whit
