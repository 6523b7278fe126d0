// Damaged versions of files, the same for the same seed on every machine.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

namespace whit::fuzz {

using Bytes = std::vector<std::uint8_t>;

// Returns the bytes cut short (seeds divisible by 4), or with one to eight of their bits flipped, a
// third of them within the first 256 bytes, where headers are.
inline Bytes damaged(Bytes bytes, std::uint32_t seed) {
  if (bytes.empty()) return bytes;

  std::mt19937 random(seed);
  const auto below = [&](std::size_t limit) { return random() % limit; };
  if (seed % 4 == 0) {
    bytes.resize(below(bytes.size()));
    return bytes;
  }
  for (std::size_t flips = 1 + below(8); flips > 0; --flips) {
    const bool inHeader = below(3) == 0;
    const std::size_t at =
        below(inHeader ? std::min<std::size_t>(bytes.size(), 256) : bytes.size());
    bytes[at] = std::uint8_t(bytes[at] ^ 1u << below(8));
  }
  return bytes;
}

}  // namespace whit::fuzz
