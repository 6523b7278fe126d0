// The program's words and exit statuses.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "command_line/program.h"
#include "run_program.h"

namespace whit::cli {
namespace {

void expectFailure(const std::vector<std::string>& words, int status, const std::string& said) {
  const Outcome outcome = runWhit(words);
  EXPECT_EQ(outcome.status, status) << testing::PrintToString(words) << outcome.err;
  EXPECT_EQ(outcome.out, "") << testing::PrintToString(words);
  EXPECT_EQ(outcome.err.rfind("whit: ", 0), 0u) << outcome.err;
  EXPECT_NE(outcome.err.find(said), std::string::npos)
      << testing::PrintToString(words) << outcome.err;
}

TEST(Program, TellsItsVersion) {
  const Outcome outcome = runWhit({"--version"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out.rfind("whit ", 0), 0u) << outcome.out;
}

TEST(Program, EveryCommandHasHelp) {
  const Outcome all = runWhit({"--help"});
  EXPECT_EQ(all.status, 0);
  for (const std::string command : {"render", "bench", "compare", "info", "merge", "effects"}) {
    EXPECT_NE(all.out.find("  " + command), std::string::npos) << all.out;
    const Outcome help = runWhit({command, "--help"});
    EXPECT_EQ(help.status, 0) << command;
    EXPECT_NE(help.out.find("Usage: whit " + command), std::string::npos) << help.out;
    EXPECT_NE(help.out.find("--quiet"), std::string::npos) << help.out;
    const bool hasSize = help.out.find("--size WxH") != std::string::npos;
    EXPECT_EQ(hasSize, command != "merge") << help.out;
  }
}

// --help is for every day, --help-all has the rest.
TEST(Program, HelpOfRenderFitsOnTwoScreens) {
  const std::string help = runWhit({"render", "--help"}).out;
  const std::string all = runWhit({"render", "--help-all"}).out;
  constexpr int kTwoScreens = 2 * 55;
  EXPECT_LE(std::ranges::count(help, '\n'), kTwoScreens) << help;
  for (const std::string option : {"--azimuth", "--zoom", "--ground", "--size", "--channels"}) {
    EXPECT_NE(help.find("  " + option), std::string::npos) << option;
  }
  for (const std::string option : {"--viewpoint", "--exr", "--mode", "--texture-filter"}) {
    EXPECT_EQ(help.find("  " + option), std::string::npos) << option;
    EXPECT_NE(all.find("  " + option), std::string::npos) << option;
  }
}

TEST(Program, NamesTheNearestCommandAndOption) {
  expectFailure({"rendre"}, 2, "'render'");
  expectFailure({"--versoin"}, 2, "'--version'");
  expectFailure({"render", "--sise", "10x10", "tiny"}, 2, "'--size'");
  expectFailure({"bench", "--flor", "tiny"}, 2, "'--floor'");
  expectFailure({"merge", "--stric", "a.exr", "b.exr"}, 2, "'--strict'");
}

TEST(Program, WordsOfOtherProgramsLeadToOurs) {
  for (const auto& [words, meant] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"render", "whitted", "--samples", "4"}, "did you mean '--spp'?"},
           {{"render", "whitted", "--width=100"}, "did you mean '--size'?"},
           {{"render", "whitted", "--ao", "4"}, "did you mean '--ambient-samples'?"},
           {{"render", "whitted", "--gi", "4"}, "did you mean '--indirect'?"},
           {{"render", "whitted", "-j", "4"}, "did you mean '--threads'?"},
           {{"helmet.glb"}, "did you mean 'whit render helmet.glb'?"},
           {{"view", "helmet.glb"}, "whit view is a program of its own: whit-view"}}) {
    const Outcome outcome = runWhit(words);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find(meant), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(runWhit({"help", "render"}).out, runWhit({"render", "--help"}).out);
}

TEST(Program, SaysThatASceneIsDark) {
  const TemporaryFolder folder;
  std::string text = readFile(writeTinyScene(folder));
  const std::string black = folder / "black.json";
  text.replace(text.find("[60, 60, 60]"), 12, "[0, 0, 0]");
  std::ofstream(black) << text;

  const auto errorsOf = [&](const std::string& scene) {
    return runWhit({"render", scene, "-o", folder / "out.png"}).err;
  };
  EXPECT_NE(errorsOf(black).find("black is black: it has no lights"), std::string::npos);
  EXPECT_EQ(errorsOf(folder / "tiny.json").find("is black"), std::string::npos);
}

TEST(Program, SaysThatFrostedGlassIsShownClear) {
  const TemporaryFolder folder;
  std::string text = readFile(writeTinyScene(folder));
  const std::string mirror = "\"mirror\": 0.8", file = folder / "frosted.json";
  text.replace(text.find(mirror), mirror.size(), "\"transmission\": 0.8, \"frosted\": true");
  std::ofstream(file) << text;

  const auto errorsOf = [&](const std::string& glossy, const std::string& set) {
    return runWhit({"render", file, "-o", folder / "out.png", "--glossy", glossy, "--set", set})
        .err;
  };
  const std::string roughness = "/materials/mirror/roughness=", told = "frosted glass shown clear";
  EXPECT_NE(errorsOf("0", roughness + "0.5").find(told), std::string::npos);
  EXPECT_EQ(errorsOf("2", roughness + "0.5").find(told), std::string::npos);
  EXPECT_EQ(errorsOf("0", roughness + "0.03").find(told), std::string::npos);
}

TEST(Program, SaysThatAFileIsNoGlb) {
  const TemporaryFolder folder;
  for (const char* text : {"", "garbage", "\x89PNG", "  [1]"}) {
    std::ofstream(folder / "bad.glb") << text;
    const Outcome outcome = runWhit({"render", folder / "bad.glb", "-o", folder / "out.png"});
    EXPECT_EQ(outcome.status, 3);
    EXPECT_NE(outcome.err.find("expected a GLB, which begins with \"glTF\""), std::string::npos)
        << outcome.err;
  }
}

TEST(Program, ListsTheShippedScenes) {
  const Outcome outcome = runWhit({"scenes"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("atrium          A two-storeyed court with colonnades"),
            std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("\nwhitted         A glass sphere in front of a mirror sphere"),
            std::string::npos)
      << outcome.out;
  expectFailure({"scenes", "--all"}, 2, "--all");
  expectFailure({"scenes", "atrium"}, 2, "atrium");
}

TEST(Program, SaysWhatItWrote) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder), one = folder / "a.png",
                    frames = folder / "f##.png";
  const auto expectLine = [&](std::vector<std::string> words, const std::string& start) {
    const std::string err = runWhit(std::move(words)).err;
    EXPECT_TRUE(err.starts_with(start)) << err;
    EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
  };
  expectLine({"render", tiny, "-o", one}, "wrote " + one + ", 48x32, ");
  expectLine({"render", tiny, "-o", one, "--exposure", "auto"}, "wrote " + one + ", 48x32, expos");
  expectLine({"render", tiny, "-o", frames, "--frames", "0..2"}, "wrote 3 images, 48x32, ");
}

