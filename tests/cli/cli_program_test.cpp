// The program's words and exit statuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "command_json.h"
#include "command_line/program.h"
#include "has_text.h"
#include "io/image/image_file.h"
#include "run_command.h"

namespace whit::cli {
namespace {

class Program : public TinySceneTest {};

TEST_F(Program, TellsItsVersion) {
  const Outcome outcome = succeed({"--version"});
  EXPECT_EQ(outcome.out.rfind("whit ", 0), 0u) << outcome.out;
  for (const std::string word : {"version", "-V"}) EXPECT_EQ(succeed({word}).out, outcome.out);
}

TEST_F(Program, HelpTellsWhatModelsGet) {
  const std::string help = runWhit({"render", "--help"}, [] { setenv("COLUMNS", "120", 1); }).out;
  EXPECT_TRUE(hasText(help, "(default: none); of models without a scene file filmic"));
  EXPECT_TRUE(hasText(help, "c8c8c8"));
  EXPECT_TRUE(hasText(help, "SCENE.png)"));
  EXPECT_FALSE(hasText(runWhit({"turntable", "--help"}).out, "SCENE.png"));
}

TEST_F(Program, SaysWhichOutputCannotBeWritten) {
  const Outcome full =
      runWhit({"--version"}, [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); });
  expectFailed(full, 4, "cannot write the result to standard output");
}

// A roboticist has a matrix and a pose.
TEST_F(Program, ACameraWithAPoseLeadsToPython) {
  for (const std::string member : {R"("pose": [])", R"("K": [])"}) {
    std::ofstream(folder_ / "c.json") << "{" << member << "}";
    expectFailure({"render", tiny_, "--camera", folder_ / "c.json"}, 3,
                  "whit.Camera.from_k(K, pose");
  }
}

TEST_F(Program, WarningsCountInEnglish) {
  std::ofstream(folder_ / "a.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n";
  const Outcome outcome =
      succeed({"render", folder_ / "a.obj", "-o", folder_ / "a.png", "--size", "16x10"});
  EXPECT_TRUE(hasText(outcome.err, "(1 time, first: "));
}

// Its text reader would find nothing to draw in another format.
TEST_F(Program, AnObjThatIsNoneIsRefused) {
  for (const auto& [content, seems] : std::vector<std::pair<std::string, std::string>>{
           {"glTF\2", ".glb"}, {"PK\3\4", ".zip"}, {"ply\n", ".ply"}, {"solid a\n", ".stl"}}) {
    std::ofstream(folder_ / "wrong.obj") << content;
    expectFailure({"render", folder_ / "wrong.obj", "-o", folder_ / "a.png", "--size", "16x10"}, 3,
                  "wrong.obj: expected the content of a .obj file, found that of a " + seems);
  }
}

TEST_F(Program, EveryCommandHasHelp) {
  const Outcome all = succeed({"--help"});
  for (const std::string command : {"render", "bench", "compare", "info", "merge", "effects"}) {
    EXPECT_TRUE(hasText(all.out, "  " + command));
    const Outcome help = succeed({command, "--help"});
    EXPECT_TRUE(hasText(help.out, "Usage: whit " + command));
    EXPECT_TRUE(hasText(help.out, "--quiet"));
    const bool hasSize = help.out.find("--size WxH") != std::string::npos;
    EXPECT_EQ(hasSize, command != "merge") << help.out;
    EXPECT_EQ(runWhit({"help", command}).out, help.out);
  }
}

// --help is for every day, --help-all has the rest.
TEST_F(Program, HelpOfRenderFitsOnTwoScreens) {
  const std::string help = runWhit({"render", "--help"}).out;
  const std::string all = runWhit({"render", "--help-all"}).out;
  constexpr int kTwoScreens = 2 * 55;
  EXPECT_LE(std::ranges::count(help, '\n'), kTwoScreens) << help;
  for (const std::string option : {"--azimuth", "--zoom", "--ground", "--size", "--channels"}) {
    EXPECT_TRUE(hasText(help, "  " + option)) << option;
  }
  for (const std::string option : {"--viewpoint", "--exr", "--mode", "--texture-filter"}) {
    EXPECT_FALSE(hasText(help, "  " + option)) << option;
    EXPECT_TRUE(hasText(all, "  " + option)) << option;
  }
}

TEST_F(Program, SaysThatASceneIsDark) {
  std::string text = readFile(tiny_);
  const std::string black = folder_ / "black.json";
  text.replace(text.find("[60, 60, 60]"), 12, "[0, 0, 0]");
  std::ofstream(black) << text;

  const auto errorsOf = [&](const std::string& scene) {
    return runWhit({"render", scene, "-o", folder_ / "out.png"}).err;
  };
  EXPECT_TRUE(hasText(errorsOf(black), "black is black: it has no lights"));
  EXPECT_FALSE(hasText(errorsOf(folder_ / "tiny.json"), "is black"));

  // Fog with a color is light, too.
  const std::string foggy = folder_ / "foggy.json";
  std::ofstream(foggy) << text.insert(text.find('{') + 1,
                                      R"("fog": {"density": 0.1, "color": [0.2, 0.4, 0.6]},)");
  const std::string said = errorsOf(foggy);
  EXPECT_TRUE(hasText(said, "wrote ")) << said;
  EXPECT_FALSE(hasText(said, "is black")) << said;
}

TEST_F(Program, SaysThatFrostedGlassIsShownClear) {
  std::string text = readFile(tiny_);
  const std::string mirror = "\"mirror\": 0.8", file = folder_ / "frosted.json";
  text.replace(text.find(mirror), mirror.size(), "\"transmission\": 0.8, \"frosted\": true");
  std::ofstream(file) << text;

  const auto errorsOf = [&](const std::string& glossy, const std::string& set) {
    return runWhit({"render", file, "-o", folder_ / "out.png", "--glossy", glossy, "--set", set})
        .err;
  };
  const std::string roughness = "/materials/mirror/roughness=", told = "frosted glass shown clear";
  EXPECT_TRUE(hasText(errorsOf("0", roughness + "0.5"), told));
  EXPECT_FALSE(hasText(errorsOf("2", roughness + "0.5"), told));
  EXPECT_FALSE(hasText(errorsOf("0", roughness + "0.03"), told));
}

TEST_F(Program, SaysThatAFileIsNoGlb) {
  for (const char* text : {"", "garbage", "\x89PNG", "  [1]"}) {
    std::ofstream(folder_ / "bad.glb") << text;
    expectFailure({"render", folder_ / "bad.glb", "-o", folder_ / "out.png"}, 3,
                  "expected a GLB, which begins with \"glTF\"");
  }
}

TEST_F(Program, ListsTheShippedScenes) {
  const Outcome outcome = succeed({"scenes"});
  EXPECT_TRUE(hasText(outcome.out, "atrium          A two-storeyed court with colonnades"));
  EXPECT_TRUE(hasText(outcome.out, "\nwhitted         A glass sphere in front of a mirror sphere"));
}

TEST_F(Program, SaysWhatItWrote) {
  const std::string one = folder_ / "a.png", frames = folder_ / "f##.png";
  const auto expectLine = [&](Words words, const std::string& start) {
    const std::string err = runWhit(std::move(words)).err;
    EXPECT_TRUE(err.starts_with(start)) << err;
    EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
  };
  expectLine({"render", tiny_, "-o", one}, "wrote " + one + ", 48x32, ");
  expectLine({"render", tiny_, "-o", one, "--exposure", "auto"}, "wrote " + one + ", 48x32, expos");
  expectLine({"render", tiny_, "-o", one, "--crop", "8,4,40,21"}, "wrote " + one + ", 32x17, ");
  expectLine({"render", tiny_, "-o", frames, "--frames", "0..2"}, "wrote 3 images, 48x32, ");
}

TEST_F(Program, WithoutWordsShowsHelpAndFails) {
  const Outcome outcome = runWhit({});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(hasText(outcome.out, "Usage: whit"));
}

TEST_F(Program, RefusesBadScenes) {
  std::ofstream(folder_ / "broken.json") << "{\n  \"whit\": 1,\n  \"size\": [48,\n}\n";
  expectFailure({"info", folder_ / "broken.json"}, 3, "broken.json:4");
  std::ofstream(folder_ / "wrong.json") << R"({"whit": 1, "size": ["wide", 3]})";
  expectFailure({"info", folder_ / "wrong.json"}, 3, "wrong.json#/size");
  std::ofstream(folder_ / "no.png") << "this is no image";
  expectFailure({"compare", folder_ / "no.png", folder_ / "no.png"}, 3, "no.png");
}

// A file must not be able to clear the screen, or to write lines of its own.
TEST_F(Program, ControlCharactersOfFilesAreSpelled) {
  const std::string scene = folder_ / "a.json", model = folder_ / "a.gltf";
  std::ofstream(scene) << "{\"whit\": 1, \"a\\u001b[2Jb\\nwhit: done\": 1}";
  expectFailure({"info", scene}, 3, "#/a\\x1b[2Jb\\x0awhit: done: unknown key");
  std::ofstream(model) << R"({"asset": {"version": "2.0"}, "extensionsUsed": ["A\u001bB"],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
    "nodes": [{"camera": 0, "name": "C\u0007D"}]})";

