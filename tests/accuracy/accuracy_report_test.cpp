// The report and the chart: well-formed, self-contained, and true to the numbers.
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>

#include "accuracy/cause_chart.h"
#include "accuracy/front_chart.h"
#include "accuracy/label_layout.h"
#include "accuracy/pareto.h"
#include "accuracy/report.h"
#include "accuracy/text_width.h"

namespace whit::accuracy {
namespace {

Point pointOf(PointKind kind, const std::string& knob, const std::string& value, double ms,
              double flip) {
  Point point;
  point.kind = kind;
  point.knob = knob;
  point.value = value;
  point.timing.settledMs = ms;
  point.timing.frames = point.timing.rounds = 9;
  point.timing.ratio = point.timing.ratioLow = point.timing.ratioHigh = ms / 10;
  point.total.flipMean = flip;
  point.imagePng = point.totalMapPng = "png";
  return point;
}

SceneSweep sweepOfThree() {
  SceneSweep sweep;
  sweep.scene = "a<b & \"c\"";
  sweep.width = 32, sweep.height = 20;
  sweep.referenceSamples = 64;
  sweep.truthPng = "png";
  sweep.points = {pointOf(PointKind::baseline, "", "standard", 10, 0.02),
                  pointOf(PointKind::knob, "depth", "2", 8, 0.03),
                  pointOf(PointKind::knob, "depth", "16", 12, 0.025)};
  sweep.points[0].onFront = sweep.points[1].onFront = true;
  sweep.points[0].sameSamples = ImageDifference();
  sweep.points[0].sameSamplesMapPng = "png";
  sweep.points[0].arithmetic = ArithmeticError();
  sweep.points[1].sameSamples = ImageDifference();
  sweep.points[1].sameSamples->flipMean = 0.001;
  sweep.idle = {{"fresnel", "nothing in the scene is transparent"}};
  sweep.stages.push_back({Stage::findIntersections, "position", 640, 1.5, 4, 3, 2, 1});
  return sweep;
}

std::string page() {
  RunFacts facts;
  facts.cpu = "A <fast> processor";
  return reportHtml({sweepOfThree()}, facts);
}

// Every element that is not void is closed, in order; attributes hold no bare '<'.
void expectBalanced(std::string text) {
  for (const char* raw : {"<style>[^]*?</style>", "<script>[^]*?</script>"})
    text = std::regex_replace(text, std::regex(raw), "");
  static const std::set<std::string> empty{"meta", "img", "input", "br"};
  std::vector<std::string> open;
  const std::regex tag("<(/?)([a-zA-Z][a-zA-Z0-9]*)([^<>]*?)(/?)>");
  for (std::sregex_iterator it(text.begin(), text.end(), tag), end; it != end; ++it) {
    const std::string name = (*it)[2];
    if (empty.contains(name) || (*it)[4] == "/") continue;
    if ((*it)[1] != "/") {
      open.push_back(name);
      continue;
    }
    ASSERT_FALSE(open.empty()) << name;
    ASSERT_EQ(open.back(), name) << "at " << it->position();
    open.pop_back();
  }
  EXPECT_TRUE(open.empty());
  const auto opened = std::count(text.begin(), text.end(), '<');
  const auto closed = std::count(text.begin(), text.end(), '>');
  EXPECT_EQ(opened, closed);
}

TEST(AccuracyReport, IsWellFormed) { expectBalanced(page()); }

TEST(AccuracyReport, LoadsNothingFromAnywhere) {
  const std::string html = page();
  const std::regex link("(src|href|action|data)=\"([^\"]*)\"");
  int links = 0;
  for (std::sregex_iterator it(html.begin(), html.end(), link), end; it != end; ++it, ++links) {
    const std::string target = (*it)[2];
    EXPECT_TRUE(target.rfind("data:image/png;base64,", 0) == 0 || target[0] == '#') << target;
  }
  EXPECT_GT(links, 5);
  EXPECT_EQ(html.find("@import"), std::string::npos);
  EXPECT_EQ(html.find("url("), std::string::npos);
  EXPECT_EQ(html.find("fetch("), std::string::npos);
  // The name space of SVG is a name, not a place.
  const std::string rest =
      std::regex_replace(html, std::regex("xmlns=\"http://www.w3.org/2000/svg\""), "");
  EXPECT_EQ(rest.find("http"), std::string::npos);
}

TEST(AccuracyReport, SaysWhatWasMeasured) {
  const std::string html = page();
  for (const char* said :
       {"a&lt;b &amp; &quot;c&quot;", "depth=2", "8.00 ms", "nothing in the scene is transparent",
        "findIntersections", "A &lt;fast&gt; processor", "prefers-color-scheme:dark",
        "@media print", "64 samples a pixel"}) {
    EXPECT_NE(html.find(said), std::string::npos) << said;
  }
}

// Bounds that are broken are told as such.
TEST(AccuracyReport, VerdictsFollowTheNumbers) {
  SceneSweep sweep = sweepOfThree();
  EXPECT_EQ(verdictList(sweep).find("class=\"fails\"><b>&#10007;</b> <i>"), std::string::npos);
  sweep.points[0].sameSamples->pixelsGe2CodesPct = 0.2;
  EXPECT_NE(verdictList(sweep).find("class=\"fails\"><b>&#10007;</b> <i>"), std::string::npos);
  sweep = sweepOfThree();
  sweep.points[0].arithmetic->samePath.maxCode = 2;
  EXPECT_NE(verdictList(sweep).find("&#10007;</b> arithmetic alone"), std::string::npos);
  // 8 of 10 ms is not half.
  EXPECT_NE(verdictList(sweep).find("&#10007;</b> half the time"), std::string::npos);
  sweep.points[1].timing.ratio = 0.5;
  EXPECT_NE(verdictList(sweep).find("&#10003;</b> half the time"), std::string::npos);
}

// RFC 4648, section 10.
TEST(AccuracyReport, Base64) {
  const std::string head = "data:image/png;base64,";
  EXPECT_EQ(dataUri(""), head);
  EXPECT_EQ(dataUri("f"), head + "Zg==");
  EXPECT_EQ(dataUri("fo"), head + "Zm8=");
  EXPECT_EQ(dataUri("foo"), head + "Zm9v");
  EXPECT_EQ(dataUri("foob"), head + "Zm9vYg==");
  EXPECT_EQ(dataUri(std::string("\xff\x00\xfe", 3)), head + "/wD+");
}

TEST(FrontChart, IsWellFormedAndShowsEveryPoint) {
  const std::string svg = frontSvg(sweepOfThree(), Against::reference, {});
  expectBalanced(svg);
  const std::regex circle("<circle class=\"(p|q)\"");
  int front = 0, gray = 0;
  for (std::sregex_iterator it(svg.begin(), svg.end(), circle), end; it != end; ++it)
    ++((*it)[1] == "p" ? front : gray);
  EXPECT_EQ(front, 2);
  EXPECT_EQ(gray, 1);
  EXPECT_NE(svg.find("<title>depth=16: 12.00 ms"), std::string::npos);
}

// A preset, what is on the front, and nothing else; the rest tells its name as a tooltip.
TEST(FrontChart, LabelsPresetsAndItsOwnPointsOnly) {
  SceneSweep sweep = sweepOfThree();
  sweep.points.push_back(pointOf(PointKind::preset, "quality", "fine", 30, 0.025));
  const std::string svg = frontSvg(sweep, Against::reference, {});
  for (const char* label : {">standard</text>", ">depth=2</text>", ">fine</text>"})
    EXPECT_NE(svg.find(label), std::string::npos) << label;
  EXPECT_EQ(svg.find(">depth=16</text>"), std::string::npos);
  EXPECT_NE(svg.find("<title>depth=16:"), std::string::npos);
}

struct Text {
  std::string words;
  Box box;
};

// Where a chart's letters of 14 pixels are.
std::vector<Text> textsOf(const std::string& svg) {
  const std::regex text(
      "<text class=\"([sfd])\" x=\"([0-9.]+)\" y=\"([0-9.]+)\"( text-anchor=\"([a-z]+)\")?>"
      "([^<]*)</text>");
  std::vector<Text> texts;
  for (std::sregex_iterator it(svg.begin(), svg.end(), text), end; it != end; ++it) {
    const std::string words = (*it)[6], anchor = (*it)[5];
    const double width = widthOf(words, 14, (*it)[1] == "f" ? Weight::bold : Weight::regular);
    const double before = anchor == "end" ? width : anchor == "middle" ? width / 2 : 0;
    const double left = std::stod((*it)[2]) - before, baseline = std::stod((*it)[3]);
    texts.push_back({words, {left, baseline - 10.5, left + width, baseline + 3.5}});
  }
  return texts;
}

// Many choices of about the same time and error, a wide scale of each, and the truth's noise amid.
TEST(FrontChart, LettersStandOnNoOthersAndWithinTheChart) {
  SceneSweep sweep = sweepOfThree();
  sweep.points[1].total.flipMean = 0.00021, sweep.points[2].timing.settledMs = 9000;
  for (int i = 0; i < 12; ++i) {
    Point point = pointOf(PointKind::knob, "indirect", std::to_string(1 << i), 10 + i * 0.3,
                          0.02 - i * 0.0004);
    point.onFront = true;
    sweep.points.push_back(point);
  }
  sweep.points.push_back(pointOf(PointKind::preset, "quality", "reference", 9, 0.012));
  sweep.transport.emplace().noiseFlip = 0.011;
  const std::vector<Text> texts = textsOf(frontSvg(sweep, Against::reference, {}));
  std::set<std::string> words;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    words.insert(texts[i].words);
    EXPECT_GE(texts[i].box.left, 0) << texts[i].words;
    EXPECT_LE(texts[i].box.right, kChartWidth) << texts[i].words;
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(texts[i].box.overlaps(texts[k].box)) << texts[i].words << ", " << texts[k].words;
    }
  }
  for (const char* said : {"0.0002", "10000", "noise of the truth", "standard", "indirect=1"})
    EXPECT_TRUE(words.contains(said)) << said;
}

