// No command writes over a file that it reads, or writes two results to one file.
#include "run_here.h"

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

TEST_F(TinySceneTest, NoFileIsWrittenOverAnother) {
  fs::create_symlink("tiny.json", folder_ / "link.json");
  fs::create_directory(folder_ / "sub");
  for (const char* file : {"a.png", "b.png", "f0001.png", "part.exr", "other.exr"}) {
    save(file, "not looked at");
  }
  save("eye.json", "{'eye': [0, 2, 6], 'at': [0, 1, 0]}");

  const auto contents = [&] {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      if (entry.is_regular_file()) all[entry.path().filename()] = readFile(entry.path());
    }
    return all;
  };
  const auto before = contents();

  for (const Refusal& refusal : kRefusals) {
    SCOPED_TRACE(std::string("whit ") + refusal.line);
    expectFailed(runHere(refusal.line, folder_), 2, refusal.both);
    EXPECT_EQ(contents(), before);
  }
}

// Devices take several results, and a file that is not read may be replaced.
TEST_F(TinySceneTest, OtherFilesAreWritten) {
  succeed("explain tiny.json --pixel 1,1 --json /dev/null");
  save("f1.png", "old");
  succeed("render tiny.json --frames 0..1 -o f#.png");
  EXPECT_NE(bytesOf("f1.png"), "old");
}

}  // namespace
}  // namespace whit::cli