  const Outcome told = succeed({"info", model});
  EXPECT_TRUE(hasText(told.out, "extension ignored: A\\x1bB"));
  EXPECT_TRUE(hasText(told.out, "C\\x07D"));

  const Outcome warned = runWhit({"render", model, "-o", folder_ / "a.png", "--size", "1x1"});
  EXPECT_TRUE(hasText(warned.err, "warning: extension ignored: A\\x1bB"));
}

TEST_F(Program, DoesNotWriteOverAFolder) {
  std::filesystem::create_directory(folder_ / "a.exr");
  expectFailure({"render", tiny_, "-o", folder_ / "a.exr"}, 4, "folder");
}

TEST_F(Program, QuietSaysNothing) {
  const Outcome quiet = succeed({"render", tiny_, "-o", folder_ / "a.exr", "--quiet"});
  EXPECT_EQ(quiet.out + quiet.err, "");

  // Warnings are no chatter.
  const Outcome black =
      runWhit({"render", tiny_, "-o", folder_ / "a.exr", "--quiet", "--set", "/lights=[]"});
  EXPECT_TRUE(hasText(black.err, "whit: warning: "));

  const Outcome loud = runWhit({"render", tiny_, "-o", folder_ / "a.exr", "--stats"});
  EXPECT_EQ(loud.out, "");
  EXPECT_TRUE(hasText(loud.err, "addImpulses"));
  EXPECT_FALSE(hasText(loud.err, "\r")) << "a progress bar, but no terminal";
}

