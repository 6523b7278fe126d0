// Random small pictures that use everything at once: meshes whose normals and texture coordinates
// do not fit, materials, lights, skies and cameras with any members, and any options.
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <string>

#include "core/options.h"
#include "render/frame.h"
#include "scene/description.h"

namespace whit::fuzz {

// Draws numbers from bytes and, when these have run out, from a generator that they seed. The bytes
// of a fuzzer steer all choices, and few bytes make a whole picture.
class Draws {
 public:
  explicit Draws(std::span<const std::uint8_t> bytes);

  std::size_t below(std::size_t limit) { return next() % limit; }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  double uniform(double low, double high) { return low + (high - low) * (next() * 0x1p-32); }
  // A number from `low` to `high`: often an end of the range, 0 or 1, else moderate or of any size.
  double number(double low, double high);

 private:
  std::uint32_t next();

  std::span<const std::uint8_t> left_;
  std::mt19937 random_;
};

struct RandomPicture {
  SceneDescription scene;
  RenderOptions options;
};

RandomPicture drawPicture(Draws& draws);

// The bytes of the picture with this number, the same on every machine.
std::array<std::uint8_t, 4> bytesOfPicture(std::uint32_t number);

// Renders the picture that the bytes stand for on a SIMD target (--simd). Returns false if it was
// refused, by an Error that a bad scene or bad options may cause. Other exceptions are findings.
bool renderPicture(std::span<const std::uint8_t> bytes, const std::string& simd,
                   FrameStats* stats = nullptr);

}  // namespace whit::fuzz
