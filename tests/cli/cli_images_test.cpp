// Images that the program writes: what they say, and that nothing half-written is left.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "has_text.h"
#include "picture_file.h"
#include "run_command.h"
#include "simd/kernels.h"

namespace whit::cli {
namespace {

namespace fs = std::filesystem;

void render(const Words& words) { succeed(joined({"render"}, words)); }

Image read(const std::string& path) { return readImage(path, ImageLimits()); }

bool sameBits(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Rgb)) == 0;
}

bool handlesInterrupts(pid_t child) {
  std::ifstream in("/proc/" + std::to_string(child) + "/status");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("SigCgt:", 0) != 0) continue;
    return (std::stoull(line.substr(7), nullptr, 16) & (1ull << (SIGINT - 1))) != 0;
  }
  return false;
}

TEST(Render, WithoutOutputWritesTheScenesName) {
  const TemporaryFolder folder;
  writeTinyScene(folder);
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const Outcome outcome = runWhit({"render", "tiny.json"});
  const Outcome again = runWhit({"render", "tiny.json"});

  // A picture of the default name must not overwrite a file that whit did not write.
  std::ofstream("other.png") << "a texture";
  std::filesystem::copy_file("tiny.json", "other.json");
  const Outcome refused = runWhit({"render", "other.json"});
  std::filesystem::current_path(before);

  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(hasText(refused.err, "'other.png' exists"));
  EXPECT_EQ(readFile(folder / "other.png"), "a texture");
  EXPECT_EQ(outcome.out, "");  // standard output is no terminal
  EXPECT_TRUE(hasText(outcome.err, "wrote tiny.png"));
  EXPECT_EQ(readFile(folder / "tiny.png").substr(1, 3), "PNG");
  EXPECT_EQ(runWhit({"render", folder / "tiny.json", "--frames", "0..1"}).status, 2);
}

class Images : public TinySceneTest {};

TEST_F(Images, TheSameRenderGivesTheSameBytes) {
  render({tiny_, "-o", folder_ / "a.exr", "-o", folder_ / "a.png", "--threads", "1"});
  render(
      {tiny_, "-o", folder_ / "b.exr", "-o", folder_ / "b.png", "--threads", "3", "--tile", "16"});

  EXPECT_EQ(readFile(folder_ / "a.exr"), readFile(folder_ / "b.exr"));
  EXPECT_EQ(readFile(folder_ / "a.png"), readFile(folder_ / "b.png"));
}

TEST_F(Images, SayHowTheyWereMade) {
  render({tiny_, "-o", folder_ / "a.exr", "-o", folder_ / "a.png", "--camera", "side", "--depth",
          "3", "--crop", "8,4,40,20"});

  const auto said = metadataOf(folder_ / "a.exr");
  const std::pair<const char*, const char*> expected[] = {
      {"scene", "tiny"}, {"size", "48x32"}, {"crop", "8,4,40,20"}, {"camera", "side"},
      {"eye", "6,2,0"},  {"at", "0,1,0"},   {"up", "0,1,0"},       {"fov", "40"},
      {"depth", "3"},    {"spp", "1"},      {"mode", "packets"},   {"robust", "on"}};
  for (const auto& [name, text] : expected) {
    ASSERT_TRUE(said.contains(name)) << name;
    EXPECT_EQ(said.at(name), text) << name;
  }

  EXPECT_EQ(said.at("software").rfind("whit ", 0), 0u);
  EXPECT_TRUE(hasText(said.at("effectsUsed"), "mirror"));
  EXPECT_NE(said.at("packet"), "auto");
  // Metadata must not depend on the run, or pictures would differ from run to run.
  for (const char* secret : {"threads", "date", "host", "capDate", "owner"}) {
    EXPECT_FALSE(said.contains(secret)) << secret;
  }

  const std::string png = readFile(folder_ / "a.png");
  EXPECT_TRUE(hasText(png, "tEXt"));
  EXPECT_TRUE(hasText(png, "software"));
}

TEST_F(Images, MetadataMakesTheImageAgain) {
  render({tiny_, "-o", folder_ / "a.exr", "--eye", "1.1,2.3,5.7", "--fov", "33.3", "--cutoff",
          "0.01", "--spp", "2", "--disable", "shadows"});

  Words words{tiny_, "-o", folder_ / "b.exr"};
  // These members describe the picture, but no option sets them.
  const std::set<std::string> noOptions{"software", "scene", "sceneDigest", "effectsUsed",
                                        "strict"};
  for (const auto& [name, text] : metadataOf(folder_ / "a.exr")) {
    if (noOptions.contains(name)) continue;
    words.push_back("--" + name + "=" + text);
  }

  render(words);
  EXPECT_TRUE(sameBits(read(folder_ / "a.exr"), read(folder_ / "b.exr")));
}