// One command for each status that help and the manual page list.
TEST_F(Program, EveryExitStatusHasACause) {
  const std::string picture = folder_ / "a.exr";
  std::ofstream(folder_ / "bad.json") << "{";

  const std::map<int, Words> causes{
      {0, {"render", tiny_, "-o", picture, "--quiet"}},
      {1, {"compare", picture, folder_ / "b.exr", "--tolerance", "0"}},
      {2, {"render", tiny_, "--spp", "0"}},
      {3, {"render", folder_ / "bad.json", "-o", picture}},
      {4, {"render", tiny_, "-o", folder_ / "none/a.exr"}},
      {5, {"render", tiny_, "-o", picture, "--size", "65536x65536"}},
      {130, {"render", tiny_, "-o", picture, "--spp", "4096", "--size", "2000x2000"}}};

  succeed({"render", tiny_, "-o", folder_ / "b.exr", "--depth", "0"});
  std::set<int> met;
  for (const auto& [status, words] : causes) {
    const TemporaryFolder said;
    // The program inherits that interruptions pass, until it handles them.
    const auto handler = signal(SIGINT, SIG_IGN);
    const pid_t child = startWhit(words, said);
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
    EXPECT_EQ(found, status) << testing::PrintToString(words) << readFile(said / "stderr");
    met.insert(found);
  }

  std::set<int> known;
  for (const ExitMeaning& row : kExitMeanings) known.insert(row.status);
  EXPECT_EQ(known, met);
}

// Without light all colors are black, but from another place the depths are others.
TEST_F(Program, CompareSaysThatOnlyChannelsDiffer) {
  const std::string a = folder_ / "a.exr", b = folder_ / "b.exr";
  const Words black{"render",     tiny_,  "--set", "/lights/0/intensity=[0, 0, 0]",
                    "--channels", "depth"};
  succeed(joined(black, {"--eye", "0,0,5", "-o", a}));
  succeed(joined(black, {"--eye", "0,0,6", "-o", b}));

  const Outcome compared = runWhit({"compare", a, b, "--tolerance", "0"});
  EXPECT_EQ(compared.status, 1);
  EXPECT_TRUE(compared.out.ends_with(
      "verdict: the colors are the same, bit for bit, but channels differ; FAILED\n"))
      << compared.out;
  EXPECT_TRUE(hasText(compared.err, "the RMSE of the channel depth.Z is ")) << compared.err;
  succeed({"compare", a, b});  // measured, not judged
  succeed({"compare", a, b, "--tolerance", "0", "--colors"});
}

