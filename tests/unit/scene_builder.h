// Small scene descriptions for tests.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "bake/scene.h"
#include "core/error.h"
#include "has_text.h"

namespace whit::test {

// Returns the unit square in the plane z = 0, seen from +z, with the triangles (0, 1, 2) and (0, 2,
// 3).
inline Mesh square() {
  Mesh mesh;
  mesh.name = "square";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.materials = {0};
  return mesh;
}

// Returns a scene whose only object, used once, has these meshes with a plain gray material.
template <typename... Meshes>
SceneDescription sceneOf(const Meshes&... meshes) {
  SceneDescription d;
  d.name = "test";
  d.materials.resize(1);
  d.materials[0].name = "gray";
  d.objects.push_back({"object", {meshes...}});
  d.instances.push_back({0, Affine{}});
  return d;
}

// Returns a scene like sceneOf() that is placed by this transform.
inline SceneDescription placedAs(const Mesh& mesh, const Affine& toWorld) {
  SceneDescription d = sceneOf(mesh);
  d.instances[0].toWorld = toWorld;
  return d;
}

// Returns the mesh higher up by 1.
inline Mesh above(Mesh mesh) {
  for (Vec3f& p : mesh.positions) p.z += 1;
  return mesh;
}

// Collects what was repaired in `warnings`, if they are given.
inline Scene finalized(SceneDescription d, Warnings* warnings = nullptr) {
  Warnings own;
  return Scene::finalize(std::move(d), warnings ? *warnings : own);
}

inline Scene finalized(const Mesh& mesh, Warnings* warnings = nullptr) {
  return finalized(sceneOf(mesh), warnings);
}

inline Texture whiteTexture(TexelFormat format) {
  Texture t;
  t.name = "white";
  t.format = format;
  t.texels = {0xffffffffu};
  return t;
}

// Each function returns corner i of a triangle, the normal by its winding, or the normal at corner
// i.
inline Vec3d corner(const TriangleRecord& t, int i) {
  return {t.position[3 * i], t.position[3 * i + 1], t.position[3 * i + 2]};
}
inline Vec3d faceOf(const TriangleRecord& t) {
  return normalized(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
}
inline Vec3f normalOf(const NormalRecord& n, int i) {
  return {n.normal[3 * i], n.normal[3 * i + 1], n.normal[3 * i + 2]};
}

// Returns how often something of this kind was repaired.
inline std::uint64_t warned(const Warnings& warnings, const std::string& kind) {
  const auto entries = warnings.entries();
  return entries.contains(kind) ? entries.at(kind).count : 0;
}

// Expects an Error of this status whose text contains all `parts`.
template <typename Action>
void expectError(ExitStatus status, const std::vector<std::string>& parts, const Action& action) {
  try {
    action();
    ADD_FAILURE() << "expected an error";
  } catch (const Error& e) {
    EXPECT_EQ(e.status(), status) << e.what();
    for (const std::string& part : parts) EXPECT_TRUE(hasText(e.what(), part));
  }
}

}  // namespace whit::test
