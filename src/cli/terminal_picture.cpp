#include "cli/terminal_picture.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/index.h"
#include "core/text.h"
#include "core/vec3.h"
#include "io/image/image_file.h"
#include "output/report_page.h"

namespace whit::cli {

namespace {

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "";
}

// Returns the number of columns that the picture takes if a cell has this size in pixels. The line
// below the picture stays free for the prompt.
int columnsOf(const DisplayImage& picture, const winsize& terminal, double width, double height) {
  const double fits = std::min({1.0, terminal.ws_col * width / picture.width,
                                (terminal.ws_row - 1) * height / picture.height});
  return std::max(1, static_cast<int>(picture.width * fits / width + 1e-6));
}

// Returns the picture in the protocol of kitty, which takes at most 4096 bytes at a time. Without
// q=2 the terminal would answer.
std::string kittyText(const std::string& data, int columns) {
  constexpr std::size_t kMost = 4096;
  std::string text = formatted("\x1b_Ga=T,f=100,q=2,c=%d,", columns);
  for (std::size_t at = 0; at < data.size(); at += kMost) {
    if (at > 0) text += "\x1b_G";
    text += at + kMost < data.size() ? "m=1;" : "m=0;";
    text += data.substr(at, kMost) + "\x1b\\";
  }
  return text + "\n";
}

// Returns the picture in characters that show two pixels each, one above the other. Transparent
// parts are black.
std::string halfBlocks(const DisplayImage& picture, int columns) {
  const double scale = static_cast<double>(columns) / picture.width;
  const int rows = std::max(1, static_cast<int>(std::lround(picture.height * scale)));
  const auto cell = [&](int column, int row) { return cellAt(column, row, columns); };

  // A cell has the mean color of the pixels that fall into it, on black.
  std::vector<Vec3d> sums(cell(0, rows));
  std::vector<double> pixels(sums.size());
  const std::uint8_t* rgba = picture.rgba.data();
  for (std::int64_t y = 0; y < picture.height; ++y) {
    for (std::int64_t x = 0; x < picture.width; ++x, rgba += 4) {
      const std::size_t i = cell(static_cast<int>(x * columns / picture.width),
                                 static_cast<int>(y * rows / picture.height));
      sums[i] = sums[i] + Vec3d(rgba[0], rgba[1], rgba[2]) * (rgba[3] / 255.0);
      ++pixels[i];
    }
  }

  const auto color = [&](int ground, std::size_t i) {
    const Vec3d mean = sums[i] * (1 / pixels[i]);
    return formatted("\x1b[%d;2;%.0f;%.0f;%.0fm", ground, mean.x, mean.y, mean.z);
  };

  // The foreground (38) colors the upper half of a character, the background (48) its lower half.
  std::string text;
  for (int row = 0; row < rows; row += 2) {
    for (int column = 0; column < columns; ++column) {
      text += color(38, cell(column, row));
      if (row + 1 < rows) text += color(48, cell(column, row + 1));
      text += "\u2580";
    }
    text += "\x1b[0m\n";
  }
  return text;
}

}  // namespace

TerminalGraphics terminalGraphics() {
  const std::string term = variable("TERM"), program = variable("TERM_PROGRAM");
  if (!isatty(STDOUT_FILENO) || term.empty() || term == "dumb") return TerminalGraphics::none;

  // Inside tmux and screen, these variables describe the outer terminal and not tmux or screen.
  if (variable("TMUX").empty() && variable("STY").empty()) {
    constexpr int kKonsoleWithKitty = 220400;
    const bool isIterm = program == "iTerm.app" || program == "WezTerm" || program == "mintty" ||
                         variable("LC_TERMINAL") == "iTerm2";
    const bool isKitty = !variable("KITTY_WINDOW_ID").empty() || term == "xterm-kitty" ||
                         term == "xterm-ghostty" || program == "ghostty" ||
                         std::atoi(variable("KONSOLE_VERSION").c_str()) >= kKonsoleWithKitty;
    if (isIterm || isKitty) return isIterm ? TerminalGraphics::iterm : TerminalGraphics::kitty;
  }

  const std::string color = variable("COLORTERM");
  const bool hasColors = color == "truecolor" || color == "24bit";
  return hasColors ? TerminalGraphics::halfBlocks : TerminalGraphics::none;
}

std::string terminalPicture(const DisplayImage& picture, TerminalGraphics graphics) {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0) {
    size = {24, 80, 0, 0};
  }

  if (graphics == TerminalGraphics::halfBlocks) {
    return halfBlocks(picture, columnsOf(picture, size, 1, 2));
  }

  // A terminal that does not report its size in pixels is taken to have cells of 8x16 pixels.
  const bool isKnown = size.ws_xpixel > 0 && size.ws_ypixel > 0;
  const double width = isKnown ? static_cast<double>(size.ws_xpixel) / size.ws_col : 8;
  const double height = isKnown ? static_cast<double>(size.ws_ypixel) / size.ws_row : 16;
  const int columns = columnsOf(picture, size, width, height);

  const std::string png = encodePng(picture), data = base64(png);
  if (graphics == TerminalGraphics::kitty) return kittyText(data, columns);
  return formatted("\x1b]1337;File=inline=1;size=%zu;width=%d:", png.size(), columns) + data +
         "\a\n";
}

}  // namespace whit::cli
