// Opaque surfaces and what lights them.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Surfaces : public Agreement {};

void addSolids(SceneMaker& maker, int count, const std::function<Material()>& material) {
  for (int i = 0; i < count; ++i) {
    maker.add(maker.solid(), material(), maker.standing(i, count));
  }
}

void hangPane(SceneMaker& maker, const Material& material) {
  maker.add(pane(), material, maker.random.placement({0.4, 2.3, -1.2}, 1.6));
}

void opaque(SceneMaker& maker) {
  maker.room();
  addSolids(maker, 4, [&] { return maker.random.chance(0.6) ? maker.glossy() : maker.matte(); });
  hangPane(maker, maker.matte());
  maker.addLamps(2);
}

TEST_F(Surfaces, OpaqueOnesAndTheirShadows) { expectAgreement({"opaque", opaque}); }

// Within its radius a light grows no brighter; its center is what casts shadows.
TEST_F(Surfaces, LightsWithARadius) {
  expectAgreement({"lights with a radius", [](SceneMaker& maker) {
                     maker.room();
                     addSolids(maker, 4, [&] { return maker.glossy(); });
                     for (int i = 0; i < 3; ++i) {
                       Light light = maker.lamp();
                       light.position = maker.random.inBox({-2, 0.5, 1}, {2, 2, 2});
                       light.intensity = maker.random.color(1, 4);
                       light.radius = maker.random.between(0.8, 2.5);
                       maker.scene.lights.push_back(light);
                     }
                   }});
}

// A shade right beside a light still shades. Shadow rays end short of the light by the rounding of
// its position and of their own length, which is a few millionths: of these distances it is less
// than a third.
void shadedLights(SceneMaker& maker, double height, double gap) {
  maker.room();
  const double down = height - 2.2;  // where the floor is
  for (Body& body : maker.scene.bodies) body.transform.translate.y += asFloat(down);
  maker.scene.camera.eye.y = asFloat(maker.scene.camera.eye.y + down);
  maker.scene.camera.at.y = asFloat(maker.scene.camera.at.y + down);

  for (int i = 0; i < 3; ++i) {
    Transform standing = maker.standing(i, 3);
    standing.translate.y = asFloat(standing.translate.y + down);
    maker.add(maker.solid(), maker.glossy(), standing);
  }

  const bool near = height == 0;
  for (const double side : {1.0, -1.0}) {
    const Vec at =
        near && side > 0 ? Vec{} : asFloat(Vec{1.8 * side, height, maker.random.between(0, 1)});

    Transform shade;
    shade.degrees = maker.random.between(0, 90);
    shade.scale = {1.5, 1, 1.5};
    shade.translate = at;
    maker.add(pane(), maker.matte(), shade);

    Light light;
    light.position = asFloat(at + Vec{0, side * (at.x == 0 ? gap / 4 : gap), 0});
    light.intensity = maker.random.color(8, 20);
    light.radius = 1e-3;
    maker.scene.lights.push_back(light);
  }
}

TEST_F(Surfaces, LightsRightBesideAShade) {
  constexpr double kGap = 4e-5;
  expectAgreement(
      {"lights beside a shade", [](SceneMaker& maker) { shadedLights(maker, 2.2, kGap); }});
  expectAgreement({"lights beside a shade about the origin",
                   [](SceneMaker& maker) { shadedLights(maker, 0, kGap); }});
}

void spotsAndSuns(SceneMaker& maker) {
  maker.room();
  addSolids(maker, 4, [&] { return maker.glossy(); });
  Random& random = maker.random;
  for (int i = 0; i < 3; ++i) {
    Light spot = maker.lamp();
    spot.kind = Light::Kind::spot;
    const Vec aim = random.inBox({-1.5, 0, -1}, {1.5, 1, 1}) - spot.position;
    spot.direction = asFloat(aim * random.between(0.3, 2));
    spot.innerConeAngle = i == 0 ? 0 : random.between(3, 12);
    spot.outerConeAngle = random.between(16, 40);
    spot.radius = random.between(0.01, 2);
    maker.scene.lights.push_back(spot);

    Light sun;
    sun.kind = Light::Kind::directional;
    sun.direction = random.inBox({-1, -2, -1}, {1, -0.5, 0.2});
    sun.intensity = random.color(0.2, 1);
    maker.scene.lights.push_back(sun);
  }
}

TEST_F(Surfaces, SpotAndDirectionalLights) {
  expectAgreement({"spot and directional lights", spotsAndSuns});
}

