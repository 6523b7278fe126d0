// Turntables and films as users make them.
#include <cmath>

#include "core/option_table.h"
#include "io/files.h"
#include "output/film_pipe.h"
#include "pi.h"
#include "run_command.h"

namespace whit::cli {
namespace {

namespace fs = std::filesystem;

class TurntableCommand : public TinySceneTest {
 protected:
  TurntableCommand() {
    save("cube.obj",
         "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\n"
         "v -1 1 1\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n");
  }

  // Saves a program named ffmpeg, which withPrograms() lets be found before all others.
  void saveProgram(const std::string& text) const {
    std::ofstream(programs_ / "ffmpeg") << "#!/bin/sh\n" << text << "\n";
    fs::permissions(programs_ / "ffmpeg", fs::perms::owner_all);
  }
  std::function<void()> withPrograms() const {
    return
        [path = programs_.path().string() + ":/usr/bin:/bin"] { setenv("PATH", path.c_str(), 1); };
  }

  Vec3f eyeOf(const std::string& file) const {
    Vec3f eye;
    parseValue(OptionSpec{}, metadataOf(file)["eye"], eye);
    return eye;
  }
  std::ptrdiff_t files() const { return std::distance(fs::directory_iterator(folder_.path()), {}); }

  const TemporaryFolder programs_;
};

// The share of a turn that a frame shows is turns * frame / count. The axis goes through the middle
// of a model, and through what the camera of a scene looks at.
TEST_F(TurntableCommand, TurnsAndCountMakeTheAngle) {
  struct Turned {
    std::string words;
    int frame;
    double share;
  };
  const Turned all[] = {{"--count 4", 1, 0.25},
                        {"--count 4", 2, 0.5},
                        {"--count 2", 1, 0.5},
                        {"--count 4 --turns 2", 1, 0.5},
                        {"--count 2 --turns 0.5", 1, 0.25},
                        {"--count 4 --turns -1", 1, -0.25}};

  for (const std::string scene : {"cube.obj --size 8x8 ", "tiny.json --camera side "}) {
    const auto eyeIn = [&](int frame, const std::string& words) {
      const std::string number = std::to_string(frame);
      succeed("turntable " + scene + words + " -o f#.exr --frames " + number);
      return eyeOf("f" + number + ".exr");
    };

    const Vec3f first = eyeIn(0, "");
    EXPECT_GT(length(Vec3d(first)), 2);
    for (const auto& [words, frame, share] : all) {
      SCOPED_TRACE(scene + words);
      const double cosine = std::cos(2 * kPi * share), sine = std::sin(2 * kPi * share);
      const Vec3f eye = eyeIn(frame, words);
      EXPECT_NEAR(eye.x, cosine * first.x + sine * first.z, 1e-5);
      EXPECT_NEAR(eye.z, cosine * first.z - sine * first.x, 1e-5);
      EXPECT_EQ(eye.y, first.y);
    }
  }
}

// A model is given a view, which these options change.
TEST_F(TurntableCommand, OptionsOfTheCameraChangeTheViewOfAModel) {
  for (const auto& [name, value] : {std::pair{"up", "1,1,0"}, {"fov", "30"}, {"ortho", "3"}}) {
    succeed(std::string("turntable cube.obj -o f#.exr --size 8x8 --count 1 --") + name + " " +
            value);
    EXPECT_EQ(metadataOf("f0.exr")[name], value);
  }
}

TEST_F(TurntableCommand, WithoutFfmpegThereIsNoFilm) {
  const auto before = files();
  expectFailed(
      run("turntable cube.obj -o film.mp4 --count 3", [] { setenv("PATH", "/nonexistent", 1); }), 4,
      "ffmpeg");
  EXPECT_EQ(files(), before);
}

TEST_F(TurntableCommand, AProgramThatFailsIsAnErrorWithItsMessage) {
  const auto before = files();
  for (const auto& [program, said] :
       {std::pair{"echo no such codec >&2; exit 1", "no such codec"},  // ffmpeg ends at once
        {"cat >/dev/null; echo the disk is full >&2; exit 3", "the disk is full"},
        {"kill -9 $$", "film.mp4': ffmpeg "},
        // The real program may write 512 bytes, as on a full disk.
        {"trap '' XFSZ; ulimit -f 1; PATH=/usr/bin:/bin exec ffmpeg \"$@\"",
         "film.mp4': ffmpeg "}}) {
    saveProgram(program);
    // The frames are more than the kernel keeps for a program that does not read them.
    const Outcome outcome =
        run("turntable cube.obj -o film.mp4 --count 6 --size 160x100 --quality standard",
            withPrograms());
    EXPECT_EQ(outcome.status, 4) << outcome.err;
    EXPECT_TRUE(hasText(outcome.err, said));
    EXPECT_EQ(files(), before);
  }
}

TEST_F(TurntableCommand, AnInterruptionLeavesNothing) {
  const TemporaryFolder results, said;
  saveProgram("cat >/dev/null");
  const pid_t child = startWhit({"turntable", folder_ / "cube.obj", "-o", results / "film.mp4",
                                 "--count", "100000", "--size", "64x40"},
                                said, withPrograms());

  // There is a temporary file.
  ASSERT_TRUE(waitUntil(child, [&] { return !fs::is_empty(results.path()); }));
  kill(child, SIGTERM);
  EXPECT_EQ(waitFor(child), 130);
  EXPECT_TRUE(fs::is_empty(results.path()));
}

TEST_F(TurntableCommand, SceneFilesKeepTheirCameraAndSize) {
  const Json json = jsonOf("turntable tiny.json -o a#.exr --count 2 --camera side");
  EXPECT_EQ(json["frames"], 2);
  EXPECT_EQ(json["size"], (Json{48, 32}));
  EXPECT_EQ(json["files"].size(), 2u);

  EXPECT_EQ(eyeOf("a0.exr"), (Vec3f{6, 2, 0}));
}

class Film : public TurntableCommand {
 protected:
  // What ffprobe says about these members of the stream of a film.
  Json probed(const std::string& members) const {
    const std::string probe = "ffprobe -v error -show_entries stream=" + members + " -of json " +
                              folder_ / "film.mp4" + " > " + folder_ / "said";
    EXPECT_EQ(std::system(probe.c_str()), 0);
    return jsonIn("said")["streams"][0];
  }
  static bool hasPrograms() {
    return hasFfmpeg() && std::system("command -v ffprobe >/dev/null") == 0;
  }
};

TEST_F(Film, FramesAreThoseOfTheirOwnFiles) {
  // Writes the raw frames, and what it was called with.
  const std::string called = programs_ / "words";
  saveProgram("for last; do :; done; echo \"$*\" >" + called + "; cat >\"${last#file:}\"");

  const Outcome outcome =
      run("render tiny.json --frames 1..3 --fps 4 -o film.mp4 -o f#.png", withPrograms());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(hasText(readFile(called), "-pix_fmt rgb0 -s 48x32 -r 4 -i -"));

  // ffmpeg gets four bytes a pixel, the last of which is unused.
  std::string frames;
  for (const char* name : {"f1.png", "f2.png", "f3.png"}) {
    const std::vector<std::uint8_t> codes = storedIn(name).codes;
    for (std::size_t i = 0; i < codes.size(); ++i) {
      frames += static_cast<char>(codes[i]);
      if (i % 3 == 2) frames += '\xff';
    }
  }
  EXPECT_EQ(bytesOf("film.mp4"), frames);

  // Where standard streams are closed, ffmpeg must not get the pipe in their place: it would wait
  // for ever for the end of what it holds itself.
  const auto closed = [&] {
    withPrograms()();
    close(STDIN_FILENO);
    close(STDERR_FILENO);
    alarm(60);
  };
  fs::remove(folder_ / "film.mp4");
  EXPECT_EQ(run("render tiny.json --frames 1..3 --fps 4 -o film.mp4", closed).status, 0);
  EXPECT_EQ(bytesOf("film.mp4"), frames);

  // A film of one image is refused.
  EXPECT_EQ(run("render tiny.json -o film.mp4", withPrograms()).status, 2);
}

// Luma and chroma are those of BT.709 by hand, and the file says so.
TEST_F(Film, ColorsAreThoseOfBt709) {
  if (!hasPrograms()) GTEST_SKIP() << "ffmpeg is not installed: films are NOT checked";
  constexpr int kSide = 32;
  constexpr double kRed = 231, kGreen = 63, kBlue = 48;
  constexpr double kCodes = 2;  // what compression may change

  std::vector<std::uint8_t> picture;
  for (int i = 0; i < kSide * kSide; ++i) {
    for (const double code : {kRed, kGreen, kBlue, 255.0}) {
      picture.push_back(static_cast<std::uint8_t>(code));
    }
  }
  // The path is relative, and a part of it looks like a protocol.
  fs::create_directory(folder_ / "10:30");
  const fs::path before = fs::current_path();
  fs::current_path(folder_.path());
  FilmPipe pipe("10:30/film.mp4", kSide, kSide, 10);
  pipe.add(picture);
  pipe.finish();
  fs::current_path(before);
  fs::rename(folder_ / "10:30/film.mp4", folder_ / "film.mp4");

  const Json stream = probed("color_range,color_space,color_transfer,color_primaries");
  expectMembers(stream, {{"color_range", "tv"},
                         {"color_space", "bt709"},
                         {"color_primaries", "bt709"},
                         {"color_transfer", "iec61966-2-1"}});

  const std::string decode =
      "ffmpeg -v error -i " + folder_ / "film.mp4" + " -f rawvideo " + folder_ / "planes";
  ASSERT_EQ(std::system(decode.c_str()), 0);
  const std::string codes = bytesOf("planes");
  ASSERT_EQ(codes.size(), 3u * kSide * kSide / 2);
  const double luma = (0.2126 * kRed + 0.7152 * kGreen + 0.0722 * kBlue) / 255;
  const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(codes[i]); };
  EXPECT_NEAR(at(0), 16 + 219 * luma, kCodes);
  EXPECT_NEAR(at(kSide * kSide), 128 + 224 * (kBlue / 255 - luma) / 1.8556, kCodes);
  EXPECT_NEAR(at(kSide * kSide * 5 / 4), 128 + 224 * (kRed / 255 - luma) / 1.5748, kCodes);
}

// The model is one of the real world, and the real ffmpeg makes the film.
TEST_F(Film, OfTheHelmet) {
  const std::string helmet = (dataFolder() / "gltf/FlightHelmet/FlightHelmet.gltf").string();
  if (!fs::exists(helmet)) GTEST_SKIP() << "no FlightHelmet in $WHIT_DATA: NOT checked";
  if (!hasPrograms()) GTEST_SKIP() << "ffmpeg is not installed: films are NOT checked";

  succeed("turntable " + helmet + " -o film.mp4 --size 40x30");
  const Json stream = probed("width,height,nb_frames,duration");
  expectMembers(stream, {{"width", 40}, {"height", 30}, {"nb_frames", "96"}});
  EXPECT_EQ(std::stod(stream["duration"].get<std::string>()), 4.0);
}

}  // namespace
}  // namespace whit::cli