// Advances of the font itself, 0.636 of its size for a digit, 0.318 for a point.
TEST(TextWidth, IsThatOfDejaVuSans) {
  EXPECT_NEAR(widthOf("0.0002", 100, Weight::regular), 5 * 63.6 + 31.8, 0.6);
  EXPECT_NEAR(widthOf("=m", 100, Weight::bold), 83.8 + 104.2, 0.2);
  EXPECT_EQ(widthOf("", 14, Weight::bold), 0);
  EXPECT_GT(widthOf("\u2026", 14, Weight::bold), 14);
}

TEST(FrontChart, APointWithoutASpreadIsARing) {
  SceneSweep sweep = sweepOfThree();
  sweep.points[2].timing.rounds = 0;
  sweep.points[2].timing.frames = 1;
  const std::string svg = frontSvg(sweep, Against::reference, {});
  EXPECT_NE(svg.find("class=\"one\""), std::string::npos);
  EXPECT_NE(svg.find("(one frame)"), std::string::npos);
  EXPECT_EQ(frontSvg(sweepOfThree(), Against::reference, {}).find("class=\"one\""),
            std::string::npos);
}

// Of how many frames times are is in the chart itself.
TEST(FrontChart, SaysHowManyTimesHaveNoSpread) {
  SceneSweep sweep = sweepOfThree();
  EXPECT_EQ(frontSvg(sweep, Against::reference, {}).find("without a spread"), std::string::npos);
  sweep.points[2].timing.rounds = 0, sweep.points[2].timing.frames = 1;
  EXPECT_NE(frontSvg(sweep, Against::reference, {})
                .find("1 of 3 times, of one frame, are without a spread"),
            std::string::npos);
  sweep.points[1].timing.rounds = 2, sweep.points[1].timing.frames = 2;
  EXPECT_NE(frontSvg(sweep, Against::reference, {})
                .find("2 of 3 times, of few frames, are without a spread"),
            std::string::npos);
}

