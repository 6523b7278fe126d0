// Small scene descriptions for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "bake/scene.h"
#include "core/error.h"

namespace whit::test {

// The unit square in the plane z = 0, seen from +z: triangles (0, 1, 2) and (0, 2, 3).
inline Mesh square() {
  Mesh mesh;
  mesh.name = "square";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials = {0};
  return mesh;
}

// `mesh` as the only object, once, with a plain gray material.
inline SceneDescription sceneOf(Mesh mesh) {
  SceneDescription d;
  d.name = "test";
  d.materials.resize(1);
  d.materials[0].name = "gray";
  d.objects.push_back({"object", {std::move(mesh)}});
  d.instances.push_back({0, Affine{}});
  return d;
}

inline Scene finalized(SceneDescription d) {
  Warnings warnings;
  return Scene::finalize(std::move(d), warnings);
}

inline Texture whiteTexture(TexelFormat format) {
  Texture t;
  t.name = "white";
  t.format = format;
  t.texels = {0xffffffffu};
  return t;
}

// Corner i of a triangle, and the normal by its winding.
inline Vec3d corner(const TriangleRecord& t, int i) {
  return {t.position[3 * i], t.position[3 * i + 1], t.position[3 * i + 2]};
}
inline Vec3d faceOf(const TriangleRecord& t) {
  return normalized(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
}
inline Vec3f normalOf(const NormalRecord& n, int i) {
  return {n.normal[3 * i], n.normal[3 * i + 1], n.normal[3 * i + 2]};
}

// How often something of that kind was repaired.
inline std::uint64_t warned(const Warnings& warnings, const std::string& kind) {
  const auto entries = warnings.entries();
  return entries.contains(kind) ? entries.at(kind).count : 0;
}

// Expects an Error of that status whose text has all of `parts`.
template <typename Action>
void expectError(ExitStatus status, const std::vector<std::string>& parts, const Action& action) {
  try {
    action();
    ADD_FAILURE() << "expected an error";
  } catch (const Error& e) {
    EXPECT_EQ(e.status(), status) << e.what();
    for (const std::string& part : parts) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos)
          << "'" << e.what() << "' lacks '" << part << "'";
    }
  }
}

}  // namespace whit::test
