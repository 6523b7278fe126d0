// What whit takes random samples of, against the oracle's integrals: each pixel by itself, those
// that show one triangle together, and those of all scenes.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

// Each scene shows thousands of samples, and Mixed.* draws the same effects.
class Sampled : public Agreement {
 protected:
  Sampled() { usualScenes_ = 5; }
};

Mesh flatSolid(SceneMaker& maker) { return maker.random.chance(0.5) ? box() : tetrahedron(); }

// A polished floor among things that shine, so that what is reflected is nowhere the same.
void glossyRoom(SceneMaker& maker) {
  maker.roomFromNear();
  maker.floor(maker.glossy());
  maker.scene.bodies.back().transform.translate.y = 0.1;

  for (int i = 0; i < 4; ++i) {
    Material material = i % 2 == 0 ? maker.glossy() : maker.matte();
    if (i == 1) material.emission = maker.random.color(0, 1.5);
    maker.add(flatSolid(maker), material, maker.standing(i, 4));
  }
}

TEST_F(Sampled, GlossyReflections) {
  expectAgreement({"--glossy 64", glossyRoom, {.depth = 1, .glossy = 64}});
  expectAgreement({"--glossy 5", glossyRoom, {.depth = 3, .glossy = 5}});
}

// What the eye does not meet itself has one sample.
TEST_F(Sampled, GlossyReflectionsInMirrorsAndGlass) {
  expectAgreement({"--glossy 64 in mirrors",
                   [](SceneMaker& maker) {
                     maker.roomFromNear();
                     maker.floor(maker.mirror());
                     maker.scene.bodies.back().transform.translate.y = 0.1;
                     maker.add(flatSolid(maker), maker.glossy(), maker.standing(0, 3));

                     Material both = maker.mirror();
                     both.specular = maker.random.color(0.1, 0.5);
                     both.glossyReflection = static_cast<Choice>(maker.random.below(3));
                     maker.add(box(), both, maker.standing(1, 3));

                     Material varnished = maker.glass(1.5);
                     varnished.specular = maker.random.color(0.1, 0.5);
                     varnished.glossyReflection =
                         maker.random.chance(0.7) ? Choice::yes : Choice::unsaid;
                     maker.add(box(), varnished, maker.standing(2, 3));
                   },
                   {.depth = 3, .glossy = 64}});
}

TEST_F(Sampled, GlossyReflectionsOfBalls) {
  expectAgreement({"--glossy 64 of balls",
                   [](SceneMaker& maker) {
                     maker.roomFromNear();
                     for (int i = 0; i < 3; ++i) {
                       maker.add(ball(24, 16), maker.glossy(), maker.standing(i, 3));
                     }
                   },
                   {.depth = 2, .glossy = 64}});
}

// So smooth that the lobe is a single impulse. Without lamps: their highlights would be narrower
// than a pixel.
TEST_F(Sampled, LobesAsSmoothAsAMirror) {
  expectAgreement({"--glossy 16 of smooth surfaces",
                   [](SceneMaker& maker) {
                     maker.room();
                     for (int i = 0; i < 4; ++i) {
                       Material material = maker.glossy();
                       material.roughness = maker.random.between(0, 0.031);
                       if (i == 0) material.specular = maker.random.color(0.005, 0.039);
                       maker.add(flatSolid(maker), material, maker.standing(i, 4));
                     }
                   },
                   {.depth = 4, .glossy = 16}});
}

// Frosted solids and sheets before things to see through them.
void frostedRoom(SceneMaker& maker) {
  maker.roomFromNear();
  // A small picture, because frosted and soft light are slow here.
  maker.scene.width = 30;
  maker.scene.height = 20;
  maker.add(box(), maker.matte(), maker.random.placement({-1.4, 0.8, -2}, 0.9));

  Material shining = maker.matte();
  shining.emission = maker.random.color(0.2, 1.5);
  maker.add(tetrahedron(), shining, maker.random.placement({1.2, 0.9, -1.8}, 1));

  for (int i = 0; i < 4; ++i) {
    Material glass = maker.anyGlass();
    glass.frosted = true;
    glass.roughness = maker.random.between(0.2, 0.8);
    glass.thin = i == 3;
    if (i == 1) {
      glass.mirror = maker.random.color(0.05, 0.2);
      glass.mirrorGrazing = maker.random.color(0.3, 0.6);
    }
    if (i == 2 || maker.random.chance(0.5)) glass.specular = maker.random.color(0.02, 0.2);
    if (i == 3) glass.glossyReflection = static_cast<Choice>(maker.random.below(3));
    if (i == 3 && maker.random.chance(0.5)) glass.coverage = maker.random.between(0.3, 0.9);
    maker.add(i == 2 ? ball(16, 10) : flatSolid(maker), glass, maker.standing(i, 4));
  }
}

TEST_F(Sampled, FrostedGlass) {
  expectAgreement({"--glossy 64 of frosted glass", frostedRoom, {.depth = 3, .glossy = 64}});
  expectAgreement({"--glossy 5 of frosted glass",
                   frostedRoom,
                   {.depth = 4, .glossy = 5, .schlickFresnel = true}});
}