// Of 8 and 10 ms, the first known within 7.5 to 10.5: it may be the slower of the two.
TEST(FrontChart, APointWhoseSpreadReachesItsNeighborIsARing) {
  SceneSweep sweep = sweepOfThree();
  sweep.points[0].total.flipMean = 0.02, sweep.points[1].total.flipMean = 0.03;
  sweep.points[1].timing.ratioLow = 0.75, sweep.points[1].timing.ratioHigh = 1.05;
  markFronts(sweep.points);
  EXPECT_TRUE(sweep.points[1].coversNeighbor);
  EXPECT_FALSE(sweep.points[0].coversNeighbor);
  const std::string svg = frontSvg(sweep, Against::reference, {});
  expectBalanced(svg);
  EXPECT_NE(svg.find("<circle class=\"tie\""), std::string::npos);
  EXPECT_NE(svg.find("<path class=\"front tied\""), std::string::npos);
  EXPECT_NE(svg.find("reaches a neighbor's"), std::string::npos);
  sweep.points[1].timing.ratioHigh = 0.99;
  markFronts(sweep.points);
  const std::string apart = frontSvg(sweep, Against::reference, {});
  EXPECT_EQ(apart.find("\"tie\""), std::string::npos);
  EXPECT_EQ(apart.find("front tied"), std::string::npos);
}

