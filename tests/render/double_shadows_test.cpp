// Pictures of packets and of the scalar reference against brute force in double, which tests every
// triangle for every primary ray and shadow ray. Each pixel that differs must have a cause: its
// primary ray or a shadow ray passes an edge, a surface or the border of a mask within rounding.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "inspect/reference_frame.h"
#include "pi.h"
#include "reference/find_intersections.h"
#include "reference/generate_rays.h"
#include "render/random_scenes.h"
#include "render/shipped_scene.h"
#include "sanitized.h"
#include "surfaces/passed_surfaces.h"

namespace whit::test {
namespace {

constexpr double kUlp = 0x1p-24;  // half of one, relative

struct Triangle {
  std::array<Vec3d, 3> corner;
  // The length of the normal is twice the area.
  Vec3d normal;
  double longest = 0;
  std::uint32_t number = 0;
};

struct Segment {
  Vec3d from, to;
  Vec3d way() const { return to - from; }
};

// Returns the least distance between two segments (Ericson 2005, "Real-Time Collision Detection",
// 5.1.9).
double distanceBetween(const Segment& a, const Segment& b) {
  const Vec3d p = a.way(), q = b.way(), r = a.from - b.from;
  const double pp = dot(p, p), qq = dot(q, q), pq = dot(p, q), pr = dot(p, r), qr = dot(q, r);
  const double det = pp * qq - pq * pq;

  double s = det > 0 ? std::clamp((pq * qr - pr * qq) / det, 0.0, 1.0) : 0;
  const double t = qq > 0 ? std::clamp((pq * s + qr) / qq, 0.0, 1.0) : 0;
  s = pp > 0 ? std::clamp((pq * t - pr) / pp, 0.0, 1.0) : 0;
  return length(r + p * s - q * t);
}

struct Found {
  std::size_t triangle = 0;
  double t = 0;
};

class BruteForceInDouble {
 public:
  explicit BruteForceInDouble(const Scene& scene) : scene_(scene) {
    const Geometry& world = scene.geometries[0];
    for (std::uint32_t i = 0; i < world.classBegin[kTriangleClasses]; ++i) {
      Triangle t;
      t.number = world.firstTriangle + i;
      const float* p = scene.triangles[t.number].position;
      for (const auto k : indices(3)) t.corner[k] = {p[3 * k], p[3 * k + 1], p[3 * k + 2]};
      t.normal = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
      for (const Segment& e : edgesOf(t)) t.longest = std::max(t.longest, length(e.way()));
      triangles_.push_back(t);
    }
  }

  // Finds the nearest triangle. Its distance is in lengths of the ray.
  std::optional<Found> nearest(const Segment& ray) const {
    std::optional<Found> found;
    for (const auto i : indices(triangles_)) {
      const std::optional<double> t = meet(triangles_[i], ray);
      if (t && !(found && found->t <= *t)) found = {i, *t};
    }
    return found;
  }

  bool blocked(const Segment& ray, std::size_t self) const {
    for (const auto i : indices(triangles_)) {
      if (i == self) continue;
      const std::optional<double> t = meet(triangles_[i], ray);
      if (t && *t < 1) return true;
    }
    return false;
  }

  // True if rays within `reach` of this one, after rounding, may hit something else than it does.
  // Shadow rays start on `self`.
  bool passesAnEdge(const Segment& ray, double reach, std::size_t self = kNoHit) const {
    for (const auto i : indices(triangles_)) {
      if (i != self && grazes(triangles_[i], ray, reach)) return true;
    }
    return false;
  }

  const Triangle& operator[](std::size_t i) const { return triangles_[i]; }

 private:
  static std::array<Segment, 3> edgesOf(const Triangle& t) {
    return {{{t.corner[0], t.corner[1]}, {t.corner[1], t.corner[2]}, {t.corner[2], t.corner[0]}}};
  }

