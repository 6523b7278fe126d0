// Images that the program writes: what they say, and that nothing half-written is left.
#include <cmath>
#include <cstring>
#include <set>

#include "run_command.h"
#include "simd/kernels.h"

namespace whit::cli {
namespace {

namespace fs = std::filesystem;

bool handlesInterrupts(pid_t child) {
  std::ifstream in("/proc/" + std::to_string(child) + "/status");
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("SigCgt:")) continue;
    return (std::stoull(line.substr(7), nullptr, 16) & (1ull << (SIGINT - 1))) != 0;
  }
  return false;
}

class Render : public TinySceneTest {};

TEST_F(Render, WithoutOutputWritesTheScenesName) {
  const Outcome outcome = succeed("render tiny.json");
  EXPECT_EQ(outcome.out, "");  // standard output is no terminal
  EXPECT_TRUE(hasText(outcome.err, "wrote tiny.png"));
  EXPECT_EQ(bytesOf("tiny.png").substr(1, 3), "PNG");
  succeed("render tiny.json");

  // A picture of the default name must not overwrite a file that whit did not write.
  save("other.png", "a texture");
  fs::copy_file(tiny_, folder_ / "other.json");
  expectFailure("render other.json", 2, "'other.png' exists");
  EXPECT_EQ(bytesOf("other.png"), "a texture");
  EXPECT_EQ(run("render tiny.json --frames 0..1").status, 2);
}

class Images : public TinySceneTest {
 protected:
  // Renders the tiny scene.
  void render(const std::string& words) const { succeed("render tiny.json " + words); }

  bool sameBits(const std::string& a, const std::string& b) const {
    const Image first = imageIn(a), second = imageIn(b);
    return first.pixels.size() == second.pixels.size() &&
           std::memcmp(first.pixels.data(), second.pixels.data(),
                       first.pixels.size() * sizeof(Rgb)) == 0;
  }
};

TEST_F(Images, SayHowTheyWereMade) {
  render("-o a.exr -o a.png --camera side --depth 3 --crop 8,4,40,20");

  auto said = metadataOf("a.exr");
  const std::pair<const char*, const char*> expected[] = {
      {"scene", "tiny"}, {"size", "48x32"}, {"crop", "8,4,40,20"}, {"camera", "side"},
      {"eye", "6,2,0"},  {"at", "0,1,0"},   {"up", "0,1,0"},       {"fov", "40"},
      {"depth", "3"},    {"spp", "1"},      {"mode", "packets"},   {"robust", "on"}};
  for (const auto& [name, text] : expected) EXPECT_EQ(said[name], text) << name;

  EXPECT_TRUE(said["software"].starts_with("whit ")) << said["software"];
  EXPECT_TRUE(hasText(said["effectsUsed"], "mirror"));
  EXPECT_NE(said["packet"], "auto");
  // Metadata must not depend on the run, or pictures would differ from run to run.
  for (const char* secret : {"threads", "date", "host", "capDate", "owner"}) {
    EXPECT_FALSE(said.contains(secret)) << secret;
  }

  const std::string png = bytesOf("a.png");
  EXPECT_TRUE(hasText(png, "tEXt"));
  EXPECT_TRUE(hasText(png, "software"));
}

TEST_F(Images, MetadataMakesTheImageAgain) {
  render("-o a.exr --eye 1.1,2.3,5.7 --fov 33.3 --cutoff 0.01 --spp 2 --disable shadows");

  std::string words = "-o b.exr";
  // These members describe the picture, but no option sets them.
  const std::set<std::string> noOptions{"software", "scene", "sceneDigest", "effectsUsed",
                                        "strict"};
  for (const auto& [name, text] : metadataOf("a.exr")) {
    if (!noOptions.contains(name)) words += " --" + name + "=" + text;
  }

  render(words);
  EXPECT_TRUE(sameBits("a.exr", "b.exr"));
}

TEST_F(Images, FramesFollowThePath) {
  render("-o f-###.exr --frames 0..2 --fps 2");
  EXPECT_EQ(metadataOf("f-000.exr")["eye"], "0,2,6");
  EXPECT_EQ(metadataOf("f-002.exr")["eye"], "6,2,0");  // frame 2 of 2 a second: 1 s
  EXPECT_EQ(metadataOf("f-001.exr")["frame"], "1");
}

