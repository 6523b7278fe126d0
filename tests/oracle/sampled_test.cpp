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

  // Frosted and soft light are slow here.
  void useFewPixels() {
    scene.width = 30;
    scene.height = 20;
  }

  Mesh flatSolid() { return chance(0.5) ? box() : tetrahedron(); }

  // Solids, some of which shine, stand near each other and hide ambient light from each other and
  // from the floor. One of them casts no shadow.
  void occludedRoom() {
    roomFromNear();
    scene.ambient.occlusion = between(0.4, 2.5);
    for (int i = 0; i < 4; ++i) {
      Material material = i % 2 == 0 ? glossy() : matte();
      if (i == 1) material.emission = color(0, 1.5);
      if (i == 3) material.castsShadow = false;
      add(flatSolid(), material, standing(i, 4));
    }
    place(addSphere(0.5, mirror()), placement({0, 0.4, 1.4}, 0.8));
  }

  // Spheres of light, of which some reach into what they light.
  void softShadows() {
    roomFromNear();
    scene.lights.clear();
    for (int i = 0; i < 4; ++i) {
      add(solid(), chance(0.5) ? rough() : matte(), standing(i, 4));
    }

    for (int i = 0; i < 2; ++i) {
      Light& light = addLamp();
      light.radius = between(0.2, 1.2);
      if (i == 0) continue;
      light.position = inBox({-2, 0.7, 1}, {2, 1.6, 2});
      light.intensity = color(1, 4);
    }
  }
};

// A polished floor among things that shine, so that what is reflected is nowhere the same.
TEST_F(Sampled, GlossyReflections) {
  const auto glossyRoom = [&] {
    roomFromNear();
    floor(glossy(), 0.1);
    for (int i = 0; i < 4; ++i) {
      Material material = i % 2 == 0 ? glossy() : matte();
      if (i == 1) material.emission = color(0, 1.5);
      add(flatSolid(), material, standing(i, 4));
    }
  };

  expectAgreement("--glossy 64", {.depth = 1, .glossy = 64}, glossyRoom);
  expectAgreement("--glossy 5", {.depth = 3, .glossy = 5}, glossyRoom);
}

// What the eye does not meet itself has one sample.
TEST_F(Sampled, GlossyReflectionsInMirrorsAndGlass) {
  expectAgreement("--glossy 64 in mirrors", {.depth = 3, .glossy = 64}, [&] {
    roomFromNear();
    floor(mirror(), 0.1);
    add(flatSolid(), glossy(), standing(0, 3));

    Material both = mirror();
    both.specular = color(0.1, 0.5);
    both.glossyReflection = static_cast<Choice>(below(3));
    add(box(), both, standing(1, 3));

    Material varnished = glass(1.5);
    varnished.specular = color(0.1, 0.5);
    varnished.glossyReflection = chance(0.7) ? Choice::yes : Choice::unsaid;
    add(box(), varnished, standing(2, 3));
  });
}

TEST_F(Sampled, GlossyReflectionsOfBalls) {
  expectAgreement("--glossy 64 of balls", {.depth = 2, .glossy = 64}, [&] {
    roomFromNear();
    for (int i = 0; i < 3; ++i) add(ball(24, 16), glossy(), standing(i, 3));
  });
}

// So smooth that the lobe is a single impulse. Without lamps: their highlights would be narrower
// than a pixel.
TEST_F(Sampled, LobesAsSmoothAsAMirror) {
  expectAgreement("--glossy 16 of smooth surfaces", {.depth = 4, .glossy = 16}, [&] {
    room();
    for (int i = 0; i < 4; ++i) {
      Material material = glossy();
      material.roughness = between(0, 0.031);
      if (i == 0) material.specular = color(0.005, 0.039);
      add(flatSolid(), material, standing(i, 4));
    }
  });
}