// With all transport as the truth: what it is off by itself, and what to choose.
TEST(AccuracyReport, SaysHowFarOffTheTruthIs) {
  SceneSweep sweep = sweepOfThree();
  EXPECT_EQ(transportText(sweep), "");
  EXPECT_EQ(reportHtml({sweep}, RunFacts()).find("all transport"), std::string::npos);
  sweep.transport = {8, 512, 0.002, 0.5, 0.0123, 4000, false, "0123456789"};
  for (Point& point : sweep.points) point.transport.emplace().flipMean = 0.0777;
  sweep.points[0].arithmetic->samePath.rmse = 1e-7;
  const std::string text = transportText(sweep);
  for (const char* said :
       {"512 samples a pixel in 8 independent passes, 4.0 s, 01234567;",
        "2.00e-03, 0.4 % of the mean", "a FLIP of 0.0123", "single precision is off by 1.0e-07"}) {
    EXPECT_NE(text.find(said), std::string::npos) << said << " in " << text;
  }
  const std::string html = reportHtml({sweep}, RunFacts());
  expectBalanced(html);
  for (const char* said : {"noise of the truth", "in 16 ms choose", "0.07770"})
    EXPECT_NE(html.find(said), std::string::npos) << said;
}

// A bar a cause that was measured, as long as its error; all on one scale.
TEST(CauseChart, HasABarACauseInItsColor) {
  SceneSweep sweep = sweepOfThree();
  sweep.points[0].sampling.flipMean = 0.04, sweep.points[0].algorithm.flipMean = 0.02;
  sweep.points[0].arithmetic->samePath.flipMean = 0.01;
  const std::regex bar("<rect class=\"([a-z]+)\" x=\"12\" y=\"[0-9.]+\" width=\"([0-9.]+)\"");
  const auto bars = [&] {
    const std::string svg = causeSvg(sweep, {});
    expectBalanced(svg);
    std::map<std::string, double> longest;
    for (std::sregex_iterator it(svg.begin(), svg.end(), bar), end; it != end; ++it) {
      double& length = longest[(*it)[1]];
      length = std::max(length, std::stod((*it)[2]));
    }
    return longest;
  };
  std::map<std::string, double> longest = bars();
  EXPECT_FALSE(longest.contains("transport"));
  EXPECT_NEAR(longest["sampling"], 456, 0.01);
  EXPECT_NEAR(longest["algorithm"], 228, 0.01);
  EXPECT_NEAR(longest["arithmetic"], 114, 0.01);
  for (Point& point : sweep.points) point.transport.emplace().flipMean = 0.08;
  sweep.transport.emplace();
  longest = bars();
  EXPECT_NEAR(longest["transport"], 456, 0.01);
  EXPECT_NEAR(longest["sampling"], 228, 0.01);
}