TEST_F(Images, CropsMergeToTheWhole) {
  render({tiny_, "-o", folder_ / "whole.exr"});
  const char* crops[] = {"0,0,20,32", "20,0,48,10", "20,10,48,32"};
  Words merge{"merge", folder_ / "merged.exr"};
  for (const char* crop : crops) {
    merge.push_back(folder_ / (std::string(crop) + ".exr"));
    render({tiny_, "-o", merge.back(), "--crop", crop});
  }

  succeed(merge);
  EXPECT_TRUE(sameBits(read(folder_ / "whole.exr"), read(folder_ / "merged.exr")));

  // A merged picture must have no gap.
  merge.pop_back();
  merge[1] = folder_ / "gap.exr";
  EXPECT_EQ(runWhit(merge).status, 2);
  EXPECT_FALSE(fs::exists(folder_ / "gap.exr"));
}

TEST_F(Images, FramesFollowThePath) {
  render({tiny_, "-o", folder_ / "f-###.exr", "--frames", "0..2", "--fps", "2"});
  EXPECT_EQ(metadataOf(folder_ / "f-000.exr").at("eye"), "0,2,6");
  EXPECT_EQ(metadataOf(folder_ / "f-002.exr").at("eye"), "6,2,0");  // frame 2 of 2 a second: 1 s
  EXPECT_EQ(metadataOf(folder_ / "f-001.exr").at("frame"), "1");
}

// A file that is written anew is another file of that name.
ino_t fileNumber(const std::string& path) {
  struct stat info {};
  EXPECT_EQ(stat(path.c_str(), &info), 0) << path;
  return info.st_ino;
}

TEST_F(Images, ResumingTracesWhatIsMissingCutOffOrMadeOtherwise) {
  for (const std::string type : {".exr", ".png"}) {
    const auto frame = [&](int i) { return folder_ / ("f-" + std::to_string(i) + type); };
    Words words{tiny_, "-o", folder_ / ("f-#" + type), "--frames", "0..5"};
    render(words);

    std::vector<std::string> whole;
    for (int i = 0; i <= 5; ++i) whole.push_back(readFile(frame(i)));

    // One frame is missing, two are damaged, and one has another depth.
    fs::remove(frame(1));
    std::ofstream(frame(2), std::ios::binary) << whole[2].substr(0, whole[2].size() - 9);
    std::ofstream(frame(3), std::ios::binary) << "no image at all";
    render({tiny_, "-o", words[2], "--frames", "4", "--depth", "1"});
    // A frame that another machine made with other SIMD lanes is kept, because its pixels do not
    // depend on them.
    const std::string narrowest = simd::availableTargets().back();
    render({tiny_, "-o", words[2], "--frames", "5", "--simd", narrowest, "--packet", "4"});
    const std::string others = readFile(frame(5));
    const ino_t kept[] = {fileNumber(frame(0)), fileNumber(frame(5))};
    words.insert(words.end(), {"--resume", "--threads", "1"});
    render(words);

    for (int i = 0; i <= 4; ++i)
      EXPECT_TRUE(readFile(frame(i)) == whole[static_cast<std::size_t>(i)]) << i << type;
    EXPECT_EQ(fileNumber(frame(0)), kept[0]) << "traced again";
    EXPECT_EQ(fileNumber(frame(5)), kept[1]) << "traced again";

    // An option that is given must agree with the frame's.
    for (const auto& [option, value] : {std::pair<std::string, std::string>{"--packet", "8"},
                                        {"--simd", simd::availableTargets().front()}}) {
      if (value == narrowest) continue;  // the machine has a single target
      std::ofstream(frame(5), std::ios::binary) << others;
      Words asked = words;
      asked.insert(asked.end(), {option, value});
      render(asked);
      EXPECT_FALSE(readFile(frame(5)) == others) << option;
    }
  }
}

TEST_F(Images, ResumingKnowsCropsAndWritesWhatOneOfTwoFilesLacks) {
  const Words words{tiny_,    "-o",        folder_ / "a.exr", "-o", folder_ / "a.png",
                    "--crop", "8,4,40,20", "--resume"};
  render(words);
  const ino_t first = fileNumber(folder_ / "a.exr");
  render(words);
  EXPECT_EQ(fileNumber(folder_ / "a.exr"), first);

  fs::remove(folder_ / "a.png");
  render(words);
  EXPECT_TRUE(fs::exists(folder_ / "a.png"));

  render({tiny_, "-o", folder_ / "a.exr", "--crop", "8,4,40,21", "--resume"});
  EXPECT_EQ(read(folder_ / "a.exr").windowHeight(), 17);
}

