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

  Renderer renderer = smallRenderer("whitted", {.progress = note});
  EXPECT_TRUE(phases.contains("making textures")) << testing::PrintToString(phases);
  EXPECT_TRUE(phases.contains("baking geometry"));

  renderer.setProgress(note).render();
  EXPECT_TRUE(phases.contains("building the BVH"));
  EXPECT_TRUE(phases.contains("tracing"));
}

TEST(Progress, LoadingIsEnded) {
  for (const char* at : {"making textures", "reading scene", "baking geometry"}) {
    const LoadOptions ended{.progress = [&](const auto& phase, double) { return phase != at; }};
    EXPECT_EQ(statusOf([&] { loadScene("whitted", ended); }), 130) << at;
  }
}

TEST(Progress, WhatWasEndedCanBeDoneAgain) {
  Renderer renderer = smallRenderer("whitted");
  const Image expected = smallRenderer("whitted").render();
  renderer.set("tile", "8");
  for (const auto& [adaptive, spp] : {std::pair{"off", "1"}, {"on", "4"}}) {
    for (const char* mode : {"packets", "reference"}) {
      renderer.set("adaptive", adaptive).set("spp", spp).set("mode", mode);
      for (const double end : {0.0, 0.3, 0.7}) {
        renderer.setProgress([&](const std::string& phase, double fraction) {
          return !phase.starts_with("tracing") || fraction < end;
        });
        EXPECT_EQ(statusOf([&] { renderer.render(); }), 130) << mode << " " << end;
      }
    }
  }

  renderer.setProgress([](const std::string& phase, double) { return phase[0] != 'b'; });
  renderer.set("bvh", "low");
  EXPECT_EQ(statusOf([&] { renderer.render(); }), 130);

  renderer.setProgress({}).reset().set("size", "40x24");
  EXPECT_TRUE(samePictures(expected, renderer));
}

TEST(Progress, AnEndedReadingAgainLeavesTheScene) {
  Renderer renderer = smallRenderer("whitted");
  const Image before = renderer.render();
  renderer.setProgress([](const std::string&, double) { return false; });
  EXPECT_EQ(statusOf([&] { renderer.setMember("/scene/1/radius", "0.5"); }), 130);
  EXPECT_TRUE(samePictures(before, renderer.setProgress({})));
}

TEST(Progress, WhatACallbackThrowsReachesTheCaller) {
  const Progress throws = [](const auto&, double) -> bool { throw std::out_of_range("mine"); };
  EXPECT_THROW(loadScene("whitted", {.progress = throws}), std::out_of_range);

  Renderer renderer = smallRenderer("whitted");
  renderer.setProgress(throws);
  EXPECT_THROW(renderer.render(), std::out_of_range);
  renderer.setProgress({});
  EXPECT_EQ(renderer.render().width(), 40);
}

}  // namespace
}  // namespace whit::api