void mirrors(SceneMaker& maker) {
  maker.room();
  maker.floor(maker.mirror());
  maker.scene.bodies.back().transform.translate.y = 0.1;
  addSolids(maker, 3, [&] { return maker.mirror(); });
  hangPane(maker, maker.mirror());
  maker.add(box(), maker.glossy(), maker.random.placement({1, 1.9, 0.9}, 0.4));
  maker.addLamps(2);
}

TEST_F(Surfaces, Mirrors) { expectAgreement({"mirrors", mirrors, {.depth = 10}}); }

// No real surface reflects less than 4 %: below, the lobe fades out at grazing incidence as well.
TEST_F(Surfaces, HighlightsBelowFourPercent) {
  expectAgreement({"highlights below 4 %", [](SceneMaker& maker) {
                     const auto faint = [&] {
                       Material material = maker.matte();
                       material.diffuse = material.diffuse * asFloat(0.0625);
                       material.specular = maker.random.color(0.001, 0.039);
                       material.roughness = maker.random.between(0.3, 0.6);
                       return material;
                     };

                     maker.room();
                     maker.scene.ambient = {};
                     maker.scene.camera.eye.y = 0.6;  // grazing, against the light
                     maker.scene.bodies.clear();
                     maker.floor(faint());
                     addSolids(maker, 4, faint);

                     for (int i = 0; i < 3; ++i) {
                       Light light = maker.lamp();
                       light.position = maker.random.inBox({-3, 0.6, -4}, {3, 2, -2});
                       light.intensity = maker.random.color(20, 60);
                       maker.scene.lights.push_back(light);
                     }
                   }});
}

TEST_F(Surfaces, ColorsOfVertices) {
  expectAgreement({"vertex colors", [](SceneMaker& maker) {
                     maker.room();
                     for (int i = 0; i < 4; ++i) {
                       Mesh mesh = maker.solid();
                       for (std::size_t k = 0; k < mesh.positions.size(); ++k) {
                         mesh.colors.push_back(maker.random.color(0, 1));
                       }

                       const bool mirror = maker.random.chance(0.3);
                       maker.add(mesh, mirror ? maker.mirror() : maker.glossy(),
                                 maker.standing(i, 4));
                     }
                     maker.addLamps(2);
                   }});
}

TEST_F(Surfaces, Emission) {
  expectAgreement({"emission", [](SceneMaker& maker) {
                     maker.room();
                     addSolids(maker, 4, [&] {
                       const bool mirror = maker.random.chance(0.4);
                       Material material = mirror ? maker.mirror() : maker.matte();
                       material.emission = maker.random.color(0, 1.5);
                       return material;
                     });

                     Material glowing = maker.matte();
                     glowing.emission = maker.random.color(0.2, 1);
                     hangPane(maker, glowing);  // from both sides
                     maker.addLamps(1);
                   }});
}

TEST_F(Surfaces, AmbientLightFromTheSky) {
  expectAgreement({"ambient from the sky", [](SceneMaker& maker) {
                     maker.room();
                     maker.scene.sky.scale = maker.random.between(0.5, 2);
                     maker.scene.ambient.fromSky = maker.random.between(0.2, 1);
                     addSolids(maker, 4, [&] { return maker.matte(); });
                     maker.addLamps(1);
                   }});
}

TEST_F(Surfaces, ImagesOfTheSky) {
  expectAgreement(
      {"sky images", [](SceneMaker& maker) {
         maker.room();
         Sky& sky = maker.scene.sky;
         sky.kind = Sky::Kind::image;
         sky.width = 7;
         sky.height = 4;
         for (int i = 0; i < sky.width * sky.height; ++i) {
           const Color c = maker.random.color(0, 250);
           sky.texels.push_back(Color{std::floor(c.x), std::floor(c.y), std::floor(c.z)} / 256);
         }
         sky.scale = maker.random.between(0.5, 2);
         sky.rotation = maker.random.between(-180, 360);

         maker.scene.camera.fov = 80;
         addSolids(maker, 4, [&] { return maker.mirror(); });
         maker.addLamps(1);
       }});
}

// A ball of large facets that fills the picture, lit from the side: the light ends across it.
void facetedBall(SceneMaker& maker) {
  maker.room();
  const Transform large = maker.random.placement({0, 1.3, 0}, 2.4);
  const Mesh sphere = maker.random.chance(0.5) ? ball(12, 8) : ball(8, 5);
  maker.add(sphere, maker.matte(), large);

  maker.add(box(), maker.matte(), maker.random.placement({-1.6, 1.9, 0.9}, 0.4));
  for (const double side : {-1.0, 1.0}) {
    Light light = maker.lamp();
    light.position = maker.random.inBox({4, 0.5, -2}, {6, 3, 1}) * Vec{side, 1, 1};
    maker.scene.lights.push_back(light);
  }
}

