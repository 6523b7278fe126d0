// Opaque surfaces and what lights them.
#include "oracle/agreement.h"
#include "oracle/shapes.h"

namespace oracle {
namespace {

class Surfaces : public Agreement {
 protected:
  void addSolids(int count, const std::function<Material()>& material) {
    for (int i = 0; i < count; ++i) add(solid(), material(), standing(i, count));
  }

  void hangPane(const Material& material) {
    add(pane(), material, placement({0.4, 2.3, -1.2}, 1.6));
  }

  // A shade right beside a light still shades. Shadow rays end short of the light by the rounding
  // of its position and of their own length, which is a few millionths: of these distances it is
  // less than a third.
  void shadedLights(double height, double gap) {
    room();
    const double down = height - 2.2;  // where the floor is
    for (Body& body : scene.bodies) body.transform.translate.y += asFloat(down);
    scene.camera.eye.y = asFloat(scene.camera.eye.y + down);
    scene.camera.at.y = asFloat(scene.camera.at.y + down);

    for (int i = 0; i < 3; ++i) {
      Transform at = standing(i, 3);
      at.translate.y = asFloat(at.translate.y + down);
      add(solid(), glossy(), at);
    }

    const bool near = height == 0;
    for (const double side : {1.0, -1.0}) {
      const Vec at = near && side > 0 ? Vec{} : asFloat(Vec{1.8 * side, height, between(0, 1)});

      Transform shade;
      shade.degrees = between(0, 90);
      shade.scale = {1.5, 1, 1.5};
      shade.translate = at;
      add(pane(), matte(), shade);

      Light& light = scene.lights.emplace_back();
      light.position = asFloat(at + Vec{0, side * (at.x == 0 ? gap / 4 : gap), 0});
      light.intensity = color(8, 20);
      light.radius = 1e-3;
    }
  }

  Mesh mappedBall() {
    Mesh mesh = ball(16, 10);
    for (const Vec& p : mesh.positions) {
      mesh.uvs.push_back({asFloat(2 * p.x + 0.7 * p.y), asFloat(1.5 * p.z - p.y)});
    }
    if (chance(0.5)) {  // the other handedness
      for (auto& uv : mesh.uvs) uv[0] = -uv[0];
    }
    return mesh;
  }

  // With parts that are cut out as a whole, parts that are not, and some that are torn.
  int addTornMask() {
    constexpr int kPart = 8, kParts = 3;
    Texture texture{kPart * kParts, kPart * kParts, {}, true};
    std::array<int, kParts * kParts> lowest{};
    for (int& low : lowest) low = 75 * below(3);

    forEachPixel(texture.width, texture.height, [&](int x, int y) {
      texture.texels.push_back({lowest[y / kPart * kParts + x / kPart] + below(105), 0, 0});
    });

    return addTexture(texture);
  }

  // From less than a texel a pixel to more than all of them.
  void texturedAtAnyDistance() {
    room();
    scene.bodies.clear();
    addColors(32, 16);
    addColors(13, 7);
    const auto image = [&] {
      Material material = glossy();
      material.diffuseMap = below(2);
      if (chance(0.4)) material.specularMap = below(2);
      if (chance(0.3)) material.emission = color(0.2, 1);
      if (largest(material.emission) > 0) material.emissionMap = below(2);
      return material;
    };

    Transform ground;
    ground.scale = {30, 1, 30};
    ground.degrees = between(0, 90);
    add(turnedPane(between(2, 20)), image(), ground);

    const int instance = addObject(turnedPane(between(0.2, 4)), image());
    for (int i = 0; i < 3; ++i) {
      Transform at = standing(i, 5);
      at.scale = asFloat(at.scale * color(0.6, 1.5));
      if (i == 1) at.scale.x = -at.scale.x;
      place(instance, at);
    }

    add(box(), mirror(), standing(3, 5));
    add(box(), glass(1.4), standing(4, 5));
    addLamps(2);
  }

