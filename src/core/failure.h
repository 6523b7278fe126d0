// Any exception as an exit status and a line for people.
#pragma once

#include <exception>
#include <string>

#include "core/error.h"

namespace whit {

struct Failure {
  ExitStatus status = ExitStatus::checkFailed;
  std::string what;
};

// An Error as it is; memory and threads that ran out are limits; all else is checkFailed.
Failure failureOf(const std::exception& error);

}  // namespace whit