// Only those parts of the scene's file, and of the files that it names, count on which a picture
// can depend.
TEST_F(Images, ResumingTracesAnotherStateOfTheScene) {
  const std::string text = readFile(tiny_);
  for (const std::string type : {".exr", ".png"}) {
    const std::string image = folder_ / ("a" + type);
    const auto numberAfter = [&](const std::string& scene) {
      std::ofstream(tiny_) << scene;
      // The file is held open, so that the file that replaces it does not get the same number.
      const std::ifstream held(image);
      render({tiny_, "-o", image, "--resume"});
      return fileNumber(image);
    };

    const ino_t first = numberAfter(text);
    const std::string whole = readFile(image);
    EXPECT_EQ(numberAfter("// a remark\n" + text), first) << "traced again";

    // A remark changes no picture; another color does.
    std::string changed = text;
    changed.replace(changed.find("\"diffuse\": 0.5"), 14, "\"diffuse\": 0.4");
    const ino_t second = numberAfter(changed);
    EXPECT_NE(second, first) << "not traced again";
    EXPECT_FALSE(readFile(image) == whole);
    EXPECT_EQ(numberAfter(changed), second) << "traced again";

    numberAfter(text);
    EXPECT_TRUE(readFile(image) == whole);
  }
}

// Each frame is written while the next one is traced.
TEST_F(Images, AFrameThatCannotBeWrittenEndsTheFilmAndLeavesTheOnesBefore) {
  const TemporaryFolder results;
  fs::create_directory(results / "f-2.exr");
  expectFailure(
      {"render", tiny_, "-o", results / "f-#.exr", "-o", results / "f-#.png", "--frames", "0..9"},
      4, "f-2.exr");

  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(results.path())) {
    names.insert(entry.path().filename().string());
  }
  EXPECT_EQ(names, (std::set<std::string>{"f-0.exr", "f-0.png", "f-1.exr", "f-1.png", "f-2.exr"}));
  EXPECT_EQ(read(results / "f-1.exr").width, 48);
}

// Frames alternate between two films. With memory for one film only, each frame is written before
// the next one is traced.
TEST_F(Images, FramesDoNotDependOnWhetherTheyAreWrittenBesideTheNext) {
  Words words{tiny_,    "-o",     folder_ / "two-#.exr", "--frames", "0..4", "--fps", "4",
              "--size", "480x320"};
  render(words);
  // The limit is enough for one film, but not for two.
  words[2] = folder_ / "one-#.exr";
  words.insert(words.end(), {"--max-memory", "0.006"});
  render(words);

  for (const std::string frame : {"0", "1", "2", "3", "4"}) {
    words = {tiny_,    "-o",     folder_ / "alone-#.exr", "--frames", frame, "--fps", "4",
             "--size", "480x320"};
    render(words);

    const std::string alone = readFile(folder_ / ("alone-" + frame + ".exr"));
    EXPECT_TRUE(readFile(folder_ / ("two-" + frame + ".exr")) == alone) << frame;
    EXPECT_TRUE(readFile(folder_ / ("one-" + frame + ".exr")) == alone) << frame;
  }
}

TEST_F(Images, GoToStandardOutputAsPng) {
  render({tiny_, "-o", folder_ / "f#.png", "-o", folder_ / "f#.exr", "--frames", "0..1"});

  const Outcome both = succeed({"render", tiny_, "-o", "-", "--frames", "0..1"});
  EXPECT_TRUE(both.out == readFile(folder_ / "f0.png") + readFile(folder_ / "f1.png"));
  EXPECT_TRUE(hasText(both.err, "wrote 2 images"));

  // A full device is an error of writing.
  const Outcome full = runWhit({"render", tiny_, "-o", "-"},
                               [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); });
  EXPECT_EQ(full.status, 4) << full.err;
}

TEST_F(Images, SayHowAnExrIsStoredAndResumeByIt) {
  const std::string image = folder_ / "a.exr";
  render({tiny_, "-o", image});
  EXPECT_FALSE(metadataOf(image).contains("exr"));
  const Image exact = read(image);

  render({tiny_, "-o", image, "--exr", "none"});
  EXPECT_TRUE(sameBits(read(image), exact));

  render({tiny_, "-o", image, "--exr", "half", "--resume"});
  EXPECT_EQ(metadataOf(image).at("exr"), "half");
  EXPECT_FALSE(sameBits(read(image), exact));

  // Resuming keeps a file that is stored in the same way.
  const ino_t first = fileNumber(image);
  render({tiny_, "-o", image, "--exr", "half", "--resume"});
  EXPECT_EQ(fileNumber(image), first) << "traced again";
}

