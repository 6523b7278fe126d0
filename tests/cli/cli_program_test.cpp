// The program's words and exit statuses.
#include <algorithm>
#include <limits>
#include <set>

#include "command_line/program.h"
#include "run_command.h"

namespace whit::cli {
namespace {

class Program : public TinySceneTest {
 protected:
  // Compares pictures that are beyond their tolerance.
  Outcome comparedAsOthers(const std::string& words) const {
    const Outcome outcome = run("compare " + words);
    EXPECT_EQ(outcome.status, 1) << words << outcome.err;
    return outcome;
  }
};

TEST_F(Program, TellsItsVersion) {
  const std::string version = succeed("--version").out;
  EXPECT_TRUE(version.starts_with("whit ")) << version;
  for (const char* word : {"version", "-V"}) EXPECT_EQ(succeed(word).out, version);
}

TEST_F(Program, HelpTellsWhatModelsGet) {
  const std::string help = run("render --help", [] { setenv("COLUMNS", "120", 1); }).out;
  for (const char* said :
       {"(default: none); of models without a scene file filmic", "c8c8c8", "SCENE.png)"}) {
    EXPECT_TRUE(hasText(help, said));
  }
  EXPECT_FALSE(hasText(succeed("turntable --help").out, "SCENE.png"));
}

TEST_F(Program, WarningsCountInEnglish) {
  save("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n");
  EXPECT_TRUE(hasText(succeed("render a.obj -o a.png --size 16x10").err, "(1 time, first: "));
}

TEST_F(Program, EveryCommandHasHelp) {
  const std::string all = succeed("--help").out;
  for (const std::string command : {"render", "bench", "compare", "info", "merge", "effects"}) {
    EXPECT_TRUE(hasText(all, "  " + command));
    const std::string help = succeed(command + " --help").out;
    EXPECT_TRUE(hasText(help, "Usage: whit " + command));
    EXPECT_TRUE(hasText(help, "--quiet"));
    EXPECT_EQ(hasText(help, "--size WxH"), command != "merge") << help;
    EXPECT_EQ(succeed("help " + command).out, help);
  }
}

// --help is for every day, --help-all has the rest.
TEST_F(Program, HelpOfRenderFitsOnTwoScreens) {
  const std::string help = succeed("render --help").out, all = succeed("render --help-all").out;
  constexpr int kTwoScreens = 2 * 55;
  EXPECT_LE(std::ranges::count(help, '\n'), kTwoScreens) << help;
  for (const std::string option : {"--azimuth", "--zoom", "--ground", "--size", "--channels"}) {
    EXPECT_TRUE(hasText(help, "  " + option));
  }
  for (const std::string option : {"--viewpoint", "--exr", "--mode", "--texture-filter"}) {
    EXPECT_FALSE(hasText(help, "  " + option));
    EXPECT_TRUE(hasText(all, "  " + option));
  }
}

TEST_F(Program, SaysThatASceneIsDark) {
  const auto isCalledBlack = [&](const std::string& set) {
    const std::string said = succeed("render tiny.json -o out.png " + set).err;
    EXPECT_TRUE(hasText(said, "wrote "));
    return hasText(said, "tiny is black: it has no lights");
  };
  const std::string dark = "--set /lights/0/intensity=[0,0,0]";
  EXPECT_TRUE(isCalledBlack(dark));
  EXPECT_FALSE(isCalledBlack(""));
  // Fog with a color is light, too.
  EXPECT_FALSE(isCalledBlack(dark + R"( --set /fog={"density":0.1,"color":[0.2,0.4,0.6]})"));
}

TEST_F(Program, SaysThatFrostedGlassIsShownClear) {
  const auto isShownClear = [&](const std::string& roughness, const std::string& glossy) {
    return hasText(succeed(R"(render tiny.json -o out.png --set /materials/mirror={"diffuse":0.1,)"
                           R"("transmission":0.8,"frosted":true,"roughness":)" +
                           roughness + "} --glossy " + glossy)
                       .err,
                   "frosted glass shown clear");
  };
  EXPECT_TRUE(isShownClear("0.5", "0"));
  EXPECT_FALSE(isShownClear("0.5", "2"));
  EXPECT_FALSE(isShownClear("0.03", "0"));
}

TEST_F(Program, ListsTheShippedScenes) {
  const std::string out = succeed("scenes").out;
  EXPECT_TRUE(hasText(out, "atrium          A two-storeyed court with colonnades"));
  EXPECT_TRUE(hasText(out, "\nwhitted         A glass sphere in front of a mirror sphere"));
}

TEST_F(Program, SaysWhatItWrote) {
  for (const auto& [words, start] : {std::pair{"-o a.png", "wrote a.png, 48x32, "},
                                     {"-o a.png --exposure auto", "wrote a.png, 48x32, expos"},
                                     {"-o a.png --crop 8,4,40,21", "wrote a.png, 32x17, "},
                                     {"-o f##.png --frames 0..2", "wrote 3 images, 48x32, "}}) {
    const std::string err = succeed(std::string("render tiny.json ") + words).err;
    EXPECT_TRUE(err.starts_with(start)) << err;
    EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
  }
}

TEST_F(Program, WithoutWordsShowsHelpAndFails) {
  const Outcome outcome = run("");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(hasText(outcome.out, "Usage: whit"));
}

// The last word of a line is the name of the file with this content.
struct BadFile {
  std::string line, content, said;
};

TEST_F(Program, RefusesBadFiles) {
  const std::string notGlb = "expected a GLB, which begins with \"glTF\"";
  const std::string notObj = "wrong.obj: expected the content of a .obj file, found that of a ";
  const std::string wantsPose = "whit.Camera.from_k(K, pose";
  const BadFile files[] = {
      {"info broken.json", "{\n  \"whit\": 1,\n  \"size\": [48,\n}\n", "broken.json:4"},
      {"info wrong.json", "{'whit': 1, 'size': ['wide', 3]}", "wrong.json#/size"},
      {"info view.json", "{'whit': 1, 'view': 'round', 'scene': []}", "view.json#/view: expected"},
      {"compare no.png no.png", "this is no image", "no.png"},
      {"render bad.glb", "", notGlb},
      {"render bad.glb", "garbage", notGlb},
      {"render bad.glb", "\x89PNG", notGlb},
      {"render bad.glb", "  [1]", notGlb},

      // The text reader would find nothing to draw in another format.
      {"render wrong.obj", "glTF\2", notObj + ".glb"},
      {"render wrong.obj", "PK\3\4", notObj + ".zip"},
      {"render wrong.obj", "ply\n", notObj + ".ply"},
      {"render wrong.obj", "solid a\n", notObj + ".stl"},

      // A roboticist has a matrix and a pose.
      {"render tiny.json --camera c.json", "{'pose': []}", wantsPose},
      {"render tiny.json --camera c.json", "{'K': []}", wantsPose},
      {"info tiny.json --camera c.json", "{'eye': [0, 0, 1], 'at': [0, 0, 0], 'lens': 3}",
       "c.json#/lens: "},
      {"info tiny.json --camera c.json",
       "{'eye': [0, 0, 1], 'at': [0, 0, 0], 'motion': {'keys': [{'time': 'soon'}]}}",
       "c.json#/motion/keys/0/time: "},
      {"info tiny.json --camera c.json",
       "{'eye': [0, 0, 1], 'at': [0, 0, 0], 'lens': 3, 'motion': {'keys': [{'time': 0}]}}",
       "c.json#/lens: "},
      {"info tiny.json --camera c.json", "{\n\"eye\" [", "c.json:2"},

      // A file must not be able to clear the screen, or to write lines of its own.
      {"info escape.json", "{'whit': 1, 'a\\u001b[2Jb\\nwhit: done': 1}",
       "#/a\\x1b[2Jb\\x0awhit: done: unknown key"},
  };
  for (const BadFile& file : files) {
    save(split(file.line).back(), file.content);
    expectFailure(file.line, 3, file.said);
  }
}

TEST_F(Program, ControlCharactersOfFilesAreSpelled) {
  save("a.gltf",
       "{'asset': {'version': '2.0'}, 'extensionsUsed': ['A\\u001bB'],"
       "'cameras': [{'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 1}}],"
       "'nodes': [{'camera': 0, 'name': 'C\\u0007D'}]}");

  const std::string told = succeed("info a.gltf").out, ignored = "extension ignored: A\\x1bB";
  EXPECT_TRUE(hasText(told, ignored));
  EXPECT_TRUE(hasText(told, "C\\x07D"));
  EXPECT_TRUE(hasText(run("render a.gltf -o a.png --size 1x1").err, "warning: " + ignored));
}

TEST_F(Program, DoesNotWriteOverAFolder) {
  std::filesystem::create_directory(folder_ / "a.exr");
  expectFailure("render tiny.json -o a.exr", 4, "folder");
}

TEST_F(Program, QuietSaysNothing) {
  const std::string line = "render tiny.json -o a.exr ";
  const Outcome quiet = succeed(line + "--quiet");
  EXPECT_EQ(quiet.out + quiet.err, "");

  // Warnings are no chatter.
  EXPECT_TRUE(hasText(run(line + "--quiet --set /lights=[]").err, "whit: warning: "));

  const Outcome loud = run(line + "--stats");
  EXPECT_EQ(loud.out, "");
  EXPECT_TRUE(hasText(loud.err, "addImpulses"));
  EXPECT_FALSE(hasText(loud.err, "\r")) << "a progress bar, but no terminal";
}

// One command for each status that help and the manual page list.
TEST_F(Program, EveryExitStatusHasACause) {
  save("bad.json", "{");
  succeed("render tiny.json -o b.exr --depth 0");

  const std::map<int, std::string> causes{
      {0, "render tiny.json -o a.exr"},
      {1, "compare a.exr b.exr --tolerance 0"},
      {2, "render tiny.json --spp 0"},
      {3, "render bad.json -o a.exr"},
      {4, "render tiny.json -o none/a.exr"},
      {5, "render tiny.json -o a.exr --size 65536x65536"},
      {130, "render tiny.json -o a.exr --spp 4096 --size 2000x2000"}};

  std::set<int> met;
  for (const auto& [status, line] : causes) {
    const TemporaryFolder said;
    // The program inherits that interruptions pass, until it handles them.
    const auto handler = signal(SIGINT, SIG_IGN);
    const pid_t child = startWhit(split(line), said, [&] { (void)chdir(folder_.path().c_str()); });
    signal(SIGINT, handler);

    int found = 0;
    if (status == kInterruptedStatus) {
      while (waitpid(child, &found, WNOHANG) == 0) {
        kill(child, SIGINT);
        usleep(10'000);
      }
      found = WIFEXITED(found) ? WEXITSTATUS(found) : -1;
    } else {
      found = waitFor(child);
    }
    EXPECT_EQ(found, status) << line << readFile(said / "stderr");
    met.insert(found);
  }

  std::set<int> known;
  for (const ExitMeaning& row : kExitMeanings) known.insert(row.status);
  EXPECT_EQ(known, met);
}

// Without light all colors are black, but from another place the depths are others.
TEST_F(Program, CompareSaysThatOnlyChannelsDiffer) {
  const std::string black =
      "render tiny.json --set /lights/0/intensity=[0,0,0] --channels depth --eye ";
  succeed(black + "0,0,5 -o a.exr");
  succeed(black + "0,0,6 -o b.exr");

  const Outcome compared = comparedAsOthers("a.exr b.exr --tolerance 0");
  EXPECT_TRUE(compared.out.ends_with(
      "verdict: the colors are the same, bit for bit, but channels differ; FAILED\n"))
      << compared.out;
  EXPECT_TRUE(hasText(compared.err, "the RMSE of the channel depth.Z is "));
  succeed("compare a.exr b.exr");  // measured, not judged
  succeed("compare a.exr b.exr --tolerance 0 --colors");
}

// A scene without light is black wherever nothing is hit, so only alpha tells two backgrounds
// apart.
TEST_F(Program, CompareCountsAlphaAndChannels) {
  const std::string black = "render tiny.json --set /lights/0/intensity=[0,0,0] --eye 0,9,20 -o ";
  succeed(black + "a.png --background transparent");
  succeed(black + "b.png");
  succeed(black + "c.exr --channels depth,object");

  // A picture without alpha is opaque.
  for (const std::string files : {"a.png b.png", "b.png a.png"}) {
    const Outcome compared = comparedAsOthers(files + " --tolerance 0");
    EXPECT_TRUE(hasText(compared.err, "the RMSE of the channel A is "));
  }
  const Json alpha = jsonOf("compare a.png b.png")["channels"];
  ASSERT_EQ(alpha.size(), 1u);
  EXPECT_EQ(alpha[0]["channel"], "A");
  EXPECT_GT(alpha[0]["pixels_differing"], 0);
  EXPECT_EQ(alpha[0]["max"], 1);

  // What only one file has fails at any tolerance.
  const Outcome lacking = comparedAsOthers("b.png c.exr --tolerance 9 --json -");
  EXPECT_TRUE(hasText(
      lacking.err, "the RMSE of the channel depth.Z is inf, which --tolerance 9 does not allow"));
  EXPECT_TRUE(hasText(lacking.err, "object.id, only in B"));
  const Json channels = Json::parse(lacking.out)["channels"];
  ASSERT_EQ(channels.size(), 3u);
  for (const Json& channel : channels) {
    EXPECT_EQ(channel["only_in"], "B");
    EXPECT_EQ(channel["pixels_differing"], 48 * 32);
  }
  succeed("compare b.png c.exr --tolerance 9 --colors");

  // A background of one color is opaque in a PNG.
  succeed(black + "a.png --background black");
  succeed("compare a.png b.png --tolerance 0");
}

// Packets flush numbers below the least normal one to zero, and the reference keeps them: a scene
// this dark loses all of its light, and no 8-bit code shows it.
TEST_F(Program, CompareFailsIfLightIsMissing) {
  expectFailed(run("compare tiny.json --set /lights/0/intensity=[1e-38,1e-38,1e-38]"), 1,
               "the energy of A over B is 0.000000");
}

TEST_F(Program, CompareFailsAboveTheTolerance) {
  succeed("render tiny.json -o a.exr");
  succeed("render tiny.json -o b.exr --disable shadows");

  const std::string same = succeed("compare a.exr a.exr --tolerance 0").out;
  EXPECT_TRUE(same.ends_with("verdict: the pictures are the same, bit for bit; passed\n")) << same;

  // Without a tolerance the pictures are measured, and the last line says that nothing was judged.
  const std::string unjudged = succeed("compare a.exr b.exr").out;
  EXPECT_TRUE(
      unjudged.ends_with("% of the pixels differ by two 8-bit codes or more; measured, "
                         "not judged: --tolerance X sets what passes\n"))
      << unjudged;

  const std::string apart = comparedAsOthers("a.exr b.exr --tolerance 1e-6 --heatmap heat.png").out;
  EXPECT_TRUE(hasText(apart, "RMSE"));
  EXPECT_TRUE(apart.ends_with("8-bit codes or more; FAILED\n")) << apart;
  EXPECT_GT(bytesOf("heat.png").size(), 100u);
}

// Radiances of 2 and 3 are both white, and with 2 EV less they are 0.5 and 0.75; tone curves tell
// them apart as well.
TEST_F(Program, CompareMapsTheCodesThatItCounts) {
  for (const float radiance : {2.0f, 3.0f}) {
    Image image(1, 1);
    image.at(0, 0) = Rgb(radiance);
    writeExr(folder_ / (radiance == 2 ? "a.exr" : "b.exr"), image, {});
  }

  for (const std::string options : {"", "--exposure -2", "--tonemap reinhard"}) {
    const Json json = jsonOf("compare a.exr b.exr --heatmap heat.png " + options);
    EXPECT_EQ(json["max_code"] == 0, options.empty());
    EXPECT_EQ(imageIn("heat.png").at(0, 0) == Rgb(), options.empty()) << options;
  }
}

// Means leave such pixels out.
TEST_F(Program, CompareFailsByPixelsThatAreNotFinite) {
  Image image(2, 2);
  writeExr(folder_ / "b.exr", image, {});
  image.at(1, 0).y = std::numeric_limits<float>::quiet_NaN();
  writeExr(folder_ / "a.exr", image, {});

  succeed("compare a.exr a.exr --tolerance 0");
  for (const char* files : {"compare a.exr b.exr", "compare b.exr a.exr"}) {
    expectFailed(run(files + std::string(" --tolerance 9")), 1,
                 "1 pixels are not finite in one picture");
  }
}

}  // namespace
}  // namespace whit::cli