TEST_F(Surfaces, ShadowRaysFromAboveTheFacets) {
  expectAgreement({"--terminator on", facetedBall, {.terminator = true}});
  expectAgreement({"--terminator off", facetedBall});
}

// Repeated, turned and from below 0.
Mesh turnedPane(double repeats) {
  Mesh mesh = pane();
  for (auto& [u, v] : mesh.uvs) {
    const double across = u, up = v;
    u = asFloat(repeats * (1.7 * across + 0.6 * up - 0.9));
    v = asFloat(repeats * (1.2 * up - 0.5 * across - 0.3));
  }
  return mesh;
}

void textured(SceneMaker& maker) {
  maker.room();
  maker.scene.bodies.clear();

  for (int i = 0; i < 2; ++i) maker.addColors(5 + 3 * i, 4);
  for (int i = 0; i < 4; ++i) {
    const Mesh mesh = turnedPane(1);
    Material material = maker.glossy();
    material.diffuseMap = i % 2;
    if (i == 1) material.specularMap = 0;
    if (i == 2) {
      material.emission = maker.random.color(0.2, 1);
      material.emissionMap = 1;
    }

    if (i == 0) {
      Transform below;
      below.scale = {9, 1, 9};
      maker.add(mesh, material, below);
    } else {
      maker.add(mesh, material, maker.standing(i - 1, 3));
    }
  }
  maker.addLamps(2);
}

TEST_F(Surfaces, TexturesOfNearestAndMixedTexels) {
  expectAgreement({"bilinear textures", textured});
  expectAgreement({"textures of nearest texels", textured, {.filter = Filter::nearest}});
}

Mesh mappedBall(SceneMaker& maker) {
  Mesh mesh = ball(16, 10);
  for (const Vec& p : mesh.positions) {
    mesh.uvs.push_back({asFloat(2 * p.x + 0.7 * p.y), asFloat(1.5 * p.z - p.y)});
  }
  if (maker.random.chance(0.5)) {  // the other handedness
    for (auto& uv : mesh.uvs) uv[0] = -uv[0];
  }
  return mesh;
}

void normalMapped(SceneMaker& maker) {
  maker.room();
  maker.scene.bodies.clear();
  const int map = maker.addData(8, 4, {80, 80, 200}, {176, 176, 255.99});
  const auto bumpy = [&](Material material) {
    material.normalMap = map;
    return material;
  };

  Transform below;
  below.scale = {9, 1, 9};
  below.degrees = maker.random.between(0, 90);
  maker.add(turnedPane(2), bumpy(maker.matte()), below);
  maker.add(mappedBall(maker), bumpy(maker.matte()), maker.standing(0, 4));

  Transform facing = maker.standing(1, 4);  // a lobe has no value for a viewer behind it
  facing.axis = {1, 0, 0};
  facing.degrees = maker.random.between(50, 80);
  maker.add(turnedPane(1), bumpy(maker.glossy()), facing);

  const int twice = maker.addObject(turnedPane(0.7), bumpy(maker.matte()));
  for (int i = 2; i < 4; ++i) {
    Transform standing = maker.standing(i, 4);
    standing.scale = asFloat(standing.scale * maker.random.color(0.6, 1.5));
    if (i == 3) standing.scale.x = -standing.scale.x;
    maker.place(twice, standing);
  }

  maker.addLamps(2);
}

TEST_F(Surfaces, NormalMaps) { expectAgreementWithEachFilter({"normal maps", normalMapped}); }

// With parts that are cut out as a whole, parts that are not, and some that are torn.
int addMask(SceneMaker& maker) {
  constexpr int kPart = 8, kParts = 3;
  Texture texture{kPart * kParts, kPart * kParts, {}, true};
  std::array<int, kParts * kParts> lowest{};
  for (int& low : lowest) low = 75 * maker.random.below(3);

  for (int y = 0; y < texture.height; ++y) {
    for (int x = 0; x < texture.width; ++x) {
      const int low = lowest[static_cast<std::size_t>(y / kPart * kParts + x / kPart)];
      texture.texels.push_back({low + maker.random.below(105), 0, 0});
    }
  }

  return maker.addTexture(texture);
}

