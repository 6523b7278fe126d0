// How a model is shown: from which side, or from where in a room.
#include "make/model_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <vector>

#include "core/index.h"
#include "core/vec3.h"
#include "make/placed_triangles.h"

namespace whit {
namespace {

// A model of more triangles is never taken for a room.
constexpr std::uint64_t kMostOfRoom = 1'000'000;

// Directions towards the eye, the most usual first. The front is +z.
constexpr std::array<Vec3d, 7> kSides{{{0.5, 0.4, 1.0},
                                       {-0.5, 0.4, 1.0},
                                       {0.4, 0.9, 0.9},
                                       {1.0, 0.4, 0.5},
                                       {-1.0, 0.4, 0.5},
                                       {-0.5, 0.4, -1.0},
                                       {0.3, 1.5, 0.5}}};
// A more usual side is preferred if it shows this share of what the best side shows.
constexpr double kEnough = 0.6;

using Bounds = BoxOf<Vec3d>;

// Finds the side to which fronts turn the largest area, occluded or not.
Vec3d bestSide(const SceneDescription& scene, double radius) {
  std::array<Vec3d, kSides.size()> sides;
  std::ranges::transform(kSides, sides.begin(), [](const Vec3d& side) { return normalized(side); });

  // shown[i] sums twice the area of fronts as it appears from side i, in squared radii.
  std::array<double, kSides.size()> shown{};
  forEachPlacedTriangle(scene, kMostLookedAt, [&](const Corners& t) {
    const Vec3d area = cross((t[1] - t[0]) / radius, (t[2] - t[0]) / radius);
    for (const auto i : indices(sides)) {
      shown[i] += std::max(0.0, dot(area, sides[i]));
    }
  });

  const double most = *std::ranges::max_element(shown);
  const auto isSingleSided = [](const Material& m) { return !m.doubleSided; };
  if (most == 0 && std::ranges::any_of(scene.materials, isSingleSided)) {
    return normalized(Vec3d{0.3, -1.5, 0.5});  // all fronts look down, and there is nothing above
  }

  // Sides are in order of preference, so the first one that shows enough is chosen.
  const double enough = kEnough * most;
  const auto found = std::ranges::find_if(shown, [&](double area) { return area >= enough; });
  return sides[found - shown.begin()];
}

// A sum of angles between -pi and pi, each given by its cosine and sine times any factor. The sum
// is the argument of a product of complex numbers plus whole turns, which is faster than to take
// the arc tangent of every angle.
class AngleSum {
 public:
  void add(double cosine, double sine) {
    const double re = re_ * cosine - im_ * sine, im = re_ * sine + im_ * cosine;
    // The argument leaves (-pi, pi] where both angles turn the same way and their sum the other
    // way.
    if (im_ >= 0 && sine > 0 && im < 0) ++turns_;
    if (im_ < 0 && sine < 0 && im >= 0) --turns_;

    // Only the direction counts; the length neither grows nor vanishes.
    const double scale = 1 / (std::abs(re) + std::abs(im));
    re_ = re * scale;
    im_ = im * scale;
  }
  double radians() const { return std::atan2(im_, re_) + 2 * std::numbers::pi * turns_; }