TEST(Program, WithoutWordsShowsHelpAndFails) {
  const Outcome outcome = runWhit({});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.out.find("Usage: whit"), std::string::npos);
}

TEST(Program, RefusesWrongUsage) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  expectFailure({"render", tiny, "--frames", "0..1"}, 2, "-o FILM.mp4");
  expectFailure({"render", tiny, "-o", folder / "a.gif"}, 2, ".exr or .png");
  expectFailure({"render", tiny, "-o", folder / "a.exr", "--frames", "0..1"}, 2, "####");
  expectFailure({"render", tiny, "-o", folder / "a#.exr", "--frames", "2..1"}, 2, "--frames");
  expectFailure({"render", tiny, "-o", folder / "a####.exr"}, 2, "no --frames A..B");
  expectFailure({"render", tiny, "-o", folder / "a#.exr", "--frames", "1", "--camera", "side"}, 2,
                "--camera");
  expectFailure({"render", tiny, "-o", folder / "a.exr", "--camera", "sid"}, 2, "side");
  expectFailure({"render", tiny, "-o", folder / "a.exr", "--crop", "0,0,49,32"}, 2, "");
  expectFailure({"bench", tiny, "--mode", "reference", "--widths"}, 2, "--widths");
  expectFailure({"bench", tiny, "--packet", "8", "--widths"}, 2, "--packet");
  expectFailure({"compare", "a.exr", "b.exr", "--stages"}, 2, "--stages");
  expectFailure({"compare", tiny, "--heatmap", folder / "h.exr"}, 2, ".png");
  expectFailure({"merge", folder / "a.exr"}, 2, "OUT.exr PART.exr");
}