TEST_F(Images, ResumingTracesWhatIsMissingCutOffOrMadeOtherwise) {
  for (const std::string type : {".exr", ".png"}) {
    const auto frame = [&](int i) { return "f-" + std::to_string(i) + type; };
    const std::string line = "-o f-#" + type + " --frames ";
    render(line + "0..5");

    std::vector<std::string> whole;
    for (int i = 0; i <= 5; ++i) whole.push_back(bytesOf(frame(i)));

    // One frame is missing, two are damaged, and one has another depth.
    fs::remove(folder_ / frame(1));
    save(frame(2), whole[2].substr(0, whole[2].size() - 9));
    save(frame(3), "no image at all");
    render(line + "4 --depth 1");
    // A frame that another machine made with other SIMD lanes is kept, because its pixels do not
    // depend on them.
    const std::string narrowest = simd::availableTargets().back();
    render(line + "5 --packet 4 --simd " + narrowest);
    const std::string others = bytesOf(frame(5));
    const ino_t first = fileNumber(frame(0)), last = fileNumber(frame(5));
    const std::string resuming = line + "0..5 --resume --threads 1";
    render(resuming);

    for (int i = 0; i <= 4; ++i) {
      EXPECT_TRUE(bytesOf(frame(i)) == whole[static_cast<std::size_t>(i)]) << i << type;
    }
    EXPECT_EQ(fileNumber(frame(0)), first) << "traced again";
    EXPECT_EQ(fileNumber(frame(5)), last) << "traced again";

    // An option that is given must agree with the frame's.
    const std::string widest = simd::availableTargets().front();
    for (const std::string& option : {std::string(" --packet 8"), " --simd " + widest}) {
      if (option.ends_with(narrowest)) continue;  // the machine has a single target
      save(frame(5), others);
      render(resuming + option);
      EXPECT_FALSE(bytesOf(frame(5)) == others) << option;
    }
  }
}

TEST_F(Images, ResumingKnowsCropsAndWritesWhatOneOfTwoFilesLacks) {
  const std::string words = "-o a.exr -o a.png --crop 8,4,40,20 --resume";
  render(words);
  EXPECT_TRUE(keeps("a.exr", "render tiny.json " + words));

  fs::remove(folder_ / "a.png");
  render(words);
  EXPECT_TRUE(exists("a.png"));

  render("-o a.exr --crop 8,4,40,21 --resume");
  EXPECT_EQ(imageIn("a.exr").windowHeight(), 17);
}

// Only those parts of the scene's file, and of the files that it names, count on which a picture
// can depend.
TEST_F(Images, ResumingTracesAnotherStateOfTheScene) {
  const std::string text = bytesOf("tiny.json");
  saveTiny("changed.json", "\"diffuse\": 0.5", "\"diffuse\": 0.4");
  const std::string changed = bytesOf("changed.json");

  for (const std::string image : {"a.exr", "a.png"}) {
    const auto isKeptFor = [&](const std::string& scene) {
      save("tiny.json", scene);
      return keeps(image, "render tiny.json --resume -o " + image);
    };

    render("-o " + image);
    const std::string whole = bytesOf(image);
    // A remark changes no picture; another color does.
    EXPECT_TRUE(isKeptFor("// a remark\n" + text));
    EXPECT_FALSE(isKeptFor(changed));
    EXPECT_FALSE(bytesOf(image) == whole);
    EXPECT_TRUE(isKeptFor(changed));

    EXPECT_FALSE(isKeptFor(text));
    EXPECT_TRUE(bytesOf(image) == whole);
  }
}

// Each frame is written while the next one is traced.
TEST_F(Images, AFrameThatCannotBeWrittenEndsTheFilmAndLeavesTheOnesBefore) {
  fs::create_directories(folder_ / "made/f-2.exr");
  expectFailure("render tiny.json -o made/f-#.exr -o made/f-#.png --frames 0..9", 4, "f-2.exr");

  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_ / "made")) {
    names.insert(entry.path().filename().string());
  }
  EXPECT_EQ(names, (std::set<std::string>{"f-0.exr", "f-0.png", "f-1.exr", "f-1.png", "f-2.exr"}));
  EXPECT_EQ(imageIn("made/f-1.exr").width, 48);
}

// Frames alternate between two films. With memory for one film only, each frame is written before
// the next one is traced.
TEST_F(Images, FramesDoNotDependOnWhetherTheyAreWrittenBesideTheNext) {
  const std::string line = "--fps 4 --size 480x320 --frames ";
  render(line + "0..4 -o two-#.exr");
  // The limit is enough for one film, but not for two.
  render(line + "0..4 -o one-#.exr --max-memory 0.006");

  for (const std::string frame : {"0", "1", "2", "3", "4"}) {
    render(line + frame + " -o alone-#.exr");
    const std::string alone = bytesOf("alone-" + frame + ".exr");
    EXPECT_TRUE(bytesOf("two-" + frame + ".exr") == alone) << frame;
    EXPECT_TRUE(bytesOf("one-" + frame + ".exr") == alone) << frame;
  }
}

