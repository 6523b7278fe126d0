// whit explain from the outside.
#include "embedded_data.h"
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
  const std::string out =
      succeed("explain whitted --size 96x60 --pixel 30,20 --svg rays.svg --json rays.json").out;
  for (const char* said :
       {"pixel 30,20: ", "\n  packets    ", "\n  reference  ", "\n  refraction, weight ",
        "\nprimary, weight 1.00000 1.00000 1.00000, in vacuum: ", "sky adds "}) {
    EXPECT_TRUE(hasText(out, said));
  }

  // What all rays add is the radiance of the pixel, and the scalar reference agrees with it.
  const Json json = jsonIn("rays.json");
  const Json& packets = json["packets"];
  const double radiance = packets["radiance"][0].get<double>();
  EXPECT_NEAR(addedBelow(packets["samples"][0]), radiance, 1e-6 * radiance);
  EXPECT_NEAR(json["reference"]["radiance"][0].get<double>(), radiance, 1e-3 * radiance);
  EXPECT_EQ(packets["samples"][0]["surface"]["material"], "glass");
  EXPECT_TRUE(packets["samples"][0]["surface"].contains("sphere"));
  EXPECT_FALSE(json["reference"]["samples"][0]["children"].empty());

  // The drawing holds the picture and the rays as lines.
  const std::string drawing = bytesOf("rays.svg");
  EXPECT_TRUE(drawing.starts_with("<svg ")) << drawing;
  for (const char* part : {"data:image/png;base64,", "<line ", "</svg>"}) {
    EXPECT_TRUE(hasText(drawing, part));
  }
}

// The rays in the page's data add up to the pixel. The stages come in their order, each with
// columns of as many floats as the tile has pixels.
TEST_F(Explain, WritesALesson) {
  const auto lesson = [&](const std::string& words) -> Json {
    succeed("explain --html lesson.html " + words);
    return embeddedData(bytesOf("lesson.html"));
  };

  const Json data = lesson("whitted --size 90x50 --pixel 30,20 --spp 2 --tile 16");
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
  EXPECT_EQ(lesson("tiny.json --set /lights=[] --size 8x8 --pixel 0,0")["tile"],
            Json({0, 0, 8, 8}));
}

// RayTree.SaysThatRouletteEndsPaths tells it from other causes.
TEST_F(Explain, SaysThatRouletteEndsAPath) {
  const std::string out =
      succeed(
          "explain cornell --size 24x24 --pixel 3,12 --indirect 4 --roulette 1 --least 0 "
          "--json rays.json")
          .out;
  EXPECT_TRUE(hasText(out, "no indirect light: roulette\n"));
  EXPECT_TRUE(hasText(bytesOf("rays.json"), "\"roulette\""));
  const Json first = jsonIn("rays.json")["packets"]["samples"][0];
  for (const char* what : {"reflection", "refraction", "indirect"})
    EXPECT_TRUE(first["ends"].contains(what)) << what;
}

TEST_F(Explain, ListsSamplesAndLeavesOutWhatIsSmall) {
  const std::string line = "explain whitted --size 96x60 --pixel 30,20 --spp 2 --least ";
  const std::string all = succeed(line + "0").out, most = succeed(line + "0.2").out;

  EXPECT_FALSE(hasText(all, "more rays, adding"));
  EXPECT_TRUE(hasText(most, "more rays, adding"));
  EXPECT_NE(all.find("primary"), all.rfind("primary"));
  EXPECT_LT(most.size(), all.size());

  // No sample is the whole pixel: all rays are left out, and add the pixel.
  const std::string none = succeed(line + "1 --json rays.json").out;
  const Json packets = jsonIn("rays.json")["packets"];
  const std::string adding = " more rays, adding ";
  std::istringstream rest(none.substr(none.find(adding) + adding.size()));
  for (const Json& radiance : packets["radiance"]) {
    double added = -1;
    rest >> added;
    EXPECT_NEAR(added, radiance.get<double>(), 1e-5) << none;
  }
}

// The room asks for 196 samples, whose rays nobody would read.
TEST_F(Explain, ExplainsOneSampleOfMany) {
  const std::string line = "explain cornell --size 24x24 --pixel 3,12 --json rays.json";
  const std::string told = "the picture has 196: --spp 196 explains all";
  EXPECT_TRUE(hasText(succeed(line).out, told));
  EXPECT_EQ(jsonIn("rays.json")["packets"]["samples"].size(), 1u);
  EXPECT_FALSE(hasText(succeed(line + " --spp 4").out, "explains all"));
  EXPECT_EQ(jsonIn("rays.json")["packets"]["samples"].size(), 4u);
}

// The codes are those of the light alone, which has none where a model's background shows.
TEST_F(Explain, NamesTheBackground) {
  const std::string line = "explain tiny.json --pixel 0,0", told = "the picture shows --background";
  EXPECT_TRUE(hasText(succeed(line + " --background c8c8c8").out, told + " c8c8c8"));
  EXPECT_FALSE(hasText(succeed(line).out, told));
}

}  // namespace
}  // namespace whit::cli
