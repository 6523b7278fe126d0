// What whit takes random samples of, against the oracle's integrals: each pixel by itself, those
// that show one triangle together, and those of all scenes.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Sampled : public Agreement {};

// Seen from near: what is sampled shall fill the picture.
void litRoom(SceneMaker& maker) {
  maker.room();
  maker.scene.camera.fov = maker.random.between(24, 30);
  Light light = maker.lamp();
  light.intensity = maker.random.color(2, 6);  // highlights that are seen by few samples are noise
  maker.scene.lights.push_back(light);
}

Mesh flatSolid(SceneMaker& maker) { return maker.random.chance(0.5) ? box() : tetrahedron(); }

// A polished floor among things that shine, so that what is reflected is nowhere the same.
void glossyRoom(SceneMaker& maker) {
  litRoom(maker);
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
                     litRoom(maker);
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
                     litRoom(maker);
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

}  // namespace
}  // namespace oracle
