// Progress of the library's long work, and its end before its time.
#include <set>
#include <stdexcept>

#include "library_scenes.h"

namespace whit::api {
namespace {

TEST(Progress, TellsWhatIsGoingOn) {
  std::set<std::string> phases;
  const Progress note = [&](const std::string& phase, double fraction) {
    EXPECT_GE(fraction, 0);
    EXPECT_LE(fraction, 1);
    phases.insert(phase);
    return true;
  };

  LoadOptions options;
  options.progress = note;
  Renderer renderer = smallRenderer(loadScene("whitted", options));
  EXPECT_TRUE(phases.contains("making textures")) << testing::PrintToString(phases);
  EXPECT_TRUE(phases.contains("baking geometry"));

  renderer.setProgress(note).render();
  EXPECT_TRUE(phases.contains("building the BVH"));
  EXPECT_TRUE(phases.contains("tracing"));
}

TEST(Progress, LoadingIsEnded) {
  for (const char* at : {"making textures", "reading scene", "baking geometry"}) {
    LoadOptions options;
    options.progress = [&](const std::string& phase, double) { return phase != at; };
    EXPECT_EQ(errorOf([&] { loadScene("whitted", options); }).status(), 130) << at;
  }
}

TEST(Progress, WhatWasEndedCanBeDoneAgain) {
  Renderer renderer = smallRenderer(loadScene("whitted"));
  const Image expected = smallRenderer(loadScene("whitted")).render();
  const char* const modes[] = {"packets", "reference"};
  for (const char* adaptive : {"off", "on"}) {
    renderer.set("spp", adaptive == std::string("on") ? "4" : "1").set("adaptive", adaptive);
    for (const char* mode : modes) {
      for (const double end : {0.0, 0.3, 0.7}) {
        renderer.set("mode", mode).set("tile", "8");
        renderer.setProgress([&](const std::string& phase, double fraction) {
          return !phase.starts_with("tracing") || fraction < end;
        });
        EXPECT_EQ(errorOf([&] { renderer.render(); }).status(), 130) << mode << " " << end;
      }
    }
  }

  renderer.setProgress([](const std::string& phase, double) { return phase[0] != 'b'; });
  renderer.set("bvh", "low");
  EXPECT_EQ(errorOf([&] { renderer.render(); }).status(), 130);

  renderer.setProgress({}).reset().set("size", "40x24");
  EXPECT_TRUE(samePictures(expected, renderer.render()));
}

TEST(Progress, AnEndedReadingAgainLeavesTheScene) {
  Renderer renderer = smallRenderer(loadScene("whitted"));
  const Image before = renderer.render();
  renderer.setProgress([](const std::string&, double) { return false; });
  EXPECT_EQ(errorOf([&] { renderer.setMember("/scene/1/radius", "0.5"); }).status(), 130);
  EXPECT_TRUE(samePictures(before, renderer.setProgress({}).render()));
}

TEST(Progress, WhatACallbackThrowsReachesTheCaller) {
  LoadOptions options;
  options.progress = [](const std::string&, double) -> bool { throw std::out_of_range("mine"); };
  EXPECT_THROW(loadScene("whitted", options), std::out_of_range);

  Renderer renderer = smallRenderer(loadScene("whitted"));
  renderer.setProgress(options.progress);
  EXPECT_THROW(renderer.render(), std::out_of_range);
  renderer.setProgress({});
  EXPECT_EQ(renderer.render().width(), 40);
}

}  // namespace
}  // namespace whit::api