// Frosted solids and sheets before things to see through them.
TEST_F(Sampled, FrostedGlass) {
  const auto frostedRoom = [&] {
    roomFromNear();
    useFewPixels();
    add(box(), matte(), placement({-1.4, 0.8, -2}, 0.9));

    Material shining = matte();
    shining.emission = color(0.2, 1.5);
    add(tetrahedron(), shining, placement({1.2, 0.9, -1.8}, 1));

    for (int i = 0; i < 4; ++i) {
      Material glass = anyGlass();
      glass.frosted = true;
      glass.roughness = between(0.2, 0.8);
      glass.thin = i == 3;
      if (i == 1) glass = coated(glass);
      if (i == 2 || chance(0.5)) glass.specular = color(0.02, 0.2);
      if (i == 3) glass.glossyReflection = static_cast<Choice>(below(3));
      if (i == 3 && chance(0.5)) glass.coverage = between(0.3, 0.9);
      add(i == 2 ? ball(16, 10) : flatSolid(), glass, standing(i, 4));
    }
  };

  expectAgreement("--glossy 64 of frosted glass", {.depth = 3, .glossy = 64}, frostedRoom);
  expectAgreement("--glossy 5 of frosted glass", {.depth = 4, .glossy = 5, .schlickFresnel = true},
                  frostedRoom);
}

// Glass within glass, of which the outer or the inner one is frosted.
TEST_F(Sampled, FrostedGlassWithinGlass) {
  expectAgreement("--glossy 16 of frosted glass in glass", {.depth = 4, .glossy = 16}, [&] {
    roomFromNear();
    Material outer = glass(1.5, below(3)), inner = glass(1.3, below(3));
    outer.frosted = chance(0.5);
    inner.frosted = !outer.frosted;
    outer.roughness = inner.roughness = between(0.2, 0.6);

    const Vec center{0, 1.1, 0.2};
    add(box(), outer, placement(center, 1.3));
    add(box(), inner, placement(center, 0.7));
  });
}

TEST_F(Sampled, AmbientOcclusion) {
  expectAgreement("--ambient-samples 64", {.ambientSamples = 64}, [&] { occludedRoom(); });
  expectAgreement("--ambient-samples 3", {.ambientSamples = 3}, [&] { occludedRoom(); });
}

TEST_F(Sampled, IndirectLight) {
  expectAgreement("--indirect 64", {.depth = 1, .indirect = 64}, [&] { occludedRoom(); });
  expectAgreement("--indirect 5 --glossy 5", {.depth = 2, .glossy = 5, .indirect = 5},
                  [&] { occludedRoom(); });
}

TEST_F(Sampled, SoftShadows) {
  expectAgreement("--light-samples 64", {.lightSamples = 64}, [&] { softShadows(); });
  expectAgreement("--light-samples 3", {.lightSamples = 3}, [&] { softShadows(); });
}

TEST_F(Sampled, SoftShadowsOfSpotLights) {
  expectAgreement("--light-samples 16 of spots", {.lightSamples = 16}, [&] {
    softShadows();
    for (Light& light : scene.lights) makeSpot(light);
    addSun(0.2, 0.6);
  });
}

TEST_F(Sampled, SoftShadowsFromAboveTheFacets) {
  expectAgreement("--light-samples 16 --terminator on", {.lightSamples = 16, .terminator = true},
                  [&] {
                    softShadows();
                    add(ball(8, 5), matte(), placement({0, 1.3, 0}, 2));
                  });
}

TEST_F(Sampled, SoftShadowsInMirrorsGlassAndGlossyFloors) {
  expectAgreement("--light-samples 8 --glossy 16", {.depth = 3, .glossy = 16, .lightSamples = 8},
                  [&] {
                    softShadows();
                    useFewPixels();
                    floor(rough(), 0.05);
                    add(box(), mirror(), placement({-1, 1.2, -2}, 1.5));
                    add(box(), glass(1.4), placement({1, 1, 1.2}, 0.9));
                  });
}

}  // namespace
}  // namespace oracle