// A scene without light is black wherever nothing is hit, so only alpha tells two backgrounds
// apart.
TEST_F(Program, CompareCountsAlphaAndChannels) {
  const std::string a = folder_ / "a.png", b = folder_ / "b.png", c = folder_ / "c.exr";
  const Words black{"render", tiny_, "--set", "/lights/0/intensity=[0, 0, 0]", "--eye", "0,9,20"};
  succeed(joined(black, {"--background", "transparent", "-o", a}));
  succeed(joined(black, {"-o", b}));
  succeed(joined(black, {"--channels", "depth,object", "-o", c}));

  // A picture without alpha is opaque.
  for (const Words& files : {Words{a, b}, Words{b, a}}) {
    const Outcome compared = runWhit(joined({"compare"}, joined(files, {"--tolerance", "0"})));
    EXPECT_EQ(compared.status, 1);
    EXPECT_TRUE(hasText(compared.err, "the RMSE of the channel A is ")) << compared.err;
  }
  const Json alpha = Json::parse(succeed({"compare", a, b, "--json", "-"}).out)["channels"];
  ASSERT_EQ(alpha.size(), 1u);
  EXPECT_EQ(alpha[0]["channel"], "A");
  EXPECT_GT(alpha[0]["pixels_differing"], 0);
  EXPECT_EQ(alpha[0]["max"], 1);

  // What only one file has fails at any tolerance.
  const Outcome lacking = runWhit({"compare", b, c, "--tolerance", "9", "--json", "-"});
  EXPECT_EQ(lacking.status, 1);
  EXPECT_TRUE(hasText(
      lacking.err, "the RMSE of the channel depth.Z is inf, which --tolerance 9 does not allow"));
  EXPECT_TRUE(hasText(lacking.err, "object.id, only in B")) << lacking.err;
  const Json channels = Json::parse(lacking.out)["channels"];
  ASSERT_EQ(channels.size(), 3u);
  for (const Json& channel : channels) {
    EXPECT_EQ(channel["only_in"], "B");
    EXPECT_EQ(channel["pixels_differing"], 48 * 32);
  }
  succeed({"compare", b, c, "--tolerance", "9", "--colors"});

  // A background of one color is opaque in a PNG.
  succeed(joined(black, {"--background", "black", "-o", a}));
  succeed({"compare", a, b, "--tolerance", "0"});
}

// Packets flush numbers below the least normal one to zero, and the reference keeps them: a scene
// this dark loses all of its light, and no 8-bit code shows it.
TEST_F(Program, CompareFailsIfLightIsMissing) {
  const Words dark{"compare", tiny_, "--set", "/lights/0/intensity=[1e-38, 1e-38, 1e-38]"};
  expectFailed(runWhit(dark), 1, "the energy of A over B is 0.000000");
}

TEST_F(Program, CompareFailsAboveTheTolerance) {
  succeed({"render", tiny_, "-o", folder_ / "a.exr", "-o", folder_ / "a.png"});
  succeed({"render", tiny_, "-o", folder_ / "b.exr", "--disable", "shadows"});

  const std::string a = folder_ / "a.exr", b = folder_ / "b.exr";
  succeed({"compare", a, a, "--tolerance", "0"});
  const Outcome same = runWhit({"compare", a, a, "--tolerance", "0"});
  EXPECT_TRUE(same.out.ends_with("verdict: the pictures are the same, bit for bit; passed\n"))
      << same.out;

  // Without a tolerance the pictures are measured, and the last line says that nothing was judged.
  const Outcome unjudged = succeed({"compare", a, b});
  EXPECT_TRUE(
      unjudged.out.ends_with("% of the pixels differ by two 8-bit codes or more; measured, "
                             "not judged: --tolerance X sets what passes\n"))
      << unjudged.out;

  const Outcome apart =
      runWhit({"compare", a, b, "--tolerance", "1e-6", "--heatmap", folder_ / "heat.png"});
  EXPECT_EQ(apart.status, 1) << apart.err;
  EXPECT_TRUE(hasText(apart.out, "RMSE"));
  EXPECT_TRUE(apart.out.ends_with("8-bit codes or more; FAILED\n")) << apart.out;
  EXPECT_GT(std::filesystem::file_size(folder_ / "heat.png"), 100u);
}

// Means leave such pixels out.
TEST_F(Program, CompareFailsByPixelsThatAreNotFinite) {
  const std::string a = folder_ / "a.exr", b = folder_ / "b.exr";
  Image image(2, 2);
  writeExr(b, image, {});
  image.at(1, 0).y = std::numeric_limits<float>::quiet_NaN();
  writeExr(a, image, {});

  succeed({"compare", a, a, "--tolerance", "0"});
  for (const Words& files : {Words{a, b}, Words{b, a}}) {
    expectFailed(runWhit(joined({"compare"}, joined(files, {"--tolerance", "9"}))), 1,
                 "1 pixels are not finite in one picture");
  }
}

}  // namespace
}  // namespace whit::cli
