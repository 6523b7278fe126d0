// Strips of triangles, as glTF and PLY have them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace whit {

using Corners = std::array<std::uint32_t, 3>;

// Strips and fans join their parts by triangles that have a corner twice: nothing is to be seen of
// those.
inline void addJoined(const Corners& corners, std::vector<Corners>& to) {
  const auto& [a, b, c] = corners;
  if (a != b && b != c && c != a) to.push_back(corners);
}

// Every other triangle the other way round, so that all face the same side.
inline void addStrip(std::span<const std::uint32_t> corners, std::vector<Corners>& to) {
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    addJoined({corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]}, to);
  }
}

}  // namespace whit