TEST_F(Images, GoToStandardOutputAsPng) {
  render("-o f#.png -o f#.exr --frames 0..1");
  const Outcome both = succeed("render tiny.json -o - --frames 0..1");
  EXPECT_TRUE(both.out == bytesOf("f0.png") + bytesOf("f1.png"));
  EXPECT_TRUE(hasText(both.err, "wrote 2 images"));
}

TEST_F(Images, SayHowAnExrIsStoredAndResumeByIt) {
  render("-o exact.exr");
  EXPECT_FALSE(metadataOf("exact.exr").contains("exr"));
  render("-o a.exr --exr none");
  EXPECT_TRUE(sameBits("a.exr", "exact.exr"));

  render("-o a.exr --exr half --resume");
  EXPECT_EQ(metadataOf("a.exr")["exr"], "half");
  EXPECT_FALSE(sameBits("a.exr", "exact.exr"));

  // Resuming keeps a file that is stored in the same way.
  EXPECT_TRUE(keeps("a.exr", "render tiny.json -o a.exr --exr half --resume"));
}

// PNG has straight colors, EXR premultiplied ones; both have the same alpha.
TEST_F(Images, ATransparentBackgroundIsAlpha) {
  succeed("render glossy -o a.png -o a.exr --size 64x32 --spp 4 --background transparent");
  const RawImage png = storedIn("a.png"), exr = storedIn("a.exr");
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

TEST_F(Images, AreComparedByPremultipliedColors) {
  save("half.json",
       "{'whit': 1, 'scene': [{'shape': 'quad', 'material': 'm'}],"
       "'materials': {'m': {'diffuse': 0, 'emission': [1, 0.5, 0.2], 'coverage': 0.5}},"
       "'cameras': {'above': {'eye': [0, 3, 0], 'at': [0, 0, 0], 'up': [0, 0, -1]}}}");
  succeed("render half.json -o a.png -o a.exr --size 8x8 --background transparent");

  // Half a code of a color near white, and of alpha, is less than this.
  EXPECT_LT(jsonOf("compare a.png a.exr")["rmse"], 0.0065);
}

TEST_F(Images, ABackgroundColorIsShownAsItIs) {
  succeed(
      "render glossy -o a.png -o a.jpg --size 64x32 --background ff8000 --exposure 2 "
      "--tonemap filmic");

  const RawImage png = storedIn("a.png"), jpeg = storedIn("a.jpg");
  ASSERT_EQ(png.channels, 3);
  ASSERT_EQ(jpeg.channels, 3);
  // JPEG rounds the brightness and the two differences of color of a flat block, and such an orange
  // lies at the border of what they can express.
  constexpr int kRounded = 12;
  const int orange[] = {255, 128, 0};
  for (const std::size_t channel : {0, 1, 2}) {
    EXPECT_EQ(png.codes[channel], orange[channel]) << channel;
    EXPECT_NEAR(jpeg.codes[channel], orange[channel], kRounded) << channel;
  }
}

// A mean difference below 8 codes allows for JPEG's losses at this quality, in flat and textured
// parts alike.
TEST_F(Images, AreWrittenAsJpeg) {
  succeed("render matte -o a.png -o a.jpg -o a.jpeg --size 96x64");
  EXPECT_TRUE(bytesOf("a.jpeg") == bytesOf("a.jpg"));
  const RawImage png = storedIn("a.png"), jpeg = storedIn("a.jpg");
  ASSERT_EQ(jpeg.channels, 3);
  ASSERT_EQ(jpeg.codes.size(), png.codes.size());

  double sum = 0;
  for (std::size_t i = 0; i < png.codes.size(); ++i) sum += std::abs(png.codes[i] - jpeg.codes[i]);
  EXPECT_LT(sum / static_cast<double>(png.codes.size()), 8);
  EXPECT_GT(sum, 0);
}

TEST_F(Images, AnInterruptionLeavesOnlyWholeFiles) {
  const TemporaryFolder results, logs;
  // The film has many more frames than are written before the interruption.
  const pid_t child =
      startWhit({"render", tiny_, "-o", results / "f-#.exr", "--frames", "0..9999"}, logs);
  ASSERT_TRUE(waitUntil(child, [&] { return fs::exists(results / "f-3.exr"); }))
      << readFile(logs / "stderr");

  kill(child, SIGINT);
  EXPECT_EQ(waitFor(child), 130);
  for (const auto& entry : fs::directory_iterator(results.path())) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name.starts_with("f-")) << name;
    EXPECT_EQ(readImage(entry.path().string(), ImageLimits()).width, 48) << name;
  }
}

TEST_F(Images, AnInterruptionDoesNotWaitForTheImage) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TemporaryFolder results, logs;
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