  // Turned, scaled, stretched where flat, and mirrored.
  void addInstances() {
    room();
    const int solids[] = {addObject(box(), glossy()), addObject(tetrahedron(), mirror()),
                          addObject(ball(12, 8), glossy())};

    for (int i = 0; i < 9; ++i) {
      Transform transform = standing(i % 5, 5);
      if (i >= 5) transform.translate += {0, 0.5, -1.5};
      if (i % 3 != 2) transform.scale = transform.scale * color(0.6, 1);
      if (i % 2 == 0) transform.scale.x = -transform.scale.x;
      transform.scale = asFloat(transform.scale);
      place(solids[i % 3], transform);
    }

    addLamps(2);
  }
};

TEST_F(Surfaces, OpaqueOnesAndTheirShadows) {
  expectAgreement("opaque", [&] {
    room();
    addSolids(4, [&] { return chance(0.6) ? glossy() : matte(); });
    hangPane(matte());
    addLamps(2);
  });
}

// Within its radius a light grows no brighter; its center is what casts shadows.
TEST_F(Surfaces, LightsWithARadius) {
  expectAgreement("lights with a radius", [&] {
    room();
    addSolids(4, [&] { return glossy(); });
    for (int i = 0; i < 3; ++i) {
      Light& light = addLamp();
      light.position = inBox({-2, 0.5, 1}, {2, 2, 2});
      light.intensity = color(1, 4);
      light.radius = between(0.8, 2.5);
    }
  });
}

TEST_F(Surfaces, LightsRightBesideAShade) {
  constexpr double kGap = 4e-5;
  expectAgreement("lights beside a shade", [&] { shadedLights(2.2, kGap); });
  expectAgreement("lights beside a shade about the origin", [&] { shadedLights(0, kGap); });
}

TEST_F(Surfaces, SpotAndDirectionalLights) {
  expectAgreement("spot and directional lights", [&] {
    room();
    addSolids(4, [&] { return glossy(); });
    for (int i = 0; i < 3; ++i) {
      Light& spot = addLamp();
      makeSpot(spot);
      spot.direction = asFloat(spot.direction * between(0.3, 2));
      if (i == 0) spot.innerConeAngle = 0;
      spot.radius = between(0.01, 2);
      addSun(0.2, 1);
    }
  });
}

TEST_F(Surfaces, Mirrors) {
  expectAgreement("mirrors", {.depth = 10}, [&] {
    room();
    floor(mirror(), 0.1);
    addSolids(3, [&] { return mirror(); });
    hangPane(mirror());
    add(box(), glossy(), placement({1, 1.9, 0.9}, 0.4));
    addLamps(2);
  });
}

// No real surface reflects less than 4 %: below, the lobe fades out at grazing incidence as well.
TEST_F(Surfaces, HighlightsBelowFourPercent) {
  expectAgreement("highlights below 4 %", [&] {
    const auto faint = [&] {
      Material material = matte();
      material.diffuse = material.diffuse * asFloat(0.0625);
      material.specular = color(0.001, 0.039);
      material.roughness = between(0.3, 0.6);
      return material;
    };

    room();
    scene.ambient = {};
    scene.camera.eye.y = 0.6;  // grazing, against the light
    scene.bodies.clear();
    floor(faint());
    addSolids(4, faint);

    for (int i = 0; i < 3; ++i) {
      Light& light = addLamp();
      light.position = inBox({-3, 0.6, -4}, {3, 2, -2});
      light.intensity = color(20, 60);
    }
  });
}

TEST_F(Surfaces, ColorsOfVertices) {
  expectAgreement("vertex colors", [&] {
    room();
    for (int i = 0; i < 4; ++i) {
      Mesh mesh = solid();
      while (mesh.colors.size() < mesh.positions.size()) mesh.colors.push_back(color(0, 1));
      const bool mirrors = chance(0.3);
      add(mesh, mirrors ? mirror() : glossy(), standing(i, 4));
    }
    addLamps(2);
  });
}

TEST_F(Surfaces, Emission) {
  expectAgreement("emission", [&] {
    room();
    addSolids(4, [&] {
      Material material = chance(0.4) ? mirror() : matte();
      material.emission = color(0, 1.5);
      return material;
    });

    Material glowing = matte();
    glowing.emission = color(0.2, 1);
    hangPane(glowing);  // from both sides
    addLamps(1);
  });
}

TEST_F(Surfaces, AmbientLightFromTheSky) {
  expectAgreement("ambient from the sky", [&] {
    room();
    scene.sky.scale = between(0.5, 2);
    scene.ambient.fromSky = between(0.2, 1);
    addSolids(4, [&] { return matte(); });
    addLamps(1);
  });
}

TEST_F(Surfaces, ImagesOfTheSky) {
  expectAgreement("sky images", [&] {
    room();
    skyImage(0, 250);
    scene.sky.scale = between(0.5, 2);
    scene.camera.fov = 80;
    addSolids(4, [&] { return mirror(); });
    addLamps(1);
  });
}

// A ball of large facets that fills the picture, lit from the side: the light ends across it.
TEST_F(Surfaces, ShadowRaysFromAboveTheFacets) {
  const auto facetedBall = [&] {
    room();
    const Transform large = placement({0, 1.3, 0}, 2.4);
    const Mesh sphere = chance(0.5) ? ball(12, 8) : ball(8, 5);
    add(sphere, matte(), large);

    add(box(), matte(), placement({-1.6, 1.9, 0.9}, 0.4));
    for (const double side : {-1.0, 1.0}) {
      addLamp().position = inBox({4, 0.5, -2}, {6, 3, 1}) * Vec{side, 1, 1};
    }
  };

  expectAgreement("--terminator on", {.terminator = true}, facetedBall);
  expectAgreement("--terminator off", facetedBall);
}

TEST_F(Surfaces, TexturesOfNearestAndMixedTexels) {
  const auto textured = [&] {
    room();
    scene.bodies.clear();

    for (int i = 0; i < 2; ++i) addColors(5 + 3 * i, 4);
    for (int i = 0; i < 4; ++i) {
      Material material = glossy();
      material.diffuseMap = i % 2;
      if (i == 1) material.specularMap = 0;
      if (i == 2) {
        material.emission = color(0.2, 1);
        material.emissionMap = 1;
      }

      Transform at;
      at.scale = {9, 1, 9};
      if (i > 0) at = standing(i - 1, 3);
      add(turnedPane(1), material, at);
    }
    addLamps(2);
  };

  expectAgreement("bilinear textures", textured);
  expectAgreement("textures of nearest texels", {.filter = Filter::nearest}, textured);
}

TEST_F(Surfaces, NormalMaps) {
  expectAgreementWithEachFilter("normal maps", [&] {
    room();
    scene.bodies.clear();
    const int map = addNormals(8);
    const auto bumpy = [&](Material material) {
      material.normalMap = map;
      return material;
    };

    Transform ground;
    ground.scale = {9, 1, 9};
    ground.degrees = between(0, 90);
    add(turnedPane(2), bumpy(matte()), ground);
    add(mappedBall(), bumpy(matte()), standing(0, 4));

    Transform facing = standing(1, 4);  // a lobe has no value for a viewer behind it
    facing.axis = {1, 0, 0};
    facing.degrees = between(50, 80);
    add(turnedPane(1), bumpy(glossy()), facing);

    const int twice = addObject(turnedPane(0.7), bumpy(matte()));
    for (int i = 2; i < 4; ++i) {
      Transform at = standing(i, 4);
      at.scale = asFloat(at.scale * color(0.6, 1.5));
      if (i == 3) at.scale.x = -at.scale.x;
      place(twice, at);
    }

    addLamps(2);
  });
}

// In shadows too, and seen in mirrors.
TEST_F(Surfaces, AlphaMasks) {
  const auto masked = [&] {
    room();
    floor(mirror(), 0.05);
    for (int i = 0; i < 4; ++i) {
      Material material = glossy();
      material.alphaMap = addTornMask();
      if (i == 1) material.alphaCutoff = between(0.3, 0.7);
      add(turnedPane(0.7), material, standing(i, 4));
    }
    addLamps(2);
  };

  expectAgreement("alpha masks", masked);
  expectAgreement("alpha masks, nearest texels", {.filter = Filter::nearest}, masked);
}

TEST_F(Surfaces, MixedMipMaps) {
  const Options options{.depth = 6, .filter = Filter::trilinear};
  expectAgreement("trilinear textures", options, [&] { texturedAtAnyDistance(); });
  expectAgreement("trilinear textures, parallel rays", options, [&] {
    texturedAtAnyDistance();
    scene.camera.orthographicHeight = between(2, 8);
  });
}

// Cut and covered in part, with colors that differ where nothing is left.
TEST_F(Surfaces, MixedMipMapsOfMaskedSurfaces) {
  expectAgreement("trilinear textures with masks", {.depth = 6, .filter = Filter::trilinear}, [&] {
    texturedAtAnyDistance();
    for (Material& material : scene.materials) {
      if (material.diffuseMap == kNone && material.emissionMap == kNone) continue;
      if (chance(0.3)) continue;

      const bool isCovered = chance(0.5);
      if (isCovered) material.coverageMap = addTornMask();
      if (!isCovered || chance(0.3)) material.alphaMap = addTornMask();
      material.alphaCutoff = between(0.2, 0.6);
    }
  });
}

TEST_F(Surfaces, Instances) {
  expectAgreement("instances", [&] { addInstances(); });
}

TEST_F(Surfaces, InstancesFarFromTheOrigin) {
  const auto farAway = [&] {
    addInstances();
    moveBy({150, -90, 120});
  };
  expectAgreement("instances far away", {}, farAway, 10);
}

}  // namespace
}  // namespace oracle
