// Pictures on the terminal that standard output is.
#pragma once

#include <string>

#include "core/image.h"

namespace whit::cli {

enum class TerminalGraphics { none, kitty, iterm, halfBlocks };

// The best way of the terminal on standard output, as the environment tells.
TerminalGraphics terminalGraphics();

// The picture as text for that terminal, reduced where it is larger.
std::string terminalPicture(const DisplayImage& picture, TerminalGraphics graphics);

}  // namespace whit::cli