TEST(Program, RefusesBadScenes) {
  const TemporaryFolder folder;
  std::ofstream(folder / "broken.json") << "{\n  \"whit\": 1,\n  \"size\": [48,\n}\n";
  expectFailure({"info", folder / "broken.json"}, 3, "broken.json:4");
  std::ofstream(folder / "wrong.json") << R"({"whit": 1, "size": ["wide", 3]})";
  expectFailure({"info", folder / "wrong.json"}, 3, "wrong.json#/size");
  std::ofstream(folder / "no.png") << "this is no image";
  expectFailure({"compare", folder / "no.png", folder / "no.png"}, 3, "no.png");
}

// A file must not be able to clear the screen, or to write lines of its own.
TEST(Program, ControlCharactersOfFilesAreSpelled) {
  const TemporaryFolder folder;
  const std::string scene = folder / "a.json", model = folder / "a.gltf";
  std::ofstream(scene) << "{\"whit\": 1, \"a\\u001b[2Jb\\nwhit: done\": 1}";
  expectFailure({"info", scene}, 3, "#/a\\x1b[2Jb\\x0awhit: done: unknown key");
  std::ofstream(model) << R"({"asset": {"version": "2.0"}, "extensionsUsed": ["A\u001bB"],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
    "nodes": [{"camera": 0, "name": "C\u0007D"}]})";

  const Outcome told = runWhit({"info", model});
  EXPECT_EQ(told.status, 0);
  EXPECT_NE(told.out.find("extension ignored: A\\x1bB"), std::string::npos) << told.out;
  EXPECT_NE(told.out.find("C\\x07D"), std::string::npos) << told.out;

  const Outcome warned = runWhit({"render", model, "-o", folder / "a.png", "--size", "1x1"});
  EXPECT_NE(warned.err.find("warning: extension ignored: A\\x1bB"), std::string::npos)
      << warned.err;
}

TEST(Program, SaysWhatCannotBeReadOrWritten) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  expectFailure({"info", folder / "none.json"}, 4, "none.json");
  expectFailure({"compare", folder / "none.exr", folder / "none.exr"}, 4, "none.exr");
  expectFailure({"render", tiny, "-o", folder / "none/a.exr"}, 4, "there is no folder");
  expectFailure({"render", tiny, "-o", folder / "a.exr", "--json", folder / "none/a.json"}, 4,
                "there is no folder");

  std::filesystem::create_directory(folder / "a.exr");
  expectFailure({"render", tiny, "-o", folder / "a.exr"}, 4, "folder");
}

TEST(Program, KeepsToItsMemory) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  // 65536 x 65536 pixels would take more than 100 GB.
  expectFailure({"render", tiny, "-o", folder / "a.exr", "--size", "65536x65536"}, 5,
                "--max-memory");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
}