// In shadows too, and seen in mirrors.
void masked(SceneMaker& maker) {
  maker.room();
  maker.floor(maker.mirror());
  maker.scene.bodies.back().transform.translate.y = 0.05;

  for (int i = 0; i < 4; ++i) {
    Material material = maker.glossy();
    material.alphaMap = addMask(maker);
    if (i == 1) material.alphaCutoff = maker.random.between(0.3, 0.7);
    maker.add(turnedPane(0.7), material, maker.standing(i, 4));
  }
  maker.addLamps(2);
}

TEST_F(Surfaces, AlphaMasks) {
  expectAgreement({"alpha masks", masked});
  expectAgreement({"alpha masks, nearest texels", masked, {.filter = Filter::nearest}});
}

// From less than a texel a pixel to more than all of them.
void texturedAtAnyDistance(SceneMaker& maker) {
  maker.room();
  maker.scene.bodies.clear();
  maker.addColors(32, 16);
  maker.addColors(13, 7);
  const auto image = [&] {
    Material material = maker.glossy();
    material.diffuseMap = maker.random.below(2);
    if (maker.random.chance(0.4)) material.specularMap = maker.random.below(2);
    if (maker.random.chance(0.3)) material.emission = maker.random.color(0.2, 1);
    if (largest(material.emission) > 0) material.emissionMap = maker.random.below(2);
    return material;
  };

  Transform below;
  below.scale = {30, 1, 30};
  below.degrees = maker.random.between(0, 90);
  maker.add(turnedPane(maker.random.between(2, 20)), image(), below);

  const int instance = maker.addObject(turnedPane(maker.random.between(0.2, 4)), image());
  for (int i = 0; i < 3; ++i) {
    Transform standing = maker.standing(i, 5);
    standing.scale = asFloat(standing.scale * maker.random.color(0.6, 1.5));
    if (i == 1) standing.scale.x = -standing.scale.x;
    maker.place(instance, standing);
  }

  maker.add(box(), maker.mirror(), maker.standing(3, 5));
  maker.add(box(), maker.glass(1.4), maker.standing(4, 5));
  maker.addLamps(2);
}

TEST_F(Surfaces, MixedMipMaps) {
  const Options options{.depth = 6, .filter = Filter::trilinear};
  expectAgreement({"trilinear textures", texturedAtAnyDistance, options});
  expectAgreement({"trilinear textures, parallel rays",
                   [](SceneMaker& maker) {
                     texturedAtAnyDistance(maker);
                     maker.scene.camera.orthographicHeight = maker.random.between(2, 8);
                   },
                   options});
}

// Cut and covered in part, with colors that differ where nothing is left.
void maskedAtAnyDistance(SceneMaker& maker) {
  texturedAtAnyDistance(maker);
  for (Material& material : maker.scene.materials) {
    if (material.diffuseMap == kNone && material.emissionMap == kNone) continue;
    if (maker.random.chance(0.3)) continue;

    const bool isCovered = maker.random.chance(0.5);
    if (isCovered) material.coverageMap = addMask(maker);
    if (!isCovered || maker.random.chance(0.3)) material.alphaMap = addMask(maker);
    material.alphaCutoff = maker.random.between(0.2, 0.6);
  }
}

TEST_F(Surfaces, MixedMipMapsOfMaskedSurfaces) {
  expectAgreement({"trilinear textures with masks",
                   maskedAtAnyDistance,
                   {.depth = 6, .filter = Filter::trilinear}});
}

// Turned, scaled, stretched where flat, and mirrored.
void addInstances(SceneMaker& maker) {
  maker.room();
  const int solids[] = {maker.addObject(box(), maker.glossy()),
                        maker.addObject(tetrahedron(), maker.mirror()),
                        maker.addObject(ball(12, 8), maker.glossy())};

  for (int i = 0; i < 9; ++i) {
    Transform transform = maker.standing(i % 5, 5);
    if (i >= 5) transform.translate += {0, 0.5, -1.5};
    if (i % 3 != 2) transform.scale = transform.scale * maker.random.color(0.6, 1);
    if (i % 2 == 0) transform.scale.x = -transform.scale.x;
    transform.scale = asFloat(transform.scale);
    maker.place(solids[i % 3], transform);
  }

  maker.addLamps(2);
}

TEST_F(Surfaces, Instances) { expectAgreement({"instances", addInstances}); }

TEST_F(Surfaces, InstancesFarFromTheOrigin) {
  const auto make = [](SceneMaker& maker) {
    addInstances(maker);
    maker.moveBy({150, -90, 120});
  };
  expectAgreement({"instances far away", make, {}, 10});
}

}  // namespace
}  // namespace oracle