TEST(CauseChart, ShowsPresetsAndTheFrontFastestFirst) {
  SceneSweep sweep = sweepOfThree();
  sweep.points[0].onFront = false;
  const std::vector<const Point*> points = pointsByCause(sweep);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0]->label(), "depth=2");
  EXPECT_EQ(points[1]->label(), "standard");
}

// The scale is logarithmic: equal ratios are equal distances; what is better is lower, what is
// dearer further right.
TEST(FrontChart, PlacesPointsOnLogarithmicScales) {
  SceneSweep sweep = sweepOfThree();
  sweep.points[0].timing.settledMs = 10, sweep.points[0].total.flipMean = 0.01;
  sweep.points[1].timing.settledMs = 20, sweep.points[1].total.flipMean = 0.02;
  sweep.points[2].timing.settledMs = 40, sweep.points[2].total.flipMean = 0.04;
  const std::string svg = frontSvg(sweep, Against::reference, {});
  std::map<std::string, std::pair<double, double>> at;
  const std::regex circle(
      "<title>([a-z0-9=]+):[^<]*</title><circle class=\"area\" cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  for (std::sregex_iterator it(svg.begin(), svg.end(), circle), end; it != end; ++it)
    at[(*it)[1]] = {std::stod((*it)[2]), std::stod((*it)[3])};
  ASSERT_EQ(at.size(), 3u);
  const auto [x0, y0] = at["standard"];
  const auto [x1, y1] = at["depth=2"];
  const auto [x2, y2] = at["depth=16"];
  EXPECT_NEAR(x2 - x1, x1 - x0, 0.2);  // printed to 0.1
  EXPECT_NEAR(y2 - y1, y1 - y0, 0.2);
  EXPECT_LT(x0, x1);
  EXPECT_GT(y0, y1);
}

// A tick at the very end of the scale, with a long number.
TEST(FrontChart, NumbersBelowTheScaleStayInTheChart) {
  SceneSweep sweep = sweepOfThree();
  sweep.points[2] = pointOf(PointKind::knob, "depth", "16", 100000 / 1.5, 0.025);
  const std::string svg = frontSvg(sweep, Against::reference, ChartLinks());
  const std::regex number("x=\"([0-9.]+)\" y=\"390\" text-anchor=\"middle\">([0-9.e+]+)<");
  double last = 0;
  for (std::sregex_iterator it(svg.begin(), svg.end(), number), end; it != end; ++it) {
    const double halfWidth = widthOf((*it)[2].str(), 14, Weight::regular) / 2;
    last = std::stod((*it)[1]) + halfWidth;
    EXPECT_LE(last, kChartWidth) << (*it)[2];
  }
  EXPECT_GT(last, kChartWidth - 1) << "one lies at the end";
}

// Without an error at all, a point stands below the scale, not at minus infinity.
TEST(FrontChart, NoErrorHasALineOfItsOwn) {
  const std::string svg = frontSvg(sweepOfThree(), Against::sameSamples, {});
  expectBalanced(svg);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_NE(svg.find(">0</text>"), std::string::npos);
}

}  // namespace
}  // namespace whit::accuracy
