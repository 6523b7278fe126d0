// whit explain from the outside.
#include <gtest/gtest.h>

#include "command_json.h"
#include "has_text.h"
#include "run_command.h"

namespace whit::cli {
namespace {

// Returns what a node and all nodes below it add to the first channel of the pixel.
double addedBelow(const Json& node) {
  double sum = node["adds"][0].get<double>();
  for (const Json& child : node["children"]) sum += addedBelow(child);
  return sum;
}

class Explain : public TinySceneTest {};

TEST_F(Explain, TellsTheTreeOfAPixel) {
  const std::string svg = folder_ / "rays.svg";
  const Outcome outcome = succeed({"explain", "whitted", "--size", "96x60", "--pixel", "30,20",
                                   "--svg", svg, "--json", folder_ / "rays.json"});
  EXPECT_TRUE(hasText(outcome.out, "pixel 30,20: "));
  EXPECT_TRUE(hasText(outcome.out, "\n  packets    "));
  EXPECT_TRUE(hasText(outcome.out, "\n  reference  "));
  EXPECT_TRUE(hasText(outcome.out, "\nprimary, weight 1.00000 1.00000 1.00000, in vacuum: "));
  EXPECT_TRUE(hasText(outcome.out, "\n  refraction, weight "));
  EXPECT_TRUE(hasText(outcome.out, "sky adds "));

  // What all rays add is the radiance of the pixel, and the scalar reference agrees with it.
  const Json json = Json::parse(readFile(folder_ / "rays.json"));
  const Json& packets = json["packets"];
  const double radiance = packets["radiance"][0].get<double>();
  EXPECT_NEAR(addedBelow(packets["samples"][0]), radiance, 1e-6 * radiance);
  EXPECT_NEAR(json["reference"]["radiance"][0].get<double>(), radiance, 1e-3 * radiance);
  EXPECT_EQ(packets["samples"][0]["surface"]["material"], "glass");
  EXPECT_TRUE(packets["samples"][0]["surface"].contains("sphere"));
  EXPECT_FALSE(json["reference"]["samples"][0]["children"].empty());

  // The drawing holds the picture and the rays as lines.
  const std::string drawing = readFile(svg);
  EXPECT_EQ(drawing.rfind("<svg ", 0), 0u);
  EXPECT_TRUE(hasText(drawing, "data:image/png;base64,"));
  EXPECT_TRUE(hasText(drawing, "<line "));
  EXPECT_TRUE(hasText(drawing, "</svg>"));
}

// The rays in the page's data add up to the pixel. The stages come in their order, each with
// columns of as many floats as the tile has pixels.
TEST_F(Explain, WritesALesson) {
  const auto lesson = [&](const Words& more) {
    succeed(joined({"explain", "--quiet", "--html", folder_ / "lesson.html"}, more));
    const std::string page = readFile(folder_ / "lesson.html"), start = "id=\"data\">";
    const std::size_t from = page.find(start) + start.size();
    return Json::parse(page.substr(from, page.find("</script>", from) - from));
  };

  const Json data =
      lesson({"whitted", "--size", "90x50", "--pixel", "30,20", "--spp", "2", "--tile", "16"});
  EXPECT_EQ(data["tile"], Json({16, 16, 32, 32}));
  // What the nodes add is the radiance of the pixel.
  for (std::size_t channel = 0; channel < 3; ++channel) {
    double sum = 0;
    for (const Json& node : data["tree"]["nodes"]) sum += node["adds"][channel].get<double>();
    const double radiance = data["tree"]["radiance"][channel].get<double>();
    EXPECT_NEAR(sum, radiance, 1e-6 * radiance);
  }

  Words stages;
  for (const Json& step : data["recorded"]["steps"]) {
    stages.push_back(step["stage"]);
    EXPECT_FALSE(step["columns"].empty()) << step["stage"];
    for (const Json& column : step["columns"]) {
      EXPECT_EQ(column["values"].get<std::string>().size(), (16 * 16 * 4 + 2) / 3 * 4);
    }
  }
  EXPECT_EQ(stages, (Words{"generateRays", "findIntersections", "writeEmittedAndReflectiveAmbient",
                           "findRadianceAndShadowRays", "checkShadows", "addShading", "addImpulses",
                           "updateImage"}));
  EXPECT_EQ(data["recorded"]["depths"][0], 256);
  EXPECT_GT(data["recorded"]["depths"][1], 0);

  // A scene without lights gives a lesson too, even for a ray that hits nothing.
  const Json bare = lesson({tiny_, "--set", "/lights=[]", "--size", "8x8", "--pixel", "0,0"});
  EXPECT_EQ(bare["tile"], Json({0, 0, 8, 8}));
}

// The room is closed: each path of light between its walls ends by chance, by no other cause.
TEST_F(Explain, SaysThatRouletteEndsAPath) {
  const Outcome outcome =
      succeed({"explain", "cornell", "--size", "24x24", "--pixel", "3,12", "--indirect", "4",
               "--roulette", "1", "--least", "0", "--json", folder_ / "rays.json"});
  EXPECT_TRUE(hasText(outcome.out, "no indirect light: roulette\n"));
  EXPECT_FALSE(hasText(outcome.out, "cutoff"));

  const std::string json = readFile(folder_ / "rays.json");
  EXPECT_TRUE(hasText(json, "\"roulette\""));
  EXPECT_FALSE(hasText(json, "\"cutoff\""));
  const Json first = Json::parse(json)["packets"]["samples"][0];
  for (const char* what : {"reflection", "refraction", "indirect"})
    EXPECT_TRUE(first["ends"].contains(what)) << what;
}

TEST_F(Explain, ListsSamplesAndLeavesOutWhatIsSmall) {
  const auto said = [](const char* least) {
    return runWhit({"explain", "whitted", "--size", "96x60", "--pixel", "30,20", "--spp", "2",
                    "--least", least})
        .out;
  };
  const std::string all = said("0"), most = said("0.2");

  EXPECT_FALSE(hasText(all, "more rays, adding"));
  EXPECT_TRUE(hasText(most, "more rays, adding"));
  EXPECT_NE(all.find("primary"), all.rfind("primary"));
  EXPECT_LT(most.size(), all.size());
}

// The room asks for 196 samples, whose rays nobody would read.
TEST_F(Explain, ExplainsOneSampleOfMany) {
  const auto primaries = [&](const Words& more, std::string& said) {
    said = succeed(joined({"explain", "cornell", "--size", "24x24", "--pixel", "3,12", "--json",
                           folder_ / "rays.json"},
                          more))
               .out;
    return Json::parse(readFile(folder_ / "rays.json"))["packets"]["samples"].size();
  };

  std::string said;
  EXPECT_EQ(primaries({}, said), 1u);
  EXPECT_TRUE(hasText(said, "the picture has 196: --spp 196 explains all"));
  EXPECT_EQ(primaries({"--spp", "4"}, said), 4u);
  EXPECT_FALSE(hasText(said, "explains all"));
}

// The codes are those of the light alone, which has none where a model's background shows.
TEST_F(Explain, NamesTheBackground) {
  const auto said = [&](const Words& more) {
    return succeed(joined({"explain", tiny_, "--pixel", "0,0"}, more)).out;
  };
  EXPECT_TRUE(hasText(said({"--background", "c8c8c8"}), "the picture shows --background c8c8c8"));
  EXPECT_FALSE(hasText(said({}), "the picture shows --background"));
}

TEST_F(Explain, RefusesWrongUsage) {
  for (const char* pixel : {"3,4 ", ""}) {
    expectFailure({"explain", tiny_, "--pixel", pixel}, 2, "expected");
  }
}

}  // namespace
}  // namespace whit::cli
