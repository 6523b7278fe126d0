// Pictures on the terminal that shows standard output.
#pragma once

#include <string>

#include "core/image.h"

namespace whit::cli {

enum class TerminalGraphics { none, kitty, iterm, halfBlocks };

// Returns the best method of the terminal on standard output, judging by the environment.
TerminalGraphics terminalGraphics();

// Returns the picture as text for that terminal, reduced if it does not fit.
std::string terminalPicture(const DisplayImage& picture, TerminalGraphics graphics);

}  // namespace whit::cli