// PNG has straight colors, EXR premultiplied ones; both have the same alpha.
TEST_F(Images, ATransparentBackgroundIsAlpha) {
  render({"glossy", "-o", folder_ / "a.png", "-o", folder_ / "a.exr", "--size", "64x32", "--spp",
          "4", "--background", "transparent", "--quiet"});
  const RawImage png = storedIn(folder_ / "a.png"), exr = storedIn(folder_ / "a.exr");
  ASSERT_EQ(png.channels, 4);
  ASSERT_EQ(exr.channels, 4);

  int partly = 0;
  for (std::size_t i = 0; i < png.pixels(); ++i) {
    const float alpha = exr.values[4 * i + 3];
    EXPECT_EQ(png.codes[4 * i + 3], std::lround(255 * alpha));
    partly += alpha > 0 && alpha < 1;
    if (alpha == 0) {
      EXPECT_EQ(exr.values[4 * i], 0);
    }
  }

  EXPECT_EQ(png.codes[3], 0) << "the sky";
  EXPECT_EQ(png.codes.back(), 255) << "the floor";
  EXPECT_GT(partly, 10);
}

TEST_F(Images, ABackgroundColorIsShownAsItIs) {
  render({"glossy", "-o", folder_ / "a.png", "-o", folder_ / "a.jpg", "--size", "64x32",
          "--background", "ff8000", "--exposure", "2", "--tonemap", "filmic", "--quiet"});

  const RawImage png = storedIn(folder_ / "a.png"), jpeg = storedIn(folder_ / "a.jpg");
  ASSERT_EQ(jpeg.channels, 3);
  // JPEG rounds the brightness and the two differences of color of a flat block, and such an orange
  // lies at the border of what they can express.
  constexpr int kRounded = 12;
  for (const std::size_t channel : {0, 1, 2}) {
    EXPECT_NEAR(jpeg.codes[channel], png.codes[channel], kRounded) << channel;
  }
  ASSERT_EQ(png.channels, 3);
  EXPECT_EQ(std::vector<int>(png.codes.begin(), png.codes.begin() + 3),
            (std::vector<int>{255, 128, 0}));
}

// A mean difference below 8 codes allows for JPEG's losses at this quality, in flat and textured
// parts alike.
TEST_F(Images, AreWrittenAsJpeg) {
  render({"matte", "-o", folder_ / "a.png", "-o", folder_ / "a.jpg", "--size", "96x64", "--quiet"});
  const RawImage png = storedIn(folder_ / "a.png"), jpeg = storedIn(folder_ / "a.jpg");
  ASSERT_EQ(jpeg.channels, 3);
  ASSERT_EQ(jpeg.codes.size(), png.codes.size());

  double sum = 0;
  for (std::size_t i = 0; i < png.codes.size(); ++i) sum += std::abs(png.codes[i] - jpeg.codes[i]);
  EXPECT_LT(sum / static_cast<double>(png.codes.size()), 8);
  EXPECT_GT(sum, 0);
}

TEST_F(Images, AnInterruptionLeavesOnlyWholeFiles) {
  const TemporaryFolder results, logs;
  const pid_t child =
      startWhit({"render", tiny_, "-o", results / "f-#.exr", "--frames", "0..999999"}, logs);
  ASSERT_TRUE(waitUntil(child, [&] { return fs::exists(results / "f-3.exr"); }))
      << readFile(logs / "stderr");

  kill(child, SIGINT);
  EXPECT_EQ(waitFor(child), 130);
  for (const auto& entry : fs::directory_iterator(results.path())) {
    const std::string name = entry.path().filename().string();
    EXPECT_EQ(name.rfind("f-", 0), 0u) << name;
    EXPECT_EQ(read(entry.path().string()).width, 48) << name;
  }
}

TEST_F(Images, AnInterruptionDoesNotWaitForTheImage) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder, results, logs;
    // This picture would take hours.
    const pid_t child = startWhit({"render", tiny_, "-o", results / "a.exr", "--size", "8192x8192",
                                   "--spp", "4096", "--mode", "reference"},
                                  logs);
    ASSERT_TRUE(waitUntil(child, [&] { return handlesInterrupts(child); }));
    kill(child, signal);
    EXPECT_EQ(waitFor(child), 130);
    EXPECT_TRUE(fs::is_empty(results.path()));
  }
}

}  // namespace
}  // namespace whit::cli
