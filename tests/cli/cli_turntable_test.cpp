// Turntables and films as users make them.
#include <gtest/gtest.h>

#include <algorithm>

#include "command_json.h"
#include "core/option_table.h"
#include "has_text.h"
#include "io/files.h"
#include "output/film_pipe.h"
#include "picture_file.h"
#include "run_command.h"

namespace whit::cli {
namespace {

namespace fs = std::filesystem;

// Writes a program named ffmpeg, which is found before all others.
void writeProgram(const TemporaryFolder& folder, const std::string& text) {
  std::ofstream(folder / "ffmpeg") << "#!/bin/sh\n" << text << "\n";
  fs::permissions(folder / "ffmpeg", fs::perms::owner_all);
}

Outcome turn(const std::string& scene, const Words& more, const std::string& path = "",
             int status = 0) {
  const Outcome outcome = runWhit(joined({"turntable", scene, "--quiet"}, more), [&] {
    if (!path.empty()) setenv("PATH", path.c_str(), 1);
  });
  EXPECT_EQ(outcome.status, status) << outcome.err;
  return outcome;
}

std::string cubeObj(const TemporaryFolder& folder) {
  std::ofstream(folder / "cube.obj")
      << "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
         "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
  return folder / "cube.obj";
}

Vec3f eyeOf(const std::string& file) {
  Vec3f eye;
  parseValue(OptionSpec{}, metadataOf(file).at("eye"), eye);
  return eye;
}

Words namesIn(const TemporaryFolder& folder) {
  Words names;
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

TEST(TurntableCommand, AFrameIsTheSameAloneAndInARun) {
  const TemporaryFolder folder;
  const std::string cube = cubeObj(folder);
  turn(cube, {"-o", folder / "all-##.exr", "--count", "5", "--size", "48x32"});
  turn(cube, {"-o", folder / "one-##.exr", "--count", "5", "--size", "48x32", "--frames", "3",
              "--threads", "1"});

  EXPECT_EQ(readFile(folder / "all-03.exr"), readFile(folder / "one-03.exr"));
  EXPECT_NE(readFile(folder / "all-03.exr"), readFile(folder / "all-02.exr"));
  EXPECT_FALSE(fs::exists(folder / "one-02.exr"));
}

// The share of a turn that a frame shows is turns * frame / count.
TEST(TurntableCommand, TurnsAndCountMakeTheAngle) {
  const TemporaryFolder folder;
  const std::string cube = cubeObj(folder);
  const auto hashOf = [&](const std::string& turns, const std::string& count,
                          const std::string& frame) {
    const Outcome outcome =
        turn(cube, {"-o", folder / "f#.exr", "--size", "24x16", "--quality", "standard", "--turns",
                    turns, "--count", count, "--frames", frame, "--json", "-"});
    return Json::parse(outcome.out).at("image_hash").get<std::string>();
  };

  const std::string half = hashOf("1", "4", "2");
  EXPECT_EQ(hashOf("2", "4", "1"), half);
  EXPECT_EQ(hashOf("1", "2", "1"), half);

  const std::string quarter = hashOf("1", "4", "1");
  EXPECT_NE(quarter, half);
  EXPECT_EQ(hashOf("0.5", "2", "1"), quarter);
  EXPECT_NE(hashOf("-1", "4", "1"), quarter) << "the other way around";
}

// The four eyes are a quarter of a turn apart, on a circle around the axis through the cube's
// middle.
TEST(TurntableCommand, TheCameraGoesAroundOnACircle) {
  const TemporaryFolder folder;
  turn(cubeObj(folder), {"-o", folder / "f#.exr", "--count", "4", "--size", "48x48"});
  const auto eye = [&](int k) { return eyeOf(folder / ("f" + std::to_string(k) + ".exr")); };

  const Vec3f first = eye(0);
  EXPECT_GT(length(Vec3d(first)), 2);
  EXPECT_NEAR(eye(1).x, first.z, 1e-5);
  EXPECT_NEAR(eye(1).z, -first.x, 1e-5);
  EXPECT_NEAR(eye(2).x, -first.x, 1e-5);
  EXPECT_NEAR(eye(3).x, -first.z, 1e-5);
  EXPECT_EQ(eye(2).y, first.y);
}

TEST(TurntableCommand, WithoutFfmpegThereIsNoFilm) {
  const TemporaryFolder folder;
  const Outcome outcome =
      turn(cubeObj(folder), {"-o", folder / "film.mp4", "--count", "3"}, "/nonexistent", 4);
  EXPECT_TRUE(hasText(outcome.err, "ffmpeg"));
  EXPECT_EQ(namesIn(folder), (Words{"cube.obj"}));
}

TEST(TurntableCommand, AProgramThatFailsIsAnErrorWithItsMessage) {
  const TemporaryFolder folder, programs;
  const std::string cube = cubeObj(folder);
  const auto expectFailure = [&](const std::string& program, const std::string& said) {
    writeProgram(programs, program);
    const Outcome outcome =
        turn(cube, {"-o", folder / "film.mp4", "--count", "40", "--size", "320x200"},
             programs.path().string() + ":/usr/bin:/bin", 4);
    EXPECT_TRUE(hasText(outcome.err, said));
    EXPECT_EQ(namesIn(folder), (Words{"cube.obj"}));
  };
  expectFailure("echo no such codec >&2; exit 1", "no such codec");  // ffmpeg ends at once
  expectFailure("cat >/dev/null; echo the disk is full >&2; exit 3", "the disk is full");
  expectFailure("kill -9 $$", "film.mp4': ffmpeg ");
}

TEST(TurntableCommand, AnInterruptionLeavesNothing) {
  const TemporaryFolder folder, programs, output;
  writeProgram(programs, "cat >/dev/null");
  const std::string cube = cubeObj(folder);

  const pid_t child =
      startWhit({"turntable", cube, "-o", folder / "film.mp4", "--count", "100000", "--size",
                 "64x40", "--quiet"},
                output, [&] { setenv("PATH", (programs.path().string() + ":/bin").c_str(), 1); });

  // The second file is the temporary one.
  ASSERT_TRUE(waitUntil(child, [&] { return namesIn(folder).size() == 2; }));
  kill(child, SIGTERM);
  EXPECT_EQ(waitFor(child), 130);
  EXPECT_EQ(namesIn(folder), (Words{"cube.obj"}));
}

TEST(Film, FramesAreThoseOfTheirOwnFiles) {
  const TemporaryFolder folder, programs;
  const std::string tiny = writeTinyScene(folder), film = folder / "film.mp4";
  // Writes the raw frames, and what it was called with.
  const std::string called = programs / "words";
  writeProgram(programs, "for last; do :; done; echo \"$*\" >" + called + "; cat >\"$last\"");
  const auto render = [&](const Words& more) {
    return runWhit(joined({"render", tiny, "--quiet"}, more), [&] {
      setenv("PATH", (programs.path().string() + ":/usr/bin:/bin").c_str(), 1);
    });
  };

  const Outcome outcome =
      render({"--frames", "1..3", "--fps", "4", "-o", film, "-o", folder / "f#.png"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(hasText(readFile(called), "-pix_fmt rgb0 -s 48x32 -r 4 -i -"));

  // ffmpeg gets four bytes a pixel, the last of which is unused.
  std::string frames;
  for (const std::string name : {"f1.png", "f2.png", "f3.png"}) {
    const std::vector<std::uint8_t> codes = storedIn(folder / name).codes;
    for (std::size_t i = 0; i < codes.size(); ++i) {
      frames += static_cast<char>(codes[i]);
      if (i % 3 == 2) frames += '\xff';
    }
  }
  EXPECT_EQ(readFile(film), frames);

  EXPECT_EQ(render({"-o", film}).status, 2);  // a film of one image is refused
}

TEST(TurntableCommand, SceneFilesTurnAboutWhatIsLookedAt) {
  const TemporaryFolder folder;
  const Outcome outcome = turn(writeTinyScene(folder), {"-o", folder / "a#.exr", "--count", "2",
                                                        "--camera", "side", "--json", "-"});

  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["frames"], 2);
  EXPECT_EQ(json["size"], (Json{48, 32}));
  EXPECT_EQ(json["files"].size(), 2u);

  const Vec3f v = eyeOf(folder / "a1.exr");
  EXPECT_NEAR(v.x, -6, 1e-5);
  EXPECT_NEAR(v.y, 2, 1e-6);
}

// Luma and chroma are those of BT.709 by hand, and the file says so.
TEST(Film, ColorsAreThoseOfBt709) {
  if (!hasFfmpeg() || std::system("command -v ffprobe >/dev/null") != 0) {
    GTEST_SKIP() << "ffmpeg is not installed: films are NOT checked";
  }
  constexpr int kSide = 32;
  constexpr double kRed = 231, kGreen = 63, kBlue = 48;
  constexpr double kCodes = 2;  // what compression may change

  const TemporaryFolder folder;
  const std::string film = folder / "film.mp4", said = folder / "said", planes = folder / "planes";
  std::vector<std::uint8_t> picture;
  for (int i = 0; i < kSide * kSide; ++i) {
    for (const double code : {kRed, kGreen, kBlue, 255.0}) {
      picture.push_back(static_cast<std::uint8_t>(code));
    }
  }
  FilmPipe pipe(film, kSide, kSide, 10);
  pipe.add(picture);
  pipe.finish();

  const std::string probe =
      "ffprobe -v error -show_entries stream=color_range,color_space,color_transfer,"
      "color_primaries -of json " +
      film + " > " + said;
  ASSERT_EQ(std::system(probe.c_str()), 0);
  const Json stream = Json::parse(readFile(said))["streams"][0];
  EXPECT_EQ(stream["color_range"], "tv");
  EXPECT_EQ(stream["color_space"], "bt709");
  EXPECT_EQ(stream["color_primaries"], "bt709");
  EXPECT_EQ(stream["color_transfer"], "iec61966-2-1");

  const std::string decode = "ffmpeg -v error -i " + film + " -f rawvideo " + planes;
  ASSERT_EQ(std::system(decode.c_str()), 0);
  const std::string codes = readFile(planes);
  ASSERT_EQ(codes.size(), 3u * kSide * kSide / 2);
  const double luma = (0.2126 * kRed + 0.7152 * kGreen + 0.0722 * kBlue) / 255;
  const auto at = [&](std::size_t i) { return static_cast<std::uint8_t>(codes[i]); };
  EXPECT_NEAR(at(0), 16 + 219 * luma, kCodes);
  EXPECT_NEAR(at(kSide * kSide), 128 + 224 * (kBlue / 255 - luma) / 1.8556, kCodes);
  EXPECT_NEAR(at(kSide * kSide * 5 / 4), 128 + 224 * (kRed / 255 - luma) / 1.5748, kCodes);
}

// The model is one of the real world, and the real ffmpeg makes the film.
TEST(TurntableCommand, TheHelmetIsAFilm) {
  const std::string helmet = (dataFolder() / "gltf/FlightHelmet/FlightHelmet.gltf").string();
  if (!fs::exists(helmet)) GTEST_SKIP() << "no FlightHelmet in $WHIT_DATA: NOT checked";
  if (!hasFfmpeg() || std::system("command -v ffprobe >/dev/null") != 0) {
    GTEST_SKIP() << "ffmpeg is not installed: films are NOT checked";
  }

  const TemporaryFolder folder;
  const std::string film = folder / "helmet.mp4";
  turn(helmet, {"-o", film, "--size", "80x60"});

  const std::string said = folder / "said";
  const std::string probe =
      "ffprobe -v error -show_entries stream=width,height,nb_frames,duration "
      "-of json '" +
      film + "' > '" + said + "'";
  ASSERT_EQ(std::system(probe.c_str()), 0);

  const Json stream = Json::parse(readFile(said))["streams"][0];
  EXPECT_EQ(stream["width"], 80);
  EXPECT_EQ(stream["height"], 60);
  EXPECT_EQ(stream["nb_frames"], "96");
  EXPECT_EQ(std::stod(stream["duration"].get<std::string>()), 4.0);
}

}  // namespace
}  // namespace whit::cli
