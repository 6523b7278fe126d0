// The data and the page of the report. report_in_browser_test.sh looks at what the page draws.
#include "accuracy/report.h"
#include "output/report_page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "accuracy/sweep_rows.h"
#include "embedded_data.h"
#include "has_text.h"

namespace whit::accuracy {
namespace {

Json reportOf(const SceneSweep& sweep) { return reportJson({sweep}, Json::object()); }

TEST(AccuracyReport, EmbedsItsDataUnchanged) {
  const Json data = reportOf(madeUpSweep());
  const std::string page = reportPage(data);
  EXPECT_EQ(embeddedData(page), data);
  EXPECT_FALSE(hasText(page, "{{"));

  const std::regex end("</script>");
  EXPECT_EQ(std::distance(std::sregex_iterator(page.begin(), page.end(), end), {}), 2)
      << "the name of the scene must not end the script";
}

// Returns the field of the CSV file for a value that is no number.
std::string fieldOf(const Json& value) {
  if (value.is_null()) return "";
  if (value.is_boolean()) return value == true ? "yes" : "no";
  return value.get<std::string>();
}

// The points of the report are the rows of the CSV file, with more digits.
TEST(AccuracyReport, HasTheRowsOfTheCsvFile) {
  const Json facts{{"cpu", "A <fast> processor"}, {"seed", 1}};
  SceneSweep sweep = madeUpSweep();
  sweep.points[1].total.rmse = 1.0 / 3;
  sweep.points[2].sameSamples.emplace().flipMean = 0.001;

  const Json points = reportJson({sweep}, facts)["scenes"][0]["points"];
  const std::vector<CsvRow> rows = parseCsv(sweepCsv({sweep}, facts), "sweep.csv");
  ASSERT_EQ(points.size(), rows.size());

  for (const auto i : indices(rows)) {
    EXPECT_GT(rows[i].size(), 65u);
    for (const auto& [name, field] : rows[i]) {
      const Json& value = points[i].at(name);
      if (value.is_number()) {
        EXPECT_NEAR(value.get<double>(), std::stod(field), 1e-6 * std::abs(std::stod(field)));
      } else {
        EXPECT_EQ(fieldOf(value), field) << name;
      }
    }
  }
}

TEST(AccuracyReport, LoadsNothingFromAnywhere) {
  // The name space of SVG is a name, not a place.
  const std::string page = std::regex_replace(reportPage(reportOf(madeUpSweep())),
                                              std::regex("http://www.w3.org/2000/svg"), "");
  for (const char* loads : {"http", "@import", "url(", "fetch(", " src=\"", "<link"})
    EXPECT_FALSE(hasText(page, loads));
}

TEST(AccuracyReport, SaysWhatWasMeasured) {
  const Json scene = reportOf(madeUpSweep())["scenes"][0];
  EXPECT_TRUE(hasText(scene["reference"].get<std::string>(), "64 samples a pixel"));
  EXPECT_EQ(scene["not_swept"][0]["because"], "nothing in the scene is transparent");
  EXPECT_EQ(scene["points"][1]["label"], "depth=2");
  EXPECT_EQ(scene["points"][1]["image_png"], "cG5n");
  EXPECT_FALSE(scene["points"][1].contains("same_samples_map_png"));
}

// RFC 4648, section 10.
TEST(AccuracyReport, Base64) {
  for (const auto& [bytes, text] : {std::pair<std::string, const char*>{"", ""},
                                    {"f", "Zg=="},
                                    {"fo", "Zm8="},
                                    {"foo", "Zm9v"},
                                    {"foob", "Zm9vYg=="},
                                    {std::string("\xff\x00\xfe", 3), "/wD+"}}) {
    EXPECT_EQ(base64(bytes), text);
  }
}

// A report against all transport says how far off that truth is itself.
TEST(AccuracyReport, SaysHowFarOffTheTruthIs) {
  SceneSweep sweep = madeUpSweep();
  EXPECT_EQ(transportText(sweep), "");
  EXPECT_FALSE(reportOf(sweep)["scenes"][0].contains("transport"));

  sweep.transport = kTransport;
  for (Point& point : sweep.points) point.transport.emplace().flipMean = 0.0777;
  sweep.points[0].arithmetic.emplace().samePath.rmse = 1e-7;

  const std::string text = transportText(sweep);
  for (const char* said :
       {"512 samples a pixel in 8 independent passes, 4.0 s;", "2.00e-03, 0.4 % of the mean",
        "a FLIP of 0.0123", "single precision is off by 1.0e-07"}) {
    EXPECT_TRUE(hasText(text, said));
  }

  const Json scene = reportOf(sweep)["scenes"][0];
  EXPECT_EQ(scene["transport"], text);
  EXPECT_EQ(scene["points"][0]["truth_noise_flip"], 0.0123);
  EXPECT_EQ(scene["points"][0]["transport_flip"], 0.0777);
}

}  // namespace
}  // namespace whit::accuracy
