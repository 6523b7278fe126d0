// Text that comes from files, as it may be put on a terminal.
#pragma once

#include <string>

namespace whit {

// Control characters, which move the cursor, color or rename things, as "\x1b"; so are bytes that
// are no UTF-8.
std::string printable(const std::string& text);

}  // namespace whit
