// whit explain from the outside.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "run_program.h"

namespace whit::cli {
namespace {

// Returns what a node and all nodes below it add to the first channel of the pixel.
double addedBelow(const nlohmann::json& node) {
  double sum = node["adds"][0].get<double>();
  for (const nlohmann::json& child : node["children"]) sum += addedBelow(child);
  return sum;
}

TEST(Explain, TellsTheTreeOfAPixel) {
  const TemporaryFolder folder;
  const std::string svg = folder / "rays.svg";
  const Outcome outcome = runWhit({"explain", "whitted", "--size", "96x60", "--pixel", "30,20",
                                   "--svg", svg, "--json", folder / "rays.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("pixel 30,20: "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("\n  packets    "), std::string::npos);
  EXPECT_NE(outcome.out.find("\n  reference  "), std::string::npos);
  EXPECT_NE(outcome.out.find("\nprimary, weight 1.00000 1.00000 1.00000, in vacuum: "),
            std::string::npos);
  EXPECT_NE(outcome.out.find("\n  refraction, weight "), std::string::npos);
  EXPECT_NE(outcome.out.find("sky adds "), std::string::npos);

  // What all rays add is the radiance of the pixel, and the scalar reference agrees with it.
  const nlohmann::json json = nlohmann::json::parse(readFile(folder / "rays.json"));
  const nlohmann::json& packets = json["packets"];
  const double radiance = packets["radiance"][0].get<double>();
  EXPECT_NEAR(addedBelow(packets["samples"][0]), radiance, 1e-6 * radiance);
  EXPECT_NEAR(json["reference"]["radiance"][0].get<double>(), radiance, 1e-3 * radiance);
  EXPECT_EQ(packets["samples"][0]["surface"]["material"], "glass");
  EXPECT_TRUE(packets["samples"][0]["surface"].contains("sphere"));
  EXPECT_FALSE(json["reference"]["samples"][0]["children"].empty());

  // The drawing holds the picture and the rays as lines.
  const std::string drawing = readFile(svg);
  EXPECT_EQ(drawing.rfind("<svg ", 0), 0u);
  EXPECT_NE(drawing.find("data:image/png;base64,"), std::string::npos);
  EXPECT_NE(drawing.find("<line "), std::string::npos);
  EXPECT_NE(drawing.find("</svg>"), std::string::npos);
}

// The rays in the page's data add up to the pixel. The stages come in their order, each with
// columns of as many floats as the tile has pixels.
TEST(Explain, WritesALesson) {
  const TemporaryFolder folder;
  const auto lesson = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"explain", "--quiet", "--html", folder / "lesson.html"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = runWhit(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const std::string page = readFile(folder / "lesson.html"), start = "id=\"data\">";
    const std::size_t from = page.find(start) + start.size();
    return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
  };

  const nlohmann::json data =
      lesson({"whitted", "--size", "90x50", "--pixel", "30,20", "--spp", "2", "--tile", "16"});
  EXPECT_EQ(data["tile"], nlohmann::json({16, 16, 32, 32}));
  // What the nodes add is the radiance of the pixel.
  for (std::size_t channel = 0; channel < 3; ++channel) {
    double sum = 0;
    for (const nlohmann::json& node : data["tree"]["nodes"])
      sum += node["adds"][channel].get<double>();
    const double radiance = data["tree"]["radiance"][channel].get<double>();
    EXPECT_NEAR(sum, radiance, 1e-6 * radiance);
  }

  std::vector<std::string> stages;
  for (const nlohmann::json& step : data["recorded"]["steps"]) {
    stages.push_back(step["stage"]);
    EXPECT_FALSE(step["columns"].empty()) << step["stage"];
    for (const nlohmann::json& column : step["columns"]) {
      EXPECT_EQ(column["values"].get<std::string>().size(), (16 * 16 * 4 + 2) / 3 * 4);
    }
  }
  EXPECT_EQ(stages, (std::vector<std::string>{"generateRays", "findIntersections",
                                              "writeEmittedAndReflectiveAmbient",
                                              "findRadianceAndShadowRays", "checkShadows",
                                              "addShading", "addImpulses", "updateImage"}));
  EXPECT_EQ(data["recorded"]["depths"][0], 256);
  EXPECT_GT(data["recorded"]["depths"][1], 0);

  // A scene without lights gives a lesson too, even for a ray that hits nothing.
  const nlohmann::json bare =
      lesson({writeTinyScene(folder), "--set", "/lights=[]", "--size", "8x8", "--pixel", "0,0"});
  EXPECT_EQ(bare["tile"], nlohmann::json({0, 0, 8, 8}));
}

// The room is closed: each path of light between its walls ends by chance, by no other cause.
TEST(Explain, SaysThatRouletteEndsAPath) {
  const TemporaryFolder folder;
  const Outcome outcome =
      runWhit({"explain", "cornell", "--size", "24x24", "--pixel", "3,12", "--indirect", "4",
               "--roulette", "1", "--least", "0", "--json", folder / "rays.json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("no indirect light: roulette\n"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("cutoff"), std::string::npos) << outcome.out;

  const std::string json = readFile(folder / "rays.json");
  EXPECT_NE(json.find("\"roulette\""), std::string::npos);
  EXPECT_EQ(json.find("\"cutoff\""), std::string::npos);
  const nlohmann::json first = nlohmann::json::parse(json)["packets"]["samples"][0];
  for (const char* what : {"reflection", "refraction", "indirect"})
    EXPECT_TRUE(first["ends"].contains(what)) << what;
}

TEST(Explain, ListsSamplesAndLeavesOutWhatIsSmall) {
  const auto said = [](const char* least) {
    return runWhit({"explain", "whitted", "--size", "96x60", "--pixel", "30,20", "--spp", "2",
                    "--least", least})
        .out;
  };
  const std::string all = said("0"), most = said("0.2");

  EXPECT_EQ(all.find("more rays, adding"), std::string::npos) << all;
  EXPECT_NE(most.find("more rays, adding"), std::string::npos) << most;
  EXPECT_NE(all.find("primary"), all.rfind("primary"));
  EXPECT_LT(most.size(), all.size());
}

// The room asks for 196 samples, whose rays nobody would read.
TEST(Explain, ExplainsOneSampleOfMany) {
  const TemporaryFolder folder;
  const auto primaries = [&](const std::vector<std::string>& more, std::string& said) {
    std::vector<std::string> words{"explain", "cornell", "--size", "24x24",
                                   "--pixel", "3,12",    "--json", folder / "rays.json"};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = runWhit(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    said = outcome.out;
    return nlohmann::json::parse(readFile(folder / "rays.json"))["packets"]["samples"].size();
  };

  std::string said;
  EXPECT_EQ(primaries({}, said), 1u);
  EXPECT_NE(said.find("the picture has 196: --spp 196 explains all"), std::string::npos) << said;
  EXPECT_EQ(primaries({"--spp", "4"}, said), 4u);
  EXPECT_EQ(said.find("explains all"), std::string::npos) << said;
}

TEST(Explain, RefusesWrongUsage) {
  const TemporaryFolder folder;
  const std::string tiny = writeTinyScene(folder);
  const auto refused = [&](std::vector<std::string> words, const std::string& because) {
    words.insert(words.begin(), {"explain", tiny});
    const Outcome outcome = runWhit(words);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(because), std::string::npos) << outcome.err;
  };

  refused({}, "expected --pixel x,y");
  for (const char* pixel : {"3", "3,", "a,b", "3,4,5", "3,4 ", ""}) {
    refused({"--pixel", pixel}, "expected");
  }
  refused({"--pixel", "48,0"}, "not in the picture of 48x32");
  refused({"--pixel", "0,-1"}, "not in the picture");
  refused({"--pixel", "0,0", "--svg", folder / "a.png"}, ".svg");
}

}  // namespace
}  // namespace whit::cli
