// Deterministic noise for shapes and patterns: integer hashes, so that every machine generates the
// same scene, and lattice gradient noise that may repeat (Perlin, "Improving Noise", 2002).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace whit::procedural {

// Returns a well-mixed hash of lattice coordinates as a number in [0, 1).
double unitHash(std::uint32_t seed, std::int32_t x, std::int32_t y = 0, std::int32_t z = 0);

// Returns smooth noise in about [-1, 1], zero at lattice points. A `period` above zero repeats the
// lattice after that many cells along x and y.
double gradientNoise(std::uint32_t seed, double x, double y, int period = 0);
double gradientNoise3(std::uint32_t seed, double x, double y, double z);

// The cell of the lattice in which the last point lay. Most points lie in the cell of the point
// before, so that the slopes at its corners are hashed once.
class NoiseCell {
 public:
  // Returns gradientNoise().
  double at(std::uint32_t seed, double x, double y, int period);

 private:
  void enter(std::uint32_t seed, std::int32_t x, std::int32_t y, int period);

  bool isKnown_ = false;
  std::uint32_t seed_ = 0;
  std::int32_t x_ = 0, y_ = 0;
  double slopes_[4][2] = {};  // along x and y, at the corners (0, 0), (1, 0), (0, 1) and (1, 1)
};

// Returns the sum of `octaves` noises, each of twice the frequency and half the amplitude of the
// one before, scaled to about [-1, 1]. A period is that of the first octave.
double fractalNoise(std::uint32_t seed, double x, double y, int octaves, int period = 0);

// The same for many points, with a cell for each octave.
class FractalNoise {
 public:
  explicit FractalNoise(int octaves, int period = 0)
      : octaves_(static_cast<std::size_t>(octaves)), period_(period) {}
  double operator()(std::uint32_t seed, double x, double y);

 private:
  static constexpr std::size_t kMostOctaves = 12;
  std::size_t octaves_;
  int period_;
  std::array<NoiseCell, kMostOctaves> cells_;
};

// Like fractalNoise, but folded at zero into sharp crests: about [0, 1], 1 on the crests (Musgrave,
// "Texturing and Modeling", ch. 16).
double ridgedNoise(std::uint32_t seed, double x, double y, int octaves);

double lerp(double a, double b, double t);
// Returns 0 below `low`, 1 above `high`, and a smooth transition between.
double smoothStep(double low, double high, double x);

// A stream of numbers in [0, 1) for things that are generated one after the other.
class RandomStream {
 public:
  explicit RandomStream(std::uint32_t seed) : seed_(seed) {}
  double next() {
    const std::uint64_t k = count_++;
    return unitHash(seed_, static_cast<std::int32_t>(k & 0x7fffffffu),
                    static_cast<std::int32_t>(k >> 31));
  }
  double between(double low, double high) { return low + (high - low) * next(); }

 private:
  std::uint32_t seed_;
  std::uint64_t count_ = 0;
};

}  // namespace whit::procedural
