// Scenes that finalize() refuses.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "unit/scene_builder.h"

namespace whit {
namespace {

using namespace test;

struct Refusal {
  const char* name;
  std::function<void(SceneDescription&)> spoil;
  std::vector<std::string> parts;
};

Refusal ofLight(const char* name, const Light& light, const std::vector<std::string>& parts) {
  return {name, [light](SceneDescription& d) { d.lights.push_back(light); }, parts};
}

const std::vector<Refusal> kRefusals{
    ofLight("light position", {"key", {0, NAN, 0}}, {"test: light 'key'", "finite position"}),
    ofLight("unnamed light", {"", {0, INFINITY, 0}}, {"light 0", "finite position"}),
    ofLight("light intensity", {"key", {}, {1, -1, 1}}, {"light 'key'", "intensity"}),
    ofLight("light radius", {"key", {}, {1, 1, 1}, 0}, {"radius"}),
    ofLight("light radius too small to square", {"key", {}, {1, 1, 1}, 1e-20f}, {"radius"}),
    ofLight("spot light to nowhere", {"key", {}, {1, 1, 1}, 1, Light::Kind::spot, {0, 0, 0}},
            {"light 'key'", "direction"}),
    ofLight("directional light from everywhere",
            {"key", {}, {1, 1, 1}, 1, Light::Kind::directional, {0, INFINITY, 0}},
            {"light 'key'", "direction"}),
    ofLight("cone inside out", {"key", {}, {1, 1, 1}, 1, Light::Kind::spot, {0, 1, 0}, 45, 30},
            {"light 'key'", "inner < outer"}),
    ofLight("cone beyond a right angle",
            {"key", {}, {1, 1, 1}, 1, Light::Kind::spot, {0, 1, 0}, 45, 91},
            {"light 'key'", "from 0.5 to 90"}),

    {"ior of a dielectric",
     [](auto& d) {
       d.materials[0].transmission = Rgb(1.0f);
       d.materials[0].ior = 0;
     },
     {"material 'gray'", "ior"}},
    {"reflectance", [](auto& d) { d.materials[0].diffuse.y = -1; }, {"material 'gray'", "diffuse"}},
    {"roughness",
     [](auto& d) { d.materials[0].roughness = 3; },
     {"material 'gray'", "roughness to be from 0 to 1"}},

    {"sky", [](auto& d) { d.sky.zenith.x = INFINITY; }, {"test: sky", "finite"}},
    {"ambient", [](auto& d) { d.ambient.up.x = -1; }, {"ambient"}},

    {"singular transform",
     [](auto& d) {
       d.instances[0].toWorld = Affine::scaling({1, 0, 1});
     },
     {"instance 'object'", "flattens"}},
    {"nearly singular transform",
     [](auto& d) {
       d.instances[0].toWorld = {{1, 1, 0}, {1, 1 + 1e-15, 0}, {0, 0, 1}};
     },
     {"flattens"}},
    {"infinite transform",
     [](auto& d) { d.instances[0].toWorld.p.x = INFINITY; },
     {"instance 'object'", "finite"}},
    {"enormous transform",
     [](auto& d) { d.instances[0].toWorld = Affine::scaling(Vec3d(1e19)); },
     {"1.844e18"}},
};

TEST(Validate, RefusesNamingTheThingAtFault) {
  EXPECT_NO_THROW(finalized(square()));
  for (const Refusal& r : kRefusals) {
    SCOPED_TRACE(r.name);
    SceneDescription d = sceneOf(square());
    r.spoil(d);
    expectError(ExitStatus::badScene, r.parts, [&] { finalized(d); });
  }
}

TEST(Validate, TinyTransformsAreNotSingular) {
  SceneDescription d = sceneOf(square());
  d.instances[0].toWorld = Affine::scaling(Vec3d(1e-12));
  EXPECT_EQ(finalized(d).triangles.size(), 2u);
}

}  // namespace
}  // namespace whit
