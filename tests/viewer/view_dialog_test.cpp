// Files chosen in a dialog, whose programs are scripts here.
#include <gtest/gtest.h>

#include "viewer_fixture.h"

namespace whit::view {
namespace {

namespace fs = std::filesystem;

// A PATH on which there is nothing but what a test puts there.
class FileDialogs : public Viewer {
 protected:
  void SetUp() override {
    Viewer::SetUp();
    fs::create_directories(folder_ / "bin");
    before_ = std::getenv("PATH");
    setenv("PATH", (folder_ / "bin").c_str(), 1);
  }
  void TearDown() override { setenv("PATH", before_.c_str(), 1); }

  void install(const std::string& program, const std::string& does) {
    const std::string file = folder_ / ("bin/" + program);
    std::ofstream(file) << "#!/bin/sh\nfor word in \"$@\"; do echo \"$word\"; done > words\n"
                        << does << "\n";
    fs::permissions(file, fs::perms::owner_all);
  }

  std::string before_;
};

TEST_F(FileDialogs, OpenAScene) {
  std::ofstream(folder_ / "a b.json") << cli::readFile(folder_ / "tiny.json");
  for (const char* program : {"kdialog", "zenity"}) {
    install(program, "echo 'a b.json'");
    const cli::Outcome outcome =
        play("wait sharp\nkey Ctrl+O\nwait sharp\nwait 60 frames\nwait sharp\nkey C\n");
    EXPECT_EQ(outcome.out.find("whit render 'a b.json' "), 0u) << program << outcome.out;
    const std::string words = cli::readFile(folder_ / "words");
    EXPECT_NE(words.find("*.json *.gltf *.glb *.obj *.ply *.hdr *.exr"), std::string::npos);
    EXPECT_EQ(words.find(program == std::string("zenity") ? "--file-selection" : "--title"), 0u);
  }
}

// From the list of skies, while the picture goes on.
TEST_F(FileDialogs, OpenASky) {
  Image sky(2, 1);
  sky.pixels = {{1, 2, 3}, {3, 2, 1}};
  writeExr(folder_ / "sky.exr", sky, {});
  install("zenity", "echo sky.exr");
  const cli::Outcome outcome = play(
      "key N\npanel scene\nwait 10 frames\nclick 80 337\nwait 5 frames\nclick 60 412\n"
      "wait sharp\nwait 30 frames\nwait sharp\nkey C\n",
      {"--size", "800x560"});
  EXPECT_NE(outcome.out.find("/sky.exr\"}"), std::string::npos) << outcome.out;
  EXPECT_NE(cli::readFile(folder_ / "words").find("Skies | *.hdr *.exr"), std::string::npos);
}

TEST_F(FileDialogs, MayBeCancelled) {
  install("zenity", "exit 1");
  const cli::Outcome outcome = play("key N\nwait sharp\nkey Ctrl+O\nwait sharp\nkey C\n");
  EXPECT_EQ(outcome.out, "whit render tiny.json -o tiny.png\n");
}

TEST_F(FileDialogs, ThatFailAreTold) {
  install("zenity", "exit 255");
  const cli::Outcome outcome = play("errors show\nwait sharp\nkey Ctrl+O\nwait sharp\n");
  EXPECT_NE(outcome.err.find("has failed"), std::string::npos) << outcome.err;
}

TEST_F(FileDialogs, ThatAreNotInstalledAreTold) {
  const cli::Outcome outcome = play(
      "errors show\nkey H\nwait sharp\nscreenshot before.png\nkey Ctrl+O\nwait 5 frames\n"
      "screenshot told.png\n",
      {"--size", "640x200"});
  EXPECT_NE(outcome.err.find("install zenity or kdialog"), std::string::npos) << outcome.err;
  EXPECT_NE(codes("before.png").codes, codes("told.png").codes);
}

// It neither holds the viewer up nor outlives it.
TEST_F(FileDialogs, AreClosedWithTheViewer) {
  install("zenity", "echo $$ > id; exec /bin/sleep 1000");
  play("wait sharp\nkey Ctrl+O\nkey Ctrl+O\nwait 200 frames\nkey D 1\nwait 100 frames\nquit\n");
  const std::string id = cli::readFile(folder_ / "id");
  ASSERT_FALSE(id.empty());
  EXPECT_EQ(::kill(std::stoi(id), 0), -1) << "it is still there";
}

}  // namespace
}  // namespace whit::view
