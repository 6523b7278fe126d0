// Meshes and images that a program hands over, which a scene's text names in place of files.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>

#include "io/image/image_file.h"
#include "scene/mesh.h"

namespace whit {

// A mesh as arrays. They are read whenever the scene is read, and live for as long as `keep`.
struct GivenMesh {
  std::span<const float> positions;  // x, y, z of each vertex
  std::span<const float> normals;    // empty (flat shading), or x, y, z of each vertex
  std::span<const float> uvs;        // empty (0, 0), or u, v of each vertex; v points up
  std::span<const float> colors;     // empty (white), or r, g, b of each vertex, linear, 0 to 1
  // Three vertices a triangle, counter-clockwise seen from outside; empty: the vertices in threes.
  std::span<const std::uint32_t> triangles;
  std::shared_ptr<const void> keep;
};

// An image of 1 to 4 interleaved channels, in rows from the top: codes of 8 bits, or linear values.
struct GivenImage {
  int width = 0, height = 0, channels = 0;
  std::span<const std::uint8_t> codes;
  std::span<const float> values;
  std::shared_ptr<const void> keep;

  std::size_t bytes() const { return codes.size_bytes() + values.size_bytes(); }
};

// Meshes and images by the names under which the text refers to them: {"mesh": "bunny"} in place of
// {"model": "bunny.ply"},
// {"array": "wood"} in place of {"image": "wood.png"}.
struct SceneParts {
  std::map<std::string, GivenMesh> meshes;
  std::map<std::string, GivenImage> images;
};

// Each throws Error(badScene) at `where` for arrays whose lengths do not fit together, for numbers
// that are not finite or out of their range, and for triangles with vertices that do not exist.
Mesh meshOf(const GivenMesh& given, const std::string& where);
RawImage imageOf(const GivenImage& given, const std::string& where);

}  // namespace whit
