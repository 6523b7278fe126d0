// whit-verify: the table, its JSON and page, and the sheet of scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "embedded_data.h"
#include "has_text.h"
#include "run_command.h"

namespace whit::cli {
namespace {

using Json = nlohmann::json;

Outcome runVerify(const std::vector<std::string>& words) {
  const TemporaryFolder folder;
  const int status = waitFor(startWhit(
      words, folder, [] {}, WHIT_VERIFY_PROGRAM));
  return {status, readFile(folder / "stdout"), readFile(folder / "stderr")};
}

TEST(Verify, TellsWorstAndBoundOfEveryRun) {
  const TemporaryFolder folder;
  const std::string page = (folder.path() / "hard.html").string();
  const Outcome outcome =
      runVerify({"--only", "H38,H58", "--only", "H16", "--json", "-", "--html", page});
  ASSERT_EQ(outcome.status, 0) << outcome.err;

  const Json json = Json::parse(outcome.out);
  EXPECT_TRUE(json["machine"].contains("simd"));
  ASSERT_FALSE(json["cases"].empty());
  for (const Json& row : json["cases"]) {
    for (const char* key :
         {"case", "title", "input", "worst", "bound", "margin", "simd", "packet", "holds"}) {
      EXPECT_TRUE(row.contains(key)) << key;
    }
    EXPECT_EQ(row["holds"], true);
    EXPECT_EQ(row["bound"].is_null(), row["case"] == "H16") << "reported only";
  }

  const std::string summary = "3 cases in " + std::to_string(json["cases"].size()) +
                              " runs: 2 hold, 0 broken, 1 reported without a bound";

  // The page has the worst run of each case.
  const Json report = embeddedData(readFile(page));
  EXPECT_EQ(report["machine"], json["machine"]);
  EXPECT_EQ(report["summary"], summary);
  ASSERT_EQ(report["cases"].size(), 3u);
  for (const Json& row : report["cases"])
    EXPECT_EQ(std::count(json["cases"].begin(), json["cases"].end(), row), 1);

  EXPECT_EQ(report["pictures"][0]["name"], "closed-room");
  EXPECT_TRUE(outcome.err.ends_with(summary + "\n")) << outcome.err;
  EXPECT_TRUE(hasText(outcome.err, " holds "));
  EXPECT_TRUE(hasText(outcome.err, " reported  "));
}

// A scene whose files are missing is named, and the other scenes are compared.
TEST(Verify, HashesWithoutRealScenes) {
  const TemporaryFolder folder;
  const int status = waitFor(startWhit(
      {"--hashes", "48x30", "sponza-mirror", "matte"}, folder, [] { unsetenv("WHIT_DATA"); },
      WHIT_VERIFY_PROGRAM));

  const std::string err = readFile(folder / "stderr");
  EXPECT_EQ(status, 0) << err;
  EXPECT_TRUE(hasText(readFile(folder / "stdout"), "as published"));
  EXPECT_TRUE(hasText(err, "left out: sponza-mirror ("));
  EXPECT_TRUE(hasText(err, "WHIT_DATA is not set"));
}

TEST(Verify, UnknownCasesNameTheNearest) {
  const Outcome outcome = runVerify({"--only", "H51x"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(hasText(outcome.err, "'H51'"));
}

TEST(Verify, ASheetOfAllScenes) {
  const TemporaryFolder folder;
  const std::string sheet = (folder.path() / "hard.png").string();
  const Outcome outcome = runVerify({"--sheet", sheet});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(hasText(outcome.out, "closed-room\n"));
  EXPECT_EQ(readFile(sheet).substr(1, 3), "PNG");
}

TEST(Verify, HelpListsTheOptions) {
  const Outcome outcome = runVerify({"--help"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* option : {"--only", "--json", "--html", "--sheet"}) {
    EXPECT_TRUE(hasText(outcome.out, option)) << option;
  }
}

}  // namespace
}  // namespace whit::cli