  // The mask of randomScene() is two texels wide, 1 at u = 1/4 and 0 at u = 3/4, repeated: between
  // them it is linear, and below the cutoff of 1/2 is a hole, for shadow rays as well. `weights`
  // are those of the corners.
  bool isHole(const Triangle& t, const std::array<double, 3>& weights) const {
    const TriangleRecord& record = scene_.triangles[t.number];
    if (scene_.materials[record.material].alphaMap == kNoTexture) return false;

    double u = 0;
    for (const auto k : indices(3)) u += weights[k] * double{record.uv[2 * k]};
    const double fromBlack = u - 0.75 - std::round(u - 0.75);
    return 2 * std::fabs(fromBlack) < 0.5;
  }

  std::optional<double> meet(const Triangle& t, const Segment& ray) const {
    const Vec3d d = ray.way();

    // The signs of these volumes tell on which side of each edge the ray passes.
    std::array<double, 3> side{};
    for (const auto k : indices(3)) {
      side[k] = dot(d, cross(t.corner[k] - ray.from, t.corner[(k + 1) % 3] - ray.from));
    }

    const double sum = side[0] + side[1] + side[2];
    const bool in = (side[0] >= 0 && side[1] >= 0 && side[2] >= 0) ||
                    (side[0] <= 0 && side[1] <= 0 && side[2] <= 0);
    if (!in || sum == 0) return std::nullopt;

    const double distance = dot(t.corner[0] - ray.from, t.normal) / dot(d, t.normal);
    if (!(distance > 0)) return std::nullopt;
    if (isHole(t, {side[1] / sum, side[2] / sum, side[0] / sum})) return std::nullopt;
    return distance;
  }

  bool grazes(const Triangle& t, const Segment& ray, double reach) const {
    double away = 0;
    for (const Vec3d& p : t.corner) away = std::max(away, length(p - ray.from));
    const double near = reach + 16 * kUlp * away;
    for (const Segment& edge : edgesOf(t)) {
      if (distanceBetween(ray, edge) < near) return true;
    }

    // An end of the ray may lie on either side of the surface.
    const Vec3d n = t.normal / length(t.normal);
    for (const Vec3d& end : {ray.from, ray.to}) {
      if (std::fabs(dot(end - t.corner[0], n)) > near) continue;
      if (meet(t, {end - n, end + n})) return true;
    }

    if (scene_.materials[scene_.triangles[t.number].material].alphaMap == kNoTexture) return false;

    // At the border of a mask, rays beside this one may pass where it is blocked.
    const Vec3d d = ray.way();
    const double least = near / std::max(std::fabs(dot(n, d)) / length(d), 0x1p-20);
    const Vec3d x = normalized(cross(d, n)), y = normalized(cross(d, x));

    const bool met = meet(t, ray).has_value();
    for (const Vec3d& aside : {x, -x, y, -y}) {
      const Vec3d moved = aside * least;
      if (meet(t, {ray.from + moved, ray.to + moved}).has_value() != met) return true;
    }
    return false;
  }

  const Scene& scene_;
  std::vector<Triangle> triangles_;
};

// Counts pixels, and those that differ: within rounding of an edge, or without any cause.
struct Tally {
  std::size_t pixels = 0, lit = 0, edges = 0, unknown = 0;
};

class Comparison {
 public:
  Comparison(const Scene& scene, const RenderOptions& options)
      : scene_(scene),
        truth_(scene),
        frame_(makeCameraFrame(chooseCamera(scene, options), options.size->width,
                               options.size->height)) {}

  Tally compare(const Image& image) const {
    Tally tally;
    forEachPixel(image, [&](int x, int y) { add(x, y, double{image.at(x, y).x}, tally); });
    return tally;
  }