// Glass within glass, of which the outer or the inner one is frosted.
TEST_F(Sampled, FrostedGlassWithinGlass) {
  expectAgreement({"--glossy 16 of frosted glass in glass",
                   [](SceneMaker& maker) {
                     maker.roomFromNear();
                     Material outer = maker.glass(1.5, maker.random.below(3)),
                              inner = maker.glass(1.3, maker.random.below(3));
                     outer.frosted = maker.random.chance(0.5);
                     inner.frosted = !outer.frosted;
                     outer.roughness = inner.roughness = maker.random.between(0.2, 0.6);

                     const Vec center{0, 1.1, 0.2};
                     maker.add(box(), outer, maker.random.placement(center, 1.3));
                     maker.add(box(), inner, maker.random.placement(center, 0.7));
                   },
                   {.depth = 4, .glossy = 16}});
}

// Solids, some of which shine, stand near each other and hide ambient light from each other and
// from the floor. One of them casts no shadow.
void occludedRoom(SceneMaker& maker) {
  maker.roomFromNear();
  maker.scene.ambient.occlusion = maker.random.between(0.4, 2.5);
  for (int i = 0; i < 4; ++i) {
    Material material = i % 2 == 0 ? maker.glossy() : maker.matte();
    if (i == 1) material.emission = maker.random.color(0, 1.5);
    if (i == 3) material.castsShadow = false;
    maker.add(flatSolid(maker), material, maker.standing(i, 4));
  }
  maker.place(maker.addSphere(0.5, maker.mirror()), maker.random.placement({0, 0.4, 1.4}, 0.8));
}

TEST_F(Sampled, AmbientOcclusion) {
  expectAgreement({"--ambient-samples 64", occludedRoom, {.ambientSamples = 64}});
  expectAgreement({"--ambient-samples 3", occludedRoom, {.ambientSamples = 3}});
}

TEST_F(Sampled, IndirectLight) {
  expectAgreement({"--indirect 64", occludedRoom, {.depth = 1, .indirect = 64}});
  expectAgreement(
      {"--indirect 5 --glossy 5", occludedRoom, {.depth = 2, .glossy = 5, .indirect = 5}});
}

// Spheres of light, of which some reach into what they light.
void softShadows(SceneMaker& maker) {
  maker.roomFromNear();
  maker.scene.lights.clear();
  for (int i = 0; i < 4; ++i) {
    maker.add(maker.solid(), maker.random.chance(0.5) ? maker.rough() : maker.matte(),
              maker.standing(i, 4));
  }

  for (int i = 0; i < 2; ++i) {
    Light light = maker.lamp();
    light.radius = maker.random.between(0.2, 1.2);
    if (i == 1) {
      light.position = maker.random.inBox({-2, 0.7, 1}, {2, 1.6, 2});
      light.intensity = maker.random.color(1, 4);
    }
    maker.scene.lights.push_back(light);
  }
}

void softSpots(SceneMaker& maker) {
  softShadows(maker);
  for (Light& light : maker.scene.lights) {
    light.kind = Light::Kind::spot;
    light.direction = asFloat(maker.random.inBox({-1, 0, -1}, {1, 1, 1}) - light.position);
    light.innerConeAngle = maker.random.between(0, 15);
    light.outerConeAngle = maker.random.between(20, 50);
  }

  Light sun;
  sun.kind = Light::Kind::directional;
  sun.direction = maker.random.inBox({-1, -2, -1}, {1, -0.5, 0.2});
  sun.intensity = maker.random.color(0.2, 0.6);
  maker.scene.lights.push_back(sun);
}

TEST_F(Sampled, SoftShadows) {
  expectAgreement({"--light-samples 64", softShadows, {.lightSamples = 64}});
  expectAgreement({"--light-samples 3", softShadows, {.lightSamples = 3}});
}

TEST_F(Sampled, SoftShadowsOfSpotLights) {
  expectAgreement({"--light-samples 16 of spots", softSpots, {.lightSamples = 16}});
}

TEST_F(Sampled, SoftShadowsFromAboveTheFacets) {
  expectAgreement({"--light-samples 16 --terminator on",
                   [](SceneMaker& maker) {
                     softShadows(maker);
                     maker.add(ball(8, 5), maker.matte(), maker.random.placement({0, 1.3, 0}, 2));
                   },
                   {.lightSamples = 16, .terminator = true}});
}

TEST_F(Sampled, SoftShadowsInMirrorsGlassAndGlossyFloors) {
  expectAgreement({"--light-samples 8 --glossy 16",
                   [](SceneMaker& maker) {
                     softShadows(maker);
                     // A small picture, because frosted and soft light are slow here.
                     maker.scene.width = 30;
                     maker.scene.height = 20;
                     maker.floor(maker.rough());
                     maker.scene.bodies.back().transform.translate.y = 0.05;
                     maker.add(box(), maker.mirror(), maker.random.placement({-1, 1.2, -2}, 1.5));
                     maker.add(box(), maker.glass(1.4), maker.random.placement({1, 1, 1.2}, 0.9));
                   },
                   {.depth = 3, .glossy = 16, .lightSamples = 8}});
}

}  // namespace
}  // namespace oracle
