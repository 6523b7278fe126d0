// Random numbers of paths. Each path of rays has a number that follows from its pixel, its sample
// and the branches that it took, and from nothing else: so the picture's noise does not depend on
// who traces which ray when, and kernels and reference see the same. Directions are drawn by them.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/vec3.h"

namespace whit {

// The finalizer of MurmurHash3 (Appleby 2011): a bijection in which every bit of the argument flips
// each bit of the result about half of the time.
inline constexpr std::uint32_t kMixFirst = 0x85ebca6bu, kMixSecond = 0xc2b2ae35u;
constexpr std::uint32_t mixed(std::uint32_t x) {
  x = (x ^ (x >> 16)) * kMixFirst;
  x = (x ^ (x >> 13)) * kMixSecond;
  return x ^ (x >> 16);
}

// Returns the number of a camera ray's path. `pixel` is packed (core/image.h), and `sample` is the
// place of the ray's sample in the sample pattern. The numbers of a pixel's samples are equal steps
// apart. Frames of different seeds have different noise; pictures have seed 0.
inline constexpr std::uint32_t kPixelSalt = 0x9e3779b9u, kSampleStep = 0x6d2b79f5u;
constexpr std::uint32_t pixelSalt(std::uint32_t seed) { return kPixelSalt ^ mixed(seed); }
constexpr std::uint32_t streamOfPixel(std::uint32_t pixel, std::uint32_t sample,
                                      std::uint32_t seed = 0) {
  return mixed(pixel + pixelSalt(seed)) + sample * kSampleStep;
}

// Returns the number of a child's path. The branches are the mirrored ray, the refracted ray, and
// then the samples of lobes (stages/lobes.h).
inline constexpr std::uint32_t kMirroredBranch = 1, kRefractedBranch = 2;
inline constexpr std::uint32_t kBranchStep = 0x3c6ef35fu;
constexpr std::uint32_t childStream(std::uint32_t path, std::uint32_t branch) {
  return mixed(path ^ (branch * kBranchStep));
}

// A point in [0, 1)^2. Its coordinates are multiples of 2^-24, so that they are the same in float
// and in double.
struct UnitPoint {
  float u = 0, v = 0;
};

// The steps of a lattice from one point to the next, in units of 2^-32.
struct Lattice {
  std::uint32_t u, v;
};
// The lattice of lobes is that of the plastic number (Roberts 2018, "The unreasonable effectiveness
// of quasirandom sequences").
inline constexpr Lattice kLobeLattice{3242174889u, 2447445414u};
// The facets of a glossy lobe need another one: what they reflect is missing for the diffuse color,
// and points of one lattice would pair the same facets with the same lights in every sample of a
// pixel. It is that of the supergolden ratio, the root of x^3 = x^2 + 1, which is nearly as even.
inline constexpr Lattice kFacetLattice{2930575603u, 1999613215u};
// A lens needs another one, or the place on the lens would decide what a lobe of the first surface
// draws: the fractions of the square roots of 3 and 7. By itself, and with the samples of a pixel,
// it is as even as the other.
inline constexpr Lattice kLensLattice{3144134277u, 2773480762u};

// How the lobe of a surfel is sampled: `count` points of a lattice, from the point `first` on, that
// is shifted at random from path to path. The samples of a pixel share the shift where they meet
// the first surface, so that all their points together are one longer lattice.
struct LobeSampling {
  std::uint32_t count = 1;
  std::uint32_t first = 0;
  std::uint32_t unshift = 0;  // what the paths of a pixel's samples differ by
  Lattice lattice = kLobeLattice;
};

// Surfels that the eye sees directly have `wanted` samples. Deeper surfels have one, because the
// number of rays would otherwise grow exponentially with depth.
constexpr LobeSampling lobeSampling(int depth, int wanted, std::uint32_t sample) {
  if (depth > 0) return {};
  const auto count = static_cast<std::uint32_t>(wanted);
  return {count, sample * count, sample * kSampleStep};
}

// Returns point k of the surfel that `path` has led to.
inline constexpr std::uint32_t kSecondShift = 0x68bc21ebu;
constexpr UnitPoint lobePoint(std::uint32_t path, const LobeSampling& sampling, std::uint32_t k) {
  const std::uint32_t shift = path - sampling.unshift, index = sampling.first + k;

  // Integers in units of 2^-32 wrap around at 1, the period of the lattice.
  const std::uint32_t u = shift + index * sampling.lattice.u;
  const std::uint32_t v = mixed(shift ^ kSecondShift) + index * sampling.lattice.v;
  return {static_cast<float>(u >> 8) * 0x1p-24f, static_cast<float>(v >> 8) * 0x1p-24f};
}

// The sampling of a light with a radius at any depth: all samples of the light belong to one
// surfel.
constexpr LobeSampling lightSampling(int depth, std::uint32_t count, std::uint32_t sample) {
  return depth > 0 ? LobeSampling{count, 0, 0}
                   : LobeSampling{count, sample * count, sample * kSampleStep};
}

// The sampling of the lens by a sample of a pixel.
constexpr LobeSampling lensSampling(std::uint32_t sample) {
  return {1, sample, sample * kSampleStep, kLensLattice};
}

// Returns point k of a lattice that the salt makes independent of the path's other lattices.
constexpr UnitPoint saltedPoint(std::uint32_t path, const LobeSampling& sampling,
                                std::uint32_t salt, std::uint32_t k) {
  LobeSampling own = sampling;
  own.unshift = 0;
  return lobePoint(mixed((path - sampling.unshift) ^ salt), own, k);
}

// Returns point k of a light.
inline constexpr std::uint32_t kLightStep = 0x7feb352du;
constexpr std::uint32_t lightSalt(std::uint32_t light) { return (light + 1) * kLightStep; }
constexpr UnitPoint lightPoint(std::uint32_t path, const LobeSampling& sampling,
                               std::uint32_t light, std::uint32_t k) {
  return saltedPoint(path, sampling, lightSalt(light), k);
}

// Returns a number of the path in [0, 1), a multiple of 2^-24.
constexpr float pathDraw(std::uint32_t path, std::uint32_t salt) {
  return static_cast<float>(mixed(path ^ salt) >> 8) * 0x1p-24f;
}

// Russian roulette (Arvo and Kirk 1990, "Particle transport and image synthesis"): an impulse whose
// contribution x is below the option's X survives with the probability x / X, if this number of its
// path, in [0, 1), times X is less than x; it then counts for X instead.
inline constexpr std::uint32_t kRouletteSalt = 0x14057b7eu;
constexpr float rouletteDraw(std::uint32_t path) { return pathDraw(path, kRouletteSalt); }

// The frame about a normal begins with the x axis, or where the normal's own x is this large or
// larger with the y axis. Normals that differ by rounding have to get directions that differ by no
// more: few surfaces are turned by just this.
inline constexpr float kFrameAlongY = 0.55f;

// Returns the unit direction at `at`, of density cosine / pi by solid angle (Malley's method:
// Pharr, Jakob and Humphreys 2023, "Physically Based Rendering", section A.5.3). It never lies in
// the plane of the unit normal: its cosine is at least 2^-12.
inline Vec3d cosineDirection(const Vec3d& normal, const UnitPoint& at) {
  const Vec3d axis = std::fabs(normal.x) < double{kFrameAlongY} ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d x = normalized(cross(normal, axis)), y = cross(normal, x);

  // A point that is uniform on the unit disc, with a squared radius of v, is projected up to the
  // hemisphere.
  const double turn = 2 * std::numbers::pi * double{at.u}, sine2 = double{at.v};
  const double sine = std::sqrt(sine2), cosine = std::sqrt(1 - sine2);
  return normalized(x * (sine * std::cos(turn)) + y * (sine * std::sin(turn)) + normal * cosine);
}

}  // namespace whit
