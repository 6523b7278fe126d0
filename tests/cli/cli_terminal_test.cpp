// Pictures on a terminal: the program writes to a pseudo-terminal, and what it wrote is decoded.
#include <sys/ioctl.h>
#include <termios.h>

#include <regex>

#include "run_command.h"

namespace whit::cli {
namespace {

using Variables = std::map<std::string, std::string>;

// Runs the program in `folder` with standard output on a terminal of 100x50 characters, and returns
// what it wrote there.
Outcome runOnTerminal(const std::vector<std::string>& words, const TemporaryFolder& folder,
                      const Variables& variables) {
  const int reader = posix_openpt(O_RDWR | O_NOCTTY);
  EXPECT_TRUE(grantpt(reader) == 0 && unlockpt(reader) == 0);
  const int terminal = open(ptsname(reader), O_RDWR | O_NOCTTY);

  // A raw terminal passes the bytes on unchanged.
  termios raw{};
  tcgetattr(terminal, &raw);
  cfmakeraw(&raw);
  tcsetattr(terminal, TCSANOW, &raw);
  const winsize size{50, 100, 0, 0};
  ioctl(terminal, TIOCSWINSZ, &size);

  const pid_t child = startWhit(words, folder, [&] {
    for (const char* name : {"TERM", "TERM_PROGRAM", "COLORTERM", "KITTY_WINDOW_ID", "LC_TERMINAL",
                             "KONSOLE_VERSION", "TMUX", "STY"}) {
      unsetenv(name);
    }
    for (const auto& [name, value] : variables) setenv(name.c_str(), value.c_str(), 1);
    dup2(terminal, STDOUT_FILENO);
    if (chdir(folder.path().c_str()) != 0) _exit(1);
  });

  close(terminal);
  Outcome outcome;
  char buffer[4096];
  for (ssize_t n; (n = ::read(reader, buffer, sizeof buffer)) > 0;) {
    outcome.out.append(buffer, static_cast<std::size_t>(n));
  }

  close(reader);
  outcome.status = waitFor(child);
  outcome.err = readFile(folder / "stderr");
  return outcome;
}

std::string decoded(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;

  for (const char c : base64.substr(0, base64.find('='))) {
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count >= 8) bytes += static_cast<char>(bits >> (count -= 8) & 255);
  }
  return bytes;
}

class TerminalPictures : public TinySceneTest {
 protected:
  Outcome render(const Variables& variables, const std::string& words = "", int status = 0) {
    const Outcome outcome = runOnTerminal(split("render tiny.json " + words), folder_, variables);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return outcome;
  }
  // The data, decoded, is a PNG with the pixels of tiny.png.
  void expectThePicture(const std::string& data) {
    save("shown.png", decoded(data));
    EXPECT_EQ(storedIn("shown.png").codes, storedIn("tiny.png").codes);
  }
};

TEST_F(TerminalPictures, ByTheProtocolOfKitty) {
  for (const Variables& variables : {Variables{{"TERM", "xterm-kitty"}},
                                     {{"TERM", "xterm"}, {"TERM_PROGRAM", "ghostty"}},
                                     {{"TERM", "xterm"}, {"KONSOLE_VERSION", "220401"}}}) {
    const Outcome outcome = render(variables, "--size 200x140");

    const std::regex part("\x1b_G([a-zA-Z0-9=,]*);([^\x1b]*)\x1b\\\\");
    std::string data, rest = outcome.out;
    std::vector<std::string> heads;
    // The chunks follow each other without gaps, and none is too long.
    for (std::smatch m; std::regex_search(rest, m, part); rest = m.suffix()) {
      EXPECT_EQ(m.position(), 0);
      EXPECT_LE(m[2].length(), 4096);
      heads.push_back(m[1]);
      data += m[2];
    }

    EXPECT_EQ(rest, "\n");
    ASSERT_GT(heads.size(), 1u) << "one chunk tests nothing";
    EXPECT_EQ(heads.front(), "a=T,f=100,q=2,c=25,m=1");
    EXPECT_EQ(heads.back(), "m=0");
    expectThePicture(data);
    EXPECT_TRUE(hasText(outcome.err, "wrote tiny.png"));
  }
}

TEST_F(TerminalPictures, ByTheProtocolOfIterm) {
  const Outcome outcome = render({{"TERM", "xterm"}, {"TERM_PROGRAM", "iTerm.app"}});

  std::smatch m;
  ASSERT_TRUE(std::regex_match(
      outcome.out, m, std::regex("\x1b\\]1337;File=inline=1;size=(\\d+);width=6:([^\a]*)\a\n")))
      << outcome.out.substr(0, 60);
  EXPECT_EQ(std::stoul(m[1]), decoded(m[2]).size());
  expectThePicture(m[2]);
}

TEST_F(TerminalPictures, AsHalfBlocksInColor) {
  const Outcome outcome = render({{"TERM", "xterm"}, {"COLORTERM", "truecolor"}});

  const RawImage image = storedIn("tiny.png");
  ASSERT_EQ(image.channels, 3);

  // A half block shows two rows of pixels, the upper one in its own color.
  std::string expected;
  for (std::size_t y = 0; y < 32; y += 2) {
    for (std::size_t x = 0; x < 48; ++x) {
      for (const std::size_t row : {y, y + 1}) {
        const std::uint8_t* const c = &image.codes[3 * (row * 48 + x)];
        expected += (row == y ? "\x1b[38;2;" : "\x1b[48;2;") + std::to_string(c[0]) + ";" +
                    std::to_string(c[1]) + ";" + std::to_string(c[2]) + "m";
      }
      expected += "\u2580";
    }
    expected += "\x1b[0m\n";
  }

  EXPECT_EQ(outcome.out, expected);
}

TEST_F(TerminalPictures, LargeOnesFitTheTerminal) {
  const Variables colors{{"TERM", "xterm"}, {"COLORTERM", "24bit"}};
  const auto blocks = [](const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find("\u2580", at)) != std::string::npos; ++at) ++count;
    return count;
  };

  const std::string wide = render(colors, "--size 300x40").out;
  EXPECT_EQ(blocks(wide.substr(0, wide.find('\n'))), 100u);
  const std::string high = render(colors, "--size 300x490").out;
  EXPECT_EQ(std::ranges::count(high, '\n'), 49);
  EXPECT_EQ(blocks(high.substr(0, high.find('\n'))), 60u);
}

TEST_F(TerminalPictures, NothingWhereItWouldNotBeSeen) {
  const Variables kitty{{"TERM", "xterm-kitty"}};
  EXPECT_EQ(render({{"TERM", "xterm"}}).out, "");
  EXPECT_EQ(render({{"TERM", "dumb"}, {"COLORTERM", "truecolor"}}).out, "");
  EXPECT_EQ(render({{"TERM", "screen"}, {"TMUX", "/tmp/x"}, {"KITTY_WINDOW_ID", "1"}}).out, "");
  EXPECT_EQ(render(kitty, "--quiet").out, "");
  EXPECT_EQ(render(kitty, "-o a.png").out, "");
  const std::string json = render(kitty, "--json -").out;
  EXPECT_TRUE(json.starts_with("{")) << json;
}

TEST_F(TerminalPictures, AskedForByADash) {
  EXPECT_TRUE(render({{"TERM", "xterm-kitty"}}, "-o - --quiet").out.starts_with("\x1b_G"));
  EXPECT_FALSE(exists("tiny.png"));
  EXPECT_TRUE(hasText(render({{"TERM", "xterm"}}, "-o -", 2).err, "shows no pictures"));
}

}  // namespace
}  // namespace whit::cli