 private:
  void add(int x, int y, double value, Tally& tally) const {
    const Ray eye = reference::generateRay(frame_, x + 0.5, y + 0.5);
    const Segment toAll{eye.origin, eye.origin + eye.direction};
    const std::optional<Found> found = truth_.nearest(toAll);
    ++tally.pixels;
    tally.lit += value > 0;

    // A lit pixel beside all triangles needs a cause, too.
    if (!found) {
      if (value > 0) {
        const Segment far{eye.origin, eye.origin + eye.direction * 1e6};
        ++(truth_.passesAnEdge(far, 4 * kUlp) ? tally.edges : tally.unknown);
      }
      return;
    }

    const Triangle& t = truth_[found->triangle];
    const Vec3d p = eye.origin + eye.direction * found->t;
    Vec3d n = normalized(t.normal);
    if (dot(n, eye.direction) > 0) n = -n;

    // Rounding moves the hit's position by `reach` at most, and farther at grazing angles.
    const double cosine = -dot(n, eye.direction);
    const Vec3d sizes = abs(p) + abs(eye.origin);
    const double reach = kUlp * (8 * (sizes.x + sizes.y + sizes.z) + 32 * t.longest +
                                 4 * found->t / std::max(cosine, 1e-6));

    // The surface reflects by Lambert's law the lights that no triangle blocks.
    double expected = 0, tolerance = 0;
    std::vector<Segment> shadowRays;
    for (const Light& light : scene_.lights) {
      const bool directional = light.kind == Light::Kind::directional;
      const Vec3d way = towards(light, p);

      const Segment ray{p + n * (1e-13 * reach / kUlp), p + way * (directional ? 1e6 : 1.0)};
      const double distance2 = directional ? 1 : std::max(dot(way, way), 1e-4);
      const double most = double{light.intensity.x} / distance2 * 0.8 / kPi;
      tolerance += most * (2e-3 + 4 * reach / std::sqrt(distance2));
      const double facing = dot(n, normalized(way));
      if (facing < 1e-3) continue;
      shadowRays.push_back(ray);
      if (!truth_.blocked(ray, found->triangle)) expected += most * facing;
    }
    if (std::fabs(value - expected) <= tolerance) return;

    const bool atEdge = truth_.passesAnEdge({eye.origin, p}, reach) ||
                        std::ranges::any_of(shadowRays, [&](const Segment& ray) {
                          return truth_.passesAnEdge(ray, reach, found->triangle);
                        });
    ++(atEdge ? tally.edges : tally.unknown);
    if (!atEdge) {
      std::printf("pixel %d,%d: %g for %g, triangle %u\n", x, y, value, expected, t.number);
    }
  }

  const Scene& scene_;
  BruteForceInDouble truth_;
  CameraFrame frame_;
};

// These kinds of randomScene() have pixels within rounding of an edge: needles, scenes far from the
// origin, and huge triangles.
std::size_t mostAtEdges(unsigned kind, std::size_t pixels) {
  if (kind == 1) return pixels / 200;
  if (kind == 5) return pixels / 20;
  return kind == 9 ? 4 : 0;
}

TEST(DoubleShadows, H92_differOnlyWithinRoundingOfAnEdge) {
  RenderOptions options;
  options.size = ImageSize{80, 60};
  options.threads = 2;
  constexpr unsigned kSeeds = kSanitized ? 1 : 4;
  std::size_t pixels = 0, lit = 0;
  for (unsigned kind = 0; kind < kRandomKinds; ++kind) {
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      SCOPED_TRACE(testing::Message() << "kind " << kind << ", seed " << seed);
      const Scene scene = randomScene(kind, seed);
      const auto [packets, reference] = renderBoth(scene, options);

      const Comparison comparison(scene, options);
      for (const Film* film : {&packets, &reference}) {
        const Tally t = comparison.compare(film->image);
        EXPECT_EQ(t.unknown, 0u);
        EXPECT_LE(t.edges, mostAtEdges(kind, t.pixels));
        pixels += t.pixels;
        lit += t.lit;
      }
    }
  }

  EXPECT_GT(lit, pixels / 10);
}

}  // namespace
}  // namespace whit::test
