// whit-verify: the table, its JSON and page, and the sheet of scenes.
#include <algorithm>

#include "embedded_data.h"
#include "run_command.h"

namespace whit::cli {
namespace {

// Scenes of hard cases. They are those beside the shipped scene whose name comes first.
constexpr const char* kHardScenes[] = {"a", "b", "c", "d", "e"};

class Verify : public TinySceneTest {
 protected:
  Verify() {
    save("a.json", bytesOf("tiny.json"));
    std::filesystem::create_directory(folder_ / "hard");
    for (const std::string name : kHardScenes) save("hard/" + name + ".json", bytesOf("tiny.json"));
  }

  // Runs whit-verify in the folder, with scenes of hard cases that take little time, and without
  // real scenes.
  Outcome verify(const std::string& line) const {
    const auto prepare = [&] {
      (void)chdir(folder_.path().c_str());
      setenv("WHIT_SCENES", folder_.path().c_str(), 1);
      unsetenv("WHIT_DATA");
    };
    return runWhit(split(line), prepare, WHIT_VERIFY_PROGRAM);
  }
};

TEST_F(Verify, TellsWorstAndBoundOfEveryRun) {
  const Outcome outcome = verify("--only H38,H58 --only H16 --json - --html hard.html");
  ASSERT_EQ(outcome.status, 0) << outcome.err;

  const Json json = Json::parse(outcome.out);
  EXPECT_TRUE(json["machine"].contains("simd"));
  ASSERT_FALSE(json["cases"].empty());
  for (const Json& row : json["cases"]) {
    for (const std::string& key : split("case title input worst bound margin simd packet holds")) {
      EXPECT_TRUE(row.contains(key)) << key;
    }
    EXPECT_EQ(row["holds"], true);
    EXPECT_EQ(row["bound"].is_null(), row["case"] == "H16") << "reported only";
  }

  const std::string summary = "3 cases in " + std::to_string(json["cases"].size()) +
                              " runs: 2 hold, 0 broken, 1 reported without a bound";

  // The page has the worst run of each case.
  const Json report = embeddedData(bytesOf("hard.html"));
  EXPECT_EQ(report["machine"], json["machine"]);
  EXPECT_EQ(report["summary"], summary);
  ASSERT_EQ(report["cases"].size(), 3u);
  for (const Json& row : report["cases"]) EXPECT_EQ(std::ranges::count(json["cases"], row), 1);

  EXPECT_EQ(report["pictures"].size(), std::size(kHardScenes));
  EXPECT_EQ(report["pictures"][0]["name"], "a");
  EXPECT_TRUE(outcome.err.ends_with(summary + "\n")) << outcome.err;
  EXPECT_TRUE(hasText(outcome.err, " holds "));
  EXPECT_TRUE(hasText(outcome.err, " reported  "));
}

// A scene whose files are missing is named, and the other scenes are compared.
TEST_F(Verify, HashesWithoutRealScenes) {
  const Outcome outcome = verify("--hashes 48x30 sponza-mirror matte");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(hasText(outcome.out, "as published"));
  EXPECT_TRUE(hasText(outcome.err, "left out: sponza-mirror ("));
  EXPECT_TRUE(hasText(outcome.err, "WHIT_DATA is not set"));
}

TEST_F(Verify, UnknownCasesNameTheNearest) {
  const Outcome outcome = verify("--only H51x");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(hasText(outcome.err, "'H51'"));
}

TEST_F(Verify, ASheetOfAllScenes) {
  const Outcome outcome = verify("--sheet hard.png");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "a\nb\nc\nd\ne\n");

  // Four pictures a row.
  const RawImage sheet = storedIn("hard.png");
  EXPECT_GT(sheet.width, 4 * 320);
  EXPECT_LT(sheet.width, 5 * 320);
  EXPECT_GT(sheet.height, 2 * 240);
}

// None of these would have an effect.
TEST_F(Verify, RefusesOptionsOfAnotherRun) {
  for (const char* line : {"--hashes 48x30 --json a.json", "--hashes 48x30 --only H38",
                           "--sheet a.png --html a.html", "--sheet a.png --hashes 48x30",
                           "--only H38 --simd avx2", "--only H38 --json a.html --html a.html"}) {
    EXPECT_EQ(verify(line).status, 2) << line;
  }
}

TEST_F(Verify, HelpListsTheOptions) {
  const Outcome outcome = verify("--help");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* option : {"--only", "--json", "--html", "--sheet"}) {
    EXPECT_TRUE(hasText(outcome.out, option));
  }
}

}  // namespace
}  // namespace whit::cli