 private:
  double re_ = 1, im_ = 0;
  int turns_ = 0;
};

// True if the surfaces around the point are walls of a room with a few small openings at most. The
// winding number is 1 in a body, -1 in a room whose walls' fronts look inwards, and 0 outside
// (solid angles after van Oosterom and Strackee 1983).
bool isInRoom(const SceneDescription& scene, const Vec3d& point) {
  constexpr double kFlat = 1.0e-12, kClosed = -0.9;

  AngleSum halves;  // sums half of each solid angle
  forEachPlacedTriangle(scene, kMostLookedAt, [&](const Corners& t) {
    const Vec3d a = t[0] - point, b = t[1] - point, c = t[2] - point;
    const double la = length(a), lb = length(b), lc = length(c);

    // The solid angle of a triangle is positive if the point lies behind its front.
    const double volume = dot(a, cross(b, c)), space = la * lb * lc;
    if (!(std::abs(volume) > kFlat * space)) return;  // the point lies in the triangle's plane
    halves.add(space + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb, volume);
  });
  return halves.radians() / (2 * std::numbers::pi) <= kClosed;
}

// True for a single mesh to which its file gives no material.
bool isBareMesh(const SceneDescription& scene) {
  if (scene.instances.size() != 1) return false;

  const std::vector<Mesh>& meshes = scene.objects[scene.instances[0].object].meshes;
  return meshes.size() == 1 && std::ranges::all_of(meshes[0].materials, [&](std::uint32_t m) {
           return m < scene.materials.size() && scene.materials[m].name == kNoMaterialName;
         });
}

bool hasSeveralMaterials(const SceneDescription& scene) {
  std::set<std::uint32_t> used;
  for (const Object& object : scene.objects) {
    for (const Mesh& mesh : object.meshes) {
      used.insert(mesh.materials.begin(), mesh.materials.end());
    }
  }
  return used.size() > 1;
}

// The area, in the space of each mesh, of triangles whose vertex normals are on the side of their
// fronts, less the area of those whose normals are on the other side. It is 0 without normals.
double areaWithNormals(const SceneDescription& scene) {
  double sum = 0;
  for (const Object& object : scene.objects) {
    for (const Mesh& mesh : object.meshes) {
      if (mesh.hasMadeNormals) continue;  // they say nothing that the faces do not say
      for (const auto& t : mesh.triangles) {
        // Meshes may lack normals, and indices are not validated yet.
        if (std::ranges::max(t) >= std::min(mesh.normals.size(), mesh.positions.size())) continue;

        const auto p = [&](std::size_t i) { return Vec3d(mesh.positions[t[i]]); };
        const auto n = [&](std::size_t i) { return Vec3d(mesh.normals[t[i]]); };

        const Vec3d twice = cross(p(1) - p(0), p(2) - p(0));
        const double side = dot(twice, n(0) + n(1) + n(2));
        if (side != 0 && std::isfinite(side)) sum += std::copysign(length(twice), side);
      }
    }
  }
  return sum;
}

// True if the six planes that hold most of the triangles' area hold half as much as the bounding
// box has: they are floor, ceiling and walls.
bool hasFlatWalls(const SceneDescription& scene, const Bounds& bounds) {
  constexpr double kSteps = 64, kShare = 0.5;
  constexpr std::size_t kWalls = 6;
  const Vec3d center = bounds.center(), size = bounds.half() * 2.0;
  const double scale = kSteps / length(size);

  // Planes are told apart by their normals and distances, rounded.
  std::map<std::array<long, 4>, double> planes;
  forEachPlacedTriangle(scene, kMostOfRoom, [&](const Corners& t) {
    const Vec3d twice = cross(t[1] - t[0], t[2] - t[0]), normal = normalized(twice);
    const Vec3d n = normal * kSteps;
    const double distance = dot(normal, t[0] - center) * scale;
    planes[{std::lround(n.x), std::lround(n.y), std::lround(n.z), std::lround(distance)}] +=
        length(twice) / 2;
  });

  // The largest planes are compared with the six faces of the bounding box.
  std::vector<double> areas;
  areas.reserve(planes.size());
  for (const auto& [plane, area] : planes) areas.push_back(area);
  std::ranges::sort(areas, std::greater());
  areas.resize(std::min(areas.size(), kWalls));

  const double box = 2 * (size.x * size.y + size.y * size.z + size.z * size.x);
  return std::accumulate(areas.begin(), areas.end(), 0.0) >= kShare * box;
}

// Many files have bodies whose faces are wound inwards. A closed surface with its fronts inside is
// a room only if the file says more: by vertex normals, by several materials or by flat walls.
bool isMeantAsRoom(const SceneDescription& scene, const Bounds& bounds) {
  if (isBareMesh(scene)) return false;

  const double withNormals = areaWithNormals(scene);
  if (withNormals != 0) return withNormals > 0;
  return hasSeveralMaterials(scene) || hasFlatWalls(scene, bounds);
}

// True if most of seven places around the center are in a room; some may lie inside objects.
bool isRoom(const SceneDescription& scene, const Bounds& bounds) {
  constexpr double kAside = 0.3, kFlattest = 0.05;
  constexpr std::size_t kPlaces = 7, kMostOutside = 2;

  const Vec3d center = bounds.center(), half = bounds.half() * kAside;
  // A nearly flat model has no inside.
  if (std::min({half.x, half.y, half.z}) < kFlattest * maxComponent(half)) return false;

  // The center and six places around it are tested.
  const std::array<Vec3d, kPlaces> offsets{{{},
                                            {half.x, 0, 0},
                                            {-half.x, 0, 0},
                                            {0, half.y, 0},
                                            {0, -half.y, 0},
                                            {0, 0, half.z},
                                            {0, 0, -half.z}}};

  std::size_t outside = 0;
  const bool closed = std::ranges::all_of(offsets, [&](const Vec3d& offset) {
    return isInRoom(scene, center + offset) || ++outside <= kMostOutside;
  });
  return closed && isMeantAsRoom(scene, bounds);
}

// Returns the first place on the way from `from` to `to` that is in the room and in no object, or
// `from` where the walls have large openings.
Vec3d placeInRoom(const SceneDescription& scene, const Vec3d& from, const Vec3d& to) {
  constexpr int kPlaces = 4;
  for (int i = 0; i < kPlaces; ++i) {
    const Vec3d place = from + (to - from) * (static_cast<double>(i) / kPlaces);
    if (isInRoom(scene, place)) return place;
  }
  return isInRoom(scene, to) ? to : from;
}

// Looks across a room from near a corner, or from near the wall that lies in the direction of the
// azimuth.
void lookAround(const SceneDescription& scene, const Bounds& bounds, ModelView& view) {
  constexpr double kWide = 65;
  constexpr double kNearWall = 0.85, kBelowCeiling = 0.35;
  const Vec3d center = bounds.center(), half = bounds.half();

  // The corner is at 45 degrees of a square room.
  const double azimuth = scene.azimuth.value_or(45) * (std::numbers::pi / 180);
  const Vec3d direction{std::sin(azimuth), 0, std::cos(azimuth)};
  const Vec3d corner = direction / std::max(std::abs(direction.x), std::abs(direction.z));

  const Vec3d eye = corner * kNearWall + Vec3d{0, 0.1, 0}, at = corner * -0.4 - Vec3d{0, 0.2, 0};
  view.camera.eye = Vec3f(placeInRoom(scene, center + half * eye, center));
  view.camera.at = Vec3f(center + half * at);
  // Zooming narrows the field of view, because an eye that moved nearer might end up in a wall.
  const double wide = std::tan(kWide * (std::numbers::pi / 360)) / scene.zoom;
  view.camera.fov = static_cast<float>(std::atan(wide) * (360 / std::numbers::pi));
  view.ceiling = placeInRoom(scene, center + half * Vec3d{0, kBelowCeiling, 0}, center);
}

struct Framing {
  Vec3d side, right, up;        // axes of the picture; `side` points towards the eye
  double half = 0, aspect = 1;  // half the height at distance 1, and the width over the height
};

Framing framingOf(const Vec3d& side, const SceneDescription& scene, const Camera& camera) {
  const Vec3d right = normalized(cross(Vec3d{0, 1, 0}, side));
  return {side, right, cross(side, right),
          std::tan(camera.fov * (std::numbers::pi / 360)) / kModelMargin,
          static_cast<double>(scene.width) / scene.height};
}

// Fits the points that everyPoint(use) visits into the picture.
template <typename EveryPoint>
void lookFrom(const Framing& f, double zoom, const EveryPoint& everyPoint, ModelView& view) {
  // The points are seen along the axes of the picture: right, up, and towards the eye.
  const auto everySeen = [&](const auto& use) {
    everyPoint([&](const Vec3d& point) {
      const Vec3d p = point - view.center;
      use(Vec3d{dot(p, f.right), dot(p, f.up), dot(p, f.side)});
    });
  };

  // The picture is centered on the middle of their bounds.
  Bounds seen;
  everySeen([&](const Vec3d& p) { seen.add(p); });
  const Vec3d center = seen.center();

  // The eye stands as far away as the most demanding point needs.
  double distance = 0;
  everySeen([&](const Vec3d& p) {
    const double away = std::max(std::abs(p.x - center.x) / f.aspect, std::abs(p.y - center.y));
    distance = std::max(distance, p.z - center.z + away / f.half);
  });

  const Vec3d at = view.center + f.right * center.x + f.up * center.y + f.side * center.z;
  view.camera.at = Vec3f(at);
  view.camera.eye = Vec3f(at + f.side * (distance / zoom));
}

// Finds the points of a moving model that decide its bounds and its distance: at all times together
// they lie farthest along the axes, along those of the picture, and towards the sides of its view.
std::vector<Vec3d> outermostPoints(const SceneDescription& scene, double seconds,
                                   const Framing& f) {
  constexpr std::uint64_t kFewestTimes = 32, kMostTimes = 256, kMostPosed = 1'000'000;

  // The directions are the axes both ways, and the normals of the four sides of the view's frustum.
  std::vector<Vec3d> directions{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, f.right, f.up, f.side};
  for (const auto i : indices(6)) directions.push_back(-directions[i]);
  for (const Vec3d& slope : {f.right / (f.aspect * f.half), f.up / f.half}) {
    directions.insert(directions.end(), {f.side + slope, f.side - slope});
  }

  std::vector<double> reach(directions.size(), std::numeric_limits<double>::lowest());
  std::vector<Vec3d> points(directions.size());

  // A model of many triangles is posed at fewer times.
  const std::uint64_t posed = kMostPosed / (placedTriangleCount(scene) + 1);
  const std::uint64_t times = std::clamp(posed, kFewestTimes, kMostTimes);

  // Each direction keeps the corner that lies farthest along it.
  const auto add = [&](const Vec3d& corner) {
    for (const auto k : indices(directions)) {
      const double own = dot(corner, directions[k]);
      if (own > reach[k]) {
        reach[k] = own;
        points[k] = corner;
      }
    }
  };

  for (std::uint64_t i = 0; i < times; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(times - 1);
    forEachPlacedCorner(scene, kMostLookedAt, add, seconds * share);
  }
  return points;
}

// Returns the side at the azimuth that the scene asks for, as high above the horizon as this one.
Vec3d atAzimuth(const SceneDescription& scene, const Vec3d& side) {
  if (!scene.azimuth) return side;
  const double azimuth = *scene.azimuth * (std::numbers::pi / 180);
  const double across = std::hypot(side.x, side.z);
  return {across * std::sin(azimuth), side.y, across * std::cos(azimuth)};
}

}  // namespace

ModelView viewOf(const SceneDescription& scene) {
  ModelView view;
  Bounds bounds;
  forEachPlacedCorner(scene, kEveryTriangle, [&](const Vec3d& corner) { bounds.add(corner); });
  if (bounds.empty()) return view;

  view.center = bounds.center();
  view.radius = length(bounds.half());
  if (!(view.radius > 0)) return view;

  // The file may state the viewpoint; otherwise a closed room is seen from inside.
  view.inside = scene.viewpoint == Viewpoint::automatic
                    ? placedTriangleCount(scene) <= kMostOfRoom && isRoom(scene, bounds)
                    : scene.viewpoint == Viewpoint::inside;

  if (view.inside) {
    lookAround(scene, bounds, view);
  } else {
    lookFrom(
        framingOf(atAzimuth(scene, bestSide(scene, view.radius)), scene, view.camera), scene.zoom,
        [&](const auto& use) { forEachPlacedCorner(scene, kMostLookedAt, use); }, view);
  }
  return view;
}

ModelView viewOf(const SceneDescription& scene, double seconds) {
  ModelView view = viewOf(scene);
  if (view.inside) return view;

  const double size = view.radius > 0 ? view.radius : 1;  // it may grow from nothing
  const Vec3d side = atAzimuth(scene, bestSide(scene, size));
  const Framing framing = framingOf(side, scene, view.camera);
  const std::vector<Vec3d> points = outermostPoints(scene, seconds, framing);

  // The bounds enclose the model at all times, and the eye is far enough away for all of them.
  Bounds bounds;
  for (const Vec3d& point : points) bounds.add(point);
  view.center = bounds.center();
  view.radius = length(bounds.half());

  const auto everyPoint = [&](const auto& use) { std::ranges::for_each(points, use); };
  lookFrom(framing, scene.zoom, everyPoint, view);
  return view;
}

bool seesSomething(const SceneDescription& scene, const Camera& camera) {
  const CameraFrame frame = makeCameraFrame(camera, scene.width, scene.height);
  if (!frame.isLinear()) return true;
  const double halfWidth = frame.width / 2.0, halfHeight = frame.height / 2.0;

  // Each side of the picture has a bit, set for points beyond it; one more is for points behind.
  const auto sidesBeyond = [&](const Vec3d& point) {
    const Vec3d fromEye = point - frame.eye;
    const double ahead = dot(fromEye, frame.forward), grows = frame.orthographic ? 1 : ahead;
    const double x = dot(fromEye, frame.right) / dot(frame.right, frame.right);
    const double y = dot(fromEye, frame.up) / dot(frame.up, frame.up);
    const double right = halfWidth * grows, top = halfHeight * grows;
    return unsigned{ahead <= 0} | unsigned{x < -right} << 1 | unsigned{x > right} << 2 |
           unsigned{y < -top} << 3 | unsigned{y > top} << 4;
  };

  // A triangle is outside of the picture if all of its corners lie beyond one side.
  bool sees = false;
  forEachPlacedTriangle(scene, kEveryTriangle, [&](const Corners& t) {
    sees = sees || (sidesBeyond(t[0]) & sidesBeyond(t[1]) & sidesBeyond(t[2])) == 0;
  });
  return sees;
}

}  // namespace whit
