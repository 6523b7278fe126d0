// Meshes whose arrays are replaced between frames give the picture of a scene that was built with
// the new arrays.
#include <array>
#include <limits>

#include "has_text.h"
#include "library_scenes.h"

namespace whit::api {
namespace {

using Corners = std::array<float, 12>;
constexpr Corners kFlatCorners{-1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1};

MeshArrays sheet(const Corners& corners) { return {.positions = corners, .triangles = kHalves}; }

Scene sheetScene(const Corners& corners) {
  SceneBuilder builder("sheets");
  builder.addMesh("sheet", sheet(corners));
  builder.addInstance("sheet");
  builder.addCamera("front", kSheetCamera);
  builder.addLight(kSheetLight);
  return builder.build({.movable = {"/scene/0"}});
}

TEST(UpdateMesh, HasThePictureOfASceneThatWasBuiltSo) {
  Renderer renderer = smallRenderer(sheetScene(kFlatCorners));
  const Image flat = renderer.render();
  const Image bent = smallRenderer(sheetScene(kBentCorners)).render();
  ASSERT_FALSE(samePictures(flat, bent));

  EXPECT_TRUE(samePictures(renderer.updateMesh("sheet", sheet(kBentCorners)), bent));
  EXPECT_TRUE(samePictures(renderer.updateMesh("sheet", sheet(kFlatCorners)), flat));

  MeshArrays half = sheet(kBentCorners);
  half.triangles = half.triangles.first(3);
  EXPECT_FALSE(samePictures(renderer.updateMesh("sheet", half), bent));
  EXPECT_EQ(renderer.scene().triangles(), 1u);
}

TEST(UpdateMesh, KeepsMembersTransformsAndOptions) {
  Renderer expected = smallRenderer(sheetScene(kBentCorners));
  Renderer renderer = smallRenderer(sheetScene(kFlatCorners));
  for (Renderer* changed : {&expected, &renderer}) {
    changed->setMember("/lights/0/intensity", "60")
        .setTransform("/scene/0", placed({0.25, 0.5, 0}));
  }
  renderer.updateMesh("sheet", sheet(kBentCorners));
  const Image picture = renderer.render();
  EXPECT_TRUE(samePictures(picture, expected));
  EXPECT_EQ(picture.width(), 40);

  // A member for which the scene is read again finds the new arrays.
  renderer.setMember("/materials/unused", R"({"diffuse": 0.5})");
  EXPECT_TRUE(samePictures(renderer, picture));
}

// As do members and transforms.
TEST(UpdateMesh, LeavesTheScenesOfOthersAlone) {
  const Scene scene = sheetScene(kFlatCorners);
  Renderer other = smallRenderer(scene);
  const Image before = other.render();
  const std::function<void(Renderer&)> changes[] = {
      [](Renderer& r) { r.updateMesh("sheet", sheet(kBentCorners)); },
      [](Renderer& r) { r.setMember("/lights/0/intensity", "4"); },
      [](Renderer& r) {
        r.setTransform("/scene/0", placed({0, 0.5, 0}));
      },
  };
  for (const auto& change : changes) {
    Renderer changed = smallRenderer(scene);
    change(changed);
    EXPECT_FALSE(samePictures(changed, before));
    EXPECT_TRUE(samePictures(other, before));
    EXPECT_TRUE(samePictures(smallRenderer(scene), before));
  }
}

TEST(UpdateMesh, RefusesWhatIsNoMesh) {
  Renderer renderer = smallRenderer(sheetScene(kFlatCorners));
  const Image before = renderer.render();

  const Error unknown = errorOf([&] { renderer.updateMesh("shet", sheet(kBentCorners)); });
  EXPECT_EQ(unknown.status(), 2);
  EXPECT_TRUE(hasText(std::string(unknown.what()), "did you mean 'sheet'?"));

  Corners infinite = kBentCorners;
  infinite[4] = std::numeric_limits<float>::infinity();
  const Error refused = errorOf([&] { renderer.updateMesh("sheet", sheet(infinite)); });
  EXPECT_EQ(refused.status(), 3);
  EXPECT_EQ(refused.place(), "/scene/0/mesh");
  EXPECT_TRUE(samePictures(renderer, before));

  Renderer file = smallRenderer("whitted");
  EXPECT_EQ(statusOf([&] { file.updateMesh("sheet", sheet(kBentCorners)); }), 2);
}

}  // namespace
}  // namespace whit::api
