#include "accel/exact_intersector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "bake/facet.h"
#include "bake/sphere.h"
#include "core/index.h"

namespace whit {

namespace {

double sumOfSizes(const Vec3d& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

// The sign of a number that is known up to an error.
enum class Sign { negative, unknown, positive };
Sign signOf(double value, double error) {
  if (value > error) return Sign::positive;
  return value < -error ? Sign::negative : Sign::unknown;
}

// Returns false where the hit surely lies outside the interval from tNear to tFar. A hit that may
// lie on either side of an end becomes uncertain.
bool isOnRay(const QueryRay& ray, QueryHit& hit) {
  if (hit.t + hit.tError < ray.tNear || hit.t - hit.tError > ray.tFar) return false;
  hit.certain = hit.certain && hit.t - hit.tError >= ray.tNear && hit.t + hit.tError <= ray.tFar;
  return true;
}

// Returns false where a mask cuts the surface. A hit close to the mask's border becomes uncertain.
bool isOnMask(float margin, QueryHit& hit) {
  hit.certain = hit.certain && margin > 0x1p-16f;
  return margin >= 0;
}

// Returns false where rays pass a triangle: single-sided ones from behind, others where a mask cuts
// them.
bool isSolid(const Mask& mask, const Scene& scene, QueryHit& hit) {
  if (hit.back && !mask.doubleSided) return false;
  return !mask.map ||
         isOnMask(marginAt<&Mask::cutoff>(mask, scene, hit.id.triangle, static_cast<float>(hit.u),
                                          static_cast<float>(hit.v)),
                  hit);
}

// Bound on the error of a corner that an instance transforms.
double cornerError(const Scene& scene, PlacedTriangleId id) {
  if (id.instance == kNoInstance) return 0;

  double error = 0;
  const Affine& map = scene.instances[id.instance].toWorld;
  const float* p = scene.triangles[id.triangle].position;
  for (int i = 0; i < 9; i += 3) {
    error = std::max(error, 8 * 0x1p-53 * magnitudeOf({p[i], p[i + 1], p[i + 2]}, &map));
  }
  return error;
}

bool isNearer(const QueryHit& a, const QueryHit& b) {
  return std::tuple(a.t, orderOf(a.id)) < std::tuple(b.t, orderOf(b.id));
}
bool mayBeAtOnce(const QueryHit& a, const QueryHit& b) {
  return std::abs(a.t - b.t) <= a.tError + b.tError;
}

}  // namespace

// The signs of three volumes say on which sides of its edges a ray passes a triangle. All errors
// are bounded by products of sums of magnitudes, which are above the lengths of the vectors.
std::optional<QueryHit> ExactIntersector::hitTriangle(const QueryRay& ray,
                                                      PlacedTriangleId id) const {
  // A product of three vectors has seven roundings in a row, each of at most twice the bound.
  constexpr double kRounding = 16 * 0x1p-53;

  const Corners corners = worldCorners(scene_, id.triangle, id.instance);
  const Vec3d a = corners[0] - ray.origin, b = corners[1] - ray.origin, c = corners[2] - ray.origin;
  const Vec3d ab = corners[1] - corners[0];
  const Vec3d bc = corners[2] - corners[1];
  const Vec3d ca = corners[0] - corners[2];
  const double sizeA = sumOfSizes(a), sizeB = sumOfSizes(b), sizeC = sumOfSizes(c),
               sizeD = sumOfSizes(ray.direction);
  const double sizeAB = sumOfSizes(ab), sizeBC = sumOfSizes(bc), sizeCA = sumOfSizes(ca);

  const double moved = cornerError(scene_, id);
  const auto errorOf = [&](double size, double edge) {
    return sizeD * (kRounding * size * edge + 4 * moved * (size + edge + moved));
  };

  // A weight is the volume that the ray's direction spans with an edge, as seen from its origin.
  const double wa = dot(ray.direction, cross(b, bc));
  const double wb = dot(ray.direction, cross(c, ca));
  const double wc = dot(ray.direction, cross(a, ab));
  const std::array signs{signOf(wa, errorOf(sizeB, sizeBC)), signOf(wb, errorOf(sizeC, sizeCA)),
                         signOf(wc, errorOf(sizeA, sizeAB))};

  // Two weights of opposite sign mean that the ray passes outside an edge.
  if (contains(signs, Sign::negative) && contains(signs, Sign::positive)) return std::nullopt;

  QueryHit hit;
  hit.id = id;
  hit.certain = !contains(signs, Sign::unknown);

  // The distance is the ratio of height and slope, each of which has its error.
  const Vec3d normal = cross(ab, -ca);
  const double height = dot(normal, a), slope = dot(normal, ray.direction);
  const double area = kRounding * sizeAB * sizeCA + 4 * moved * (sizeAB + sizeCA + moved);
  const double slopeError = area * sizeD;

  if (std::abs(slope) <= slopeError) {
    // A ray parallel to the plane hits nothing; close to the plane, double precision cannot tell.
    if (std::abs(height) > area * sizeA + moved * sizeAB * sizeCA) return std::nullopt;
    hit.t = dot(a, ray.direction) / dot(ray.direction, ray.direction);
    hit.tError = (sizeAB + sizeCA) / length(ray.direction);
    hit.certain = false;
    return isOnRay(ray, hit) ? std::optional(hit) : std::nullopt;
  }

  hit.t = height / slope;
  hit.tError = (area * sizeA + moved * sizeAB * sizeCA + std::abs(hit.t) * slopeError) /
                   (std::abs(slope) - slopeError) +
               0x1p-51 * std::abs(hit.t);
  if (!isOnRay(ray, hit)) return std::nullopt;

  const double sum = wa + wb + wc;
  hit.u = std::clamp(wb / sum, 0.0, 1.0);
  hit.v = std::clamp(wc / sum, 0.0, 1.0 - hit.u);

  hit.back = (slope > 0) != isMirrored(scene_, id.instance);

  return isSolid(maskOf(id.triangle), scene_, hit) ? std::optional(hit) : std::nullopt;
}

// In the space of the unit sphere, the ray's point closest to the center shows without cancellation
// whether the sphere is hit (see meetSphere() in bake/sphere.h).
int ExactIntersector::hitSphere(const QueryRay& ray, PlacedTriangleId id,
                                QueryHit (&hits)[2]) const {
  const Affine map = sphereInWorld(scene_, id);
  const std::array<Vec3d, 3> rows = inverseRows(map);
  const Vec3d origin = multiply(rows, ray.origin - map.p),
              direction = multiply(rows, ray.direction);
  const double square = dot(direction, direction), along = -dot(origin, direction) / square;
  const Vec3d nearest = origin + direction * along;

  // The condition number of the map bounds by how much it magnifies rounding errors.
  const double stretch = (sumOfSizes(rows[0]) + sumOfSizes(rows[1]) + sumOfSizes(rows[2])) *
                         (sumOfSizes(map.x) + sumOfSizes(map.y) + sumOfSizes(map.z));
  const double error = 64 * 0x1p-53 * stretch * (1 + sumOfSizes(origin));

  const double halfChord2 = 1 - dot(nearest, nearest);
  if (!(halfChord2 > -error)) return 0;

  // The two hits lie half a chord before and behind that point.
  const double half = std::sqrt(std::max(halfChord2, 0.0));
  int count = 0;
  for (const double sign : {-1.0, 1.0}) {
    QueryHit hit;
    hit.id = id;
    hit.t = along + sign * half / std::sqrt(square);
    hit.tError = (error + error / std::max(half, std::sqrt(error))) / std::sqrt(square);
    hit.certain = halfChord2 > error;
    hit.back = sign > 0;

    if (!isOnRay(ray, hit)) continue;
    const std::array<double, 2> weights = sphereWeights(origin + direction * hit.t);
    hit.u = weights[0];
    hit.v = weights[1];

    const Mask& mask = maskOf(id.triangle);
    if (mask.map) {
      const auto [s, t] = sphereUv(spherePoint(hit.u, hit.v));
      const float margin =
          marginAt<&Mask::cutoff>(mask, static_cast<float>(s), static_cast<float>(t));
      if (!isOnMask(margin, hit)) continue;
    }

    hits[count++] = hit;
  }
  return count;
}

// True for coincident surfaces, between which the scene decides by a rule.
bool ExactIntersector::areCoincident(PlacedTriangleId a, PlacedTriangleId b) const {
  if (scene_.isSphere(a.triangle)) {
    const auto place = scene_.coincidentSpheres.find(orderOf(a));
    return place != scene_.coincidentSpheres.end() && contains(*place->second, b);
  }

  if (!scene_.coplanar.any(a.triangle)) return false;
  return contains(scene_.coplanar.partnersOf(a), b);
}

// True if light hits `a` rather than `b`, by the rule of preferenceOf().
bool ExactIntersector::comesBefore(PlacedTriangleId a, PlacedTriangleId b) const {
  const auto preference = [&](PlacedTriangleId id) {
    const std::uint32_t material = scene_.triangles[id.triangle].material;
    const std::uint8_t medium = scene_.mediumOfMaterial[material];
    const bool isSphere = scene_.isSphere(id.triangle);
    const std::uint64_t rank = isSphere ? orderOf(id) : scene_.coplanar.rankOf(id);
    return preferenceOf(scene_, !scene_.materials[material].passesLight(), medium, rank);
  };

  return preference(a) > preference(b);
}

// True where both hits may lie on an edge or a corner that the triangles share, seen from one side.
bool ExactIntersector::areNeighbors(const QueryHit& a, const QueryHit& b) const {
  if (a.certain || b.certain || a.back != b.back || a.id.instance != b.id.instance ||
      scene_.isSphere(a.id.triangle) || scene_.isSphere(b.id.triangle)) {
    return false;
  }
  const Corners own = worldCorners(scene_, a.id.triangle, kNoInstance);
  const Corners other = worldCorners(scene_, b.id.triangle, kNoInstance);
  return std::ranges::find_first_of(own, other) != own.end();
}

QueryHit ExactIntersector::nearestOf(std::vector<QueryHit>& hits) const {
  if (hits.empty()) return {};
  if (hits.size() == 1) return hits[0];
  std::ranges::sort(hits, isNearer);
  QueryHit nearest = hits[0];

  // Among coincident surfaces, the scene's rule chooses.
  for (const QueryHit& hit : hits) {
    if (mayBeAtOnce(hit, hits[0]) && areCoincident(nearest.id, hit.id) &&
        comesBefore(hit.id, nearest.id)) {
      nearest = hit;
    }
  }

  // Any other surface that may be as near makes the answer uncertain.
  for (const QueryHit& hit : hits) {
    if (hit.id == nearest.id || hit.t - hit.tError > nearest.t + nearest.tError) continue;
    // Coincident surfaces do not count, because the rule has chosen among them.
    if (!areCoincident(nearest.id, hit.id)) nearest.certain = false;
  }

  return nearest;
}

void ExactIntersector::keepDistinct(std::vector<QueryHit>& hits) const {
  std::ranges::sort(hits, isNearer);
  std::vector<QueryHit> kept;
  double largestError = 0;  // largest tError of the kept hits

  for (const QueryHit& hit : hits) {
    bool isNew = true;

    // A hit repeats an earlier one if both surfaces coincide or share the edge that was hit. A hit
    // between them that is known more exactly may be at another place than both.
    for (std::size_t i = kept.size(); i-- > 0 && isNew;) {
      if (hit.t - kept[i].t > hit.tError + largestError) break;
      if (!mayBeAtOnce(kept[i], hit)) continue;

      if (areCoincident(kept[i].id, hit.id)) {
        if (comesBefore(hit.id, kept[i].id)) kept[i] = hit;
        isNew = false;
      } else {
        isNew = kept[i].id != hit.id && !areNeighbors(kept[i], hit);
        // It is unknown which of the two comes first.
        if (isNew) kept[i].certain = false;
      }
    }

    if (isNew) kept.push_back(hit);
    largestError = std::max(largestError, hit.tError);
  }

  hits = std::move(kept);
}

}  // namespace whit
