// No command writes over a file that it reads, or writes two results to one file.
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "has_text.h"
#include "run_command.h"

namespace whit::cli {
namespace {

namespace fs = std::filesystem;

struct Refusal {
  const char* line;  // the words after "whit", separated by blanks
  const char* both;  // what the message says of the two files
};

constexpr Refusal kRefusals[] = {
    // A result in place of the scene, by the same name or by another one of the same file
    {"render tiny.json --json tiny.json", "'tiny.json': it is the same as 'tiny.json'"},
    {"render tiny.json --json ./tiny.json", "'./tiny.json': it is the same as 'tiny.json'"},
    {"render tiny.json --json sub/../tiny.json", "it is the same as 'tiny.json'"},
    {"render tiny.json --json link.json", "'link.json': it is the same as 'tiny.json'"},
    {"render link.json --json tiny.json", "'tiny.json': it is the same as 'link.json'"},
    {"info tiny.json --json tiny.json", "it is the same as 'tiny.json'"},
    {"explain tiny.json --pixel 1,1 --json tiny.json", "it is the same as 'tiny.json'"},
    {"bench tiny.json --json tiny.json", "it is the same as 'tiny.json'"},
    {"bench tiny.json link.json --json tiny.json", "'tiny.json': it is the same as"},
    {"turntable tiny.json -o f##.png --json tiny.json", "it is the same as 'tiny.json'"},
    {"compare tiny.json --json tiny.json", "it is the same as 'tiny.json'"},

    // In place of another file that is read
    {"render tiny.json --sky a.png -o a.png", "'a.png': it is the same as 'a.png'"},
    {"render tiny.json --camera eye.json --json eye.json", "it is the same as 'eye.json'"},
    {"render tiny.json --sky f0001.png --frames 0..3 -o f####.png",
     "it is the same as 'f0001.png'"},
    {"compare a.png b.png --heatmap a.png", "'a.png': it is the same as 'a.png'"},
    {"compare a.png b.png --json b.png", "'b.png': it is the same as 'b.png'"},
    {"merge part.exr part.exr other.exr", "'part.exr': it is the same as 'part.exr'"},

    // Two results in one file
    {"render tiny.json -o z.png -o z.png", "'z.png': it is the same as 'z.png'"},
    {"render tiny.json -o z.png -o ./z.png", "'./z.png': it is the same as 'z.png'"},
    {"render tiny.json -o z.png --json z.png", "'z.png': it is the same as 'z.png'"},
    {"render tiny.json --frames 0..12 -o f#.png -o f##.png", "it is the same as 'f12.png'"},
    {"bench tiny.json --csv z.csv --json z.csv", "it is the same as 'z.csv'"},
    {"explain tiny.json --pixel 1,1 --html z.html --json z.html", "it is the same as 'z.html'"},
    {"explain tiny.json --pixel 1,1 --svg z.svg --json z.svg", "it is the same as 'z.svg'"},
    {"compare tiny.json --heatmap z.png --json z.png", "it is the same as 'z.png'"},
};

// The contents of a folder's files, by their names.
std::map<std::string, std::string> contentsOf(const TemporaryFolder& folder) {
  std::map<std::string, std::string> contents;
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    if (entry.is_regular_file()) contents[entry.path().filename()] = readFile(entry.path());
  }
  return contents;
}

TEST_F(TinySceneTest, NoFileIsWrittenOverAnother) {
  fs::create_symlink("tiny.json", folder_ / "link.json");
  fs::create_directory(folder_ / "sub");
  for (const char* file : {"a.png", "b.png", "f0001.png", "part.exr", "other.exr"}) {
    std::ofstream(folder_ / file) << "not looked at";
  }
  std::ofstream(folder_ / "eye.json") << R"({"eye": [0, 2, 6], "at": [0, 1, 0]})";
  const auto before = contentsOf(folder_);

  for (const Refusal& refusal : kRefusals) {
    SCOPED_TRACE(std::string("whit ") + refusal.line);
    std::istringstream line(refusal.line);
    const Words words{std::istream_iterator<std::string>(line), {}};
    const Outcome outcome = runWhit(words, [&] { (void)chdir(folder_.path().c_str()); });

    expectFailed(outcome, 2, refusal.both);
    EXPECT_EQ(contentsOf(folder_), before);
  }
}

// Devices take several results, and a file that is not read may be replaced.
TEST_F(TinySceneTest, OtherFilesAreWritten) {
  succeed({"explain", tiny_, "--pixel", "1,1", "--json", "/dev/null", "--quiet"});
  std::ofstream(folder_ / "f1.png") << "old";
  succeed({"render", tiny_, "--frames", "0..1", "-o", folder_ / "f#.png", "--quiet"});
  EXPECT_NE(readFile(folder_ / "f1.png"), "old");
}

}  // namespace
}  // namespace whit::cli