TEST(Program, QuietSaysNothing) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  const Outcome quiet = runWhit({"render", tiny, "-o", folder / "a.exr", "--quiet"});
  EXPECT_EQ(quiet.status, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");

  // Warnings are no chatter.
  const Outcome black =
      runWhit({"render", tiny, "-o", folder / "a.exr", "--quiet", "--set", "/lights=[]"});
  EXPECT_NE(black.err.find("whit: warning: "), std::string::npos) << black.err;

  const Outcome loud = runWhit({"render", tiny, "-o", folder / "a.exr", "--stats"});
  EXPECT_EQ(loud.out, "");
  EXPECT_NE(loud.err.find("addImpulses"), std::string::npos) << loud.err;
  EXPECT_EQ(loud.err.find('\r'), std::string::npos) << "a progress bar, but no terminal";
}

// One command for each status that help and the manual page list.
TEST(Program, EveryExitStatusHasACause) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder), picture = folder / "a.exr";
  std::ofstream(folder / "bad.json") << "{";

  const std::map<int, std::vector<std::string>> causes{
      {0, {"render", tiny, "-o", picture, "--quiet"}},
      {1, {"compare", picture, folder / "b.exr", "--tolerance", "0"}},
      {2, {"render", tiny, "--spp", "0"}},
      {3, {"render", folder / "bad.json", "-o", picture}},
      {4, {"render", tiny, "-o", folder / "none/a.exr"}},
      {5, {"render", tiny, "-o", picture, "--size", "65536x65536"}},
      {130, {"render", tiny, "-o", picture, "--spp", "4096", "--size", "2000x2000"}}};

  ASSERT_EQ(runWhit({"render", tiny, "-o", folder / "b.exr", "--depth", "0"}).status, 0);
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

// Packets flush numbers below the least normal one to zero, and the reference keeps them: a scene
// this dark loses all of its light, and no 8-bit code shows it.
TEST(Program, CompareFailsIfLightIsMissing) {
  const TemporaryFolder folder;
  const Outcome outcome = runWhit(
      {"compare", writeTinyScene(folder), "--set", "/lights/0/intensity=[1e-38, 1e-38, 1e-38]"});
  EXPECT_EQ(outcome.status, 1) << outcome.out;
  EXPECT_NE(outcome.err.find("the energy of A over B is 0.000000"), std::string::npos)
      << outcome.err;
}

TEST(Program, CompareFailsAboveTheTolerance) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  ASSERT_EQ(runWhit({"render", tiny, "-o", folder / "a.exr", "-o", folder / "a.png"}).status, 0);
  ASSERT_EQ(runWhit({"render", tiny, "-o", folder / "b.exr", "--disable", "shadows"}).status, 0);

  const std::string a = folder / "a.exr", b = folder / "b.exr";
  EXPECT_EQ(runWhit({"compare", a, a, "--tolerance", "0"}).status, 0);
  const Outcome same = runWhit({"compare", a, a, "--tolerance", "0"});
  EXPECT_TRUE(same.out.ends_with("verdict: the pictures are the same, bit for bit; passed\n"))
      << same.out;

  // Without a tolerance the pictures are measured, and the last line says that nothing was judged.
  const Outcome unjudged = runWhit({"compare", a, b});
  EXPECT_EQ(unjudged.status, 0);
  EXPECT_TRUE(
      unjudged.out.ends_with("% of the pixels differ by two 8-bit codes or more; measured, "
                             "not judged: --tolerance X sets what passes\n"))
      << unjudged.out;

  const Outcome apart =
      runWhit({"compare", a, b, "--tolerance", "1e-6", "--heatmap", folder / "heat.png"});
  EXPECT_EQ(apart.status, 1) << apart.err;
  EXPECT_NE(apart.out.find("RMSE"), std::string::npos) << apart.out;
  EXPECT_TRUE(apart.out.ends_with("8-bit codes or more; FAILED\n")) << apart.out;
  EXPECT_GT(std::filesystem::file_size(folder / "heat.png"), 100u);
}

}  // namespace
}  // namespace whit::cli
