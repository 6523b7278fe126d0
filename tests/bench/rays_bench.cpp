// Times the ray queries of whit.h against Embree's own calls for the same rays, alternately:
//   build/tests/rays_bench [SCENE [TURNS]]
// The rays are of random directions from random points of the scene's box, which Embree traces one
// by one, and those of a lidar at one point, which it traces in packets of 16. The queries' time
// goes from arrays to all columns of hits; Embree's includes the writing of its rays, and only the
// distances are kept.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "accel/embree_scene.h"
#include "core/index.h"
#include "core/machine_limits.h"
#include "core/worker_pool.h"
#include "io/load_scene.h"
#include "library/whit.h"

namespace {

using whit::Vec3d;
using whit::Vec3f;

// A row is a multiple of a packet.
constexpr std::size_t kSide = 1024, kRays = kSide * kSide, kWidth = 16;
constexpr unsigned kNone = RTC_INVALID_GEOMETRY_ID;

struct Arrays {
  std::vector<Vec3f> origins, directions;
  void add(const Vec3d& origin, const Vec3d& direction) {
    origins.emplace_back(origin);
    directions.emplace_back(direction);
  }
};

// The numbers of vectors that lie one behind the other.
std::span<const float> numbersOf(const std::vector<Vec3f>& vectors) {
  return {&vectors[0].x, 3 * vectors.size()};
}

Arrays randomRays(const Vec3d& low, const Vec3d& size) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> way;
  Arrays rays;
  while (rays.origins.size() < kRays) {
    const Vec3d at{share(random), share(random), share(random)};
    rays.add(low + size * at, {way(random), way(random), way(random)});
  }
  return rays;
}

Arrays lidarRays(const Vec3d& low, const Vec3d& size) {
  Arrays rays;
  for (const auto i : whit::indices(kRays)) {
    const double elevation = double(i / kSide) / kSide - 0.5;
    const double azimuth = 6.283185307179586 * (double(i % kSide) + 0.3) / kSide;
    rays.add(low + size * Vec3d{0.51, 0.31, 0.52},
             {std::cos(elevation) * std::cos(azimuth), std::sin(elevation),
              std::cos(elevation) * std::sin(azimuth)});
  }
  return rays;
}

std::vector<float> traceOneByOne(const whit::EmbreeScene& scene, const Arrays& rays, int threads) {
  std::vector<float> t(kRays);
  whit::parallelFor(threads, kSide, [&](std::size_t row, int) {
    whit::QueryContext context(false);
    for (std::size_t i = row * kSide; i < (row + 1) * kSide; ++i) {
      const Vec3f &o = rays.origins[i], &d = rays.directions[i];
      RTCRayHit hit{};
      hit.ray = {o.x, o.y, o.z, 0, d.x, d.y, d.z, 0, INFINITY, ~0u, 0, 0};
      hit.hit.geomID = hit.hit.instID[0] = kNone;

      context.setRay(o, d);
      context.trace(scene.top(), hit);
      t[i] = hit.ray.tfar;
    }
  });
  return t;
}

struct VectorColumns {
  const float *x, *y, *z;
};
struct PacketColumns {
  VectorColumns org, dir;
};

std::vector<float> traceInPackets(const whit::EmbreeScene& scene, const Arrays& rays, int threads) {
  std::vector<float> t(kRays);
  whit::parallelFor(threads, kSide, [&](std::size_t row, int) {
    whit::QueryContext context(true);
    for (std::size_t first = row * kSide; first < (row + 1) * kSide; first += kWidth) {
      alignas(64) RTCRayHit16 packet{};
      alignas(64) int live[kWidth];
      auto& ray = packet.ray;

      for (std::size_t k = 0; k < kWidth; ++k) {
        live[k] = -1;
        const Vec3f &o = rays.origins[first + k], &d = rays.directions[first + k];
        ray.org_x[k] = o.x;
        ray.org_y[k] = o.y;
        ray.org_z[k] = o.z;
        ray.dir_x[k] = d.x;
        ray.dir_y[k] = d.y;
        ray.dir_z[k] = d.z;
        ray.tfar[k] = INFINITY;
        ray.mask[k] = ~0u;
        ray.id[k] = static_cast<unsigned>(k);
        packet.hit.geomID[k] = packet.hit.instID[0][k] = kNone;
      }

      context.setRays(
          PacketColumns{{ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}});
      context.trace(scene.top(), packet, live);
      std::ranges::copy(ray.tfar, &t[first]);
    }
  });
  return t;
}

double medianOf(std::vector<double>& values) {
  std::ranges::nth_element(values, values.begin() + std::ssize(values) / 2);
  return values[values.size() / 2];
}

double secondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  const char* const name = argc > 1 ? argv[1] : "sponza-mirror";
  const int turns = argc > 2 ? std::atoi(argv[2]) : 9, threads = whit::usableThreads();
  whit::Warnings warnings;
  const whit::Scene scene = whit::Scene::finalize(whit::loadScene(name, {}, warnings), warnings);
  const whit::EmbreeScene embree(scene, whit::RenderOptions(), whit::EffectSet::all(), threads,
                                 nullptr);
  whit::api::Renderer renderer(whit::api::loadScene(name));
  const Vec3d low(scene.lower), size = Vec3d(scene.upper) - low;

  for (const bool lidar : {false, true}) {
    const Arrays rays = lidar ? lidarRays(low, size) : randomRays(low, size);
    const whit::api::Rays asked{{numbersOf(rays.origins), {}}, {numbersOf(rays.directions), {}}};
    whit::api::RayHits hits = renderer.closest(asked);
    std::vector<float> t;
    std::vector<double> ours, ratios, occluded;

    // Both are timed alternately, so that a change of the machine's speed affects both.
    for (int turn = 0; turn < turns; ++turn) {
      const double own = secondsOf([&] { hits = renderer.closest(asked); });
      const double theirs = secondsOf([&] {
        t = lidar ? traceInPackets(embree, rays, threads) : traceOneByOne(embree, rays, threads);
      });
      occluded.push_back(secondsOf([&] { renderer.occluded(asked); }));
      ours.push_back(own);
      ratios.push_back(own / theirs);
    }

    // Rays that pass an edge within rounding are not certain. All others must have Embree's
    // distance.
    std::size_t apart = 0, open = 0;
    for (const auto i : whit::indices(kRays)) {
      const bool isApart = std::isfinite(t[i]) != std::isfinite(hits.t[i]) ||
                           std::abs(double{t[i]} - hits.t[i]) > 1e-4 * hits.t[i];
      open += hits.certain[i] == 0;
      apart += hits.certain[i] != 0 && isApart;
    }

    std::printf(
        "%s, %s: closest %.2f, occluded %.2f Mray/s with %d threads; %.2f of Embree's time; "
        "%zu not certain, %zu certain ones differ from Embree's\n",
        name, lidar ? "lidar" : "random", kRays / medianOf(ours) / 1e6,
        kRays / medianOf(occluded) / 1e6, threads, medianOf(ratios), open, apart);
  }
}
