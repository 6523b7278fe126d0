// Structures of arrays. Each lists its columns once, as X(type, name, feature); the struct, its
// allocation, comparison and printing all come from that list. A column whose feature the frame
// has no use for stays null.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

#include "core/enum_set.h"
#include "core/vec3.h"

namespace whit {

// Feature flags of a plan, found once for all frames. Whole calls test these and nothing else,
// neither null columns nor empty tables: a set of columns belongs to a feature and exists only with
// it, and steps ask their chunk (`chunk.has(Feature::cones)`). X(name, what it is there for)
#define WHIT_FEATURES(X)                                                      \
  X(always, "every frame")                                                    \
  X(ambient, "ambient light, blurred sky")                                    \
  X(spotLights, "cones of spot lights")                                       \
  X(emission, "materials that emit")                                          \
  X(emissionFactors, "emission by maps or vertex colors")                     \
  X(vertexColors, "vertex colors")                                            \
  X(sky, "a sky that is not black")                                           \
  X(glossy, "glossy lobes")                                                   \
  X(lobes, "glossy lobes that take light from what lies below")               \
  X(roughnessMaps, "roughness by a map")                                      \
  X(occlusionMaps, "maps that dim indirect light")                            \
  X(mirrorMaps, "mirrors by a map or vertex colors")                          \
  X(transmissionMaps, "transmission by a map or vertex colors")               \
  X(coverage, "surfaces that are there in part")                              \
  X(streams, "random numbers along paths")                                    \
  X(transmission, "media along rays")                                         \
  X(absorption, "media that absorb")                                          \
  X(fog, "fog of the air")                                                    \
  X(instances, "hits on instances")                                           \
  X(spheres, "hits on exact spheres")                                         \
  X(coplanar, "triangles that overlap others in their plane")                 \
  X(shadows, "shadow rays")                                                   \
  X(shadowOffset, "shadow rays that start above their facets (--terminator)") \
  X(cones, "the width of pixels along rays (--texture-filter trilinear)")     \
  X(smoothNormals, "vertex normals")                                          \
  X(ended, "paths that --depth and --cutoff end (--channels error)")          \
  X(alpha, "light that comes straight through surfaces (--channels alpha)")   \
  X(textures, "maps of colors")                                               \
  X(normalMaps, "maps of normals")                                            \
  X(secondUvs, "maps looked up with second texture coordinates")

enum class Feature : std::uint8_t {
#define WHIT_FEATURE_ENUM(name, text) name,
  WHIT_FEATURES(WHIT_FEATURE_ENUM)
#undef WHIT_FEATURE_ENUM
};

#define WHIT_FEATURE_COUNT(name, text) +1
inline constexpr int kFeatureCount = 0 WHIT_FEATURES(WHIT_FEATURE_COUNT);
#undef WHIT_FEATURE_COUNT

using FeatureSet = EnumSet<Feature, kFeatureCount, 1u>;  // always has Feature::always

// Slots come in blocks of 16, the widest packet; kernels run over whole vectors, so capacities are
// multiples of it and what lies behind the last live slot is allocated and harmless.
inline constexpr std::size_t kBlock = 16;
inline constexpr std::size_t roundUpToBlock(std::size_t n) {
  return (n + kBlock - 1) / kBlock * kBlock;
}

// The columns of a vector or a color.
struct Columns3 {
  float *x = nullptr, *y = nullptr, *z = nullptr;

  Vec3f at(std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, const Vec3f& v) const {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
};

#define WHIT_COLUMN_MEMBER(type, name, feature) type* name = nullptr;
#define WHIT_COLUMN_MEMBER3(name, x, y, z, feature) Columns3 name{};
#define WHIT_COLUMN_VISIT(type, name, feature) visit(#name, c.name, Feature::feature);
#define WHIT_COLUMN_VISIT3(name, nameX, nameY, nameZ, feature) \
  visit(nameX, c.name.x, Feature::feature);                    \
  visit(nameY, c.name.y, Feature::feature);                    \
  visit(nameZ, c.name.z, Feature::feature);
#define WHIT_DECLARE_COLUMNS(Struct, LIST)                \
  struct Struct {                                         \
    LIST(WHIT_COLUMN_MEMBER, WHIT_COLUMN_MEMBER3)         \
    template <typename Self, typename Visitor>            \
    static void forEachColumn(Self& c, Visitor&& visit) { \
      LIST(WHIT_COLUMN_VISIT, WHIT_COLUMN_VISIT3)         \
    }                                                     \
  }

#define WHIT_XYZ(X3, name, feature) X3(name, #name "X", #name "Y", #name "Z", feature)
#define WHIT_RGB(X3, name, feature) X3(name, #name "R", #name "G", #name "B", feature)

// X(type, name, feature), and X3(name, names of the three columns, feature). Directions are unit
// vectors; `parent` is the slot at the depth above (a pixel's at depth 0) that gets weight *
// radiance; `throughput` bounds what the ray's radiance is multiplied with on its way to the eye;
// `media` is the stack of dielectrics it travels in, a byte each, the one entered last in the low
// byte; `path` is its number (sampling/random_streams.h), in frames that draw random numbers;
// `straight` is 1 where a child goes on along its camera ray (see Chunk::isStraight()); `cone` is
// the width of its cone (RayCone) where it starts, for mip levels: the spread is that of the
// camera's pixels at every depth.
#define WHIT_RAY_COLUMNS(X, X3)         \
  WHIT_XYZ(X3, org, always)             \
  WHIT_XYZ(X3, dir, always)             \
  WHIT_RGB(X3, weight, always)          \
  X(float, throughput, always)          \
  X(std::uint32_t, parent, always)      \
  X(std::uint32_t, media, transmission) \
  X(std::uint32_t, path, streams)       \
  X(std::uint32_t, straight, alpha)     \
  X(float, cone, cones)

// `triangle` indexes Scene::triangles, kMiss where nothing was hit; u, v weigh corners 1 and 2;
// `instance` indexes Scene::instances, kNoInstance in the world; `alsoCrossed` are the dielectrics
// whose faces lie in the very place of the one that was hit: kCrossedBits each, medium * 2 + (1 if
// its outside is hit), 0 for none; with kSharesPlace where any surface does.
inline constexpr int kCrossedBits = 10;
inline constexpr std::uint32_t kSharesPlace = 1u << 30;
#define WHIT_HIT_COLUMNS(X, X3)         \
  X(std::uint32_t, triangle, always)    \
  X(float, t, always)                   \
  X(float, u, always)                   \
  X(float, v, always)                   \
  X(std::uint32_t, instance, instances) \
  X(std::uint32_t, alsoCrossed, coplanar)

// A surfel is a point of a surface with all that shading needs. Normals face the viewer. `material`
// is kMiss where the ray left the scene. `offset` is how far along the geometric normal a new ray
// must start (hard cases H1-H4), and `viewOffset`, on the viewer's side, how far back along the
// viewer's ray (H7). `flags`: kEntering, kHidden. `mediaBehind` is the stack of a refracted child;
// the material's emission, mirror and transmission are multiplied by the columns of these names;
// `coverage` is the opacity: it multiplies everything that the surface sends, and the rest of the
// light passes straight through; `occlusion` multiplies indirect light; `shadowOffset` is
// added to the position where shadow rays start; `cone` is the width that the ray's cone has
// reached, and its children's start with; `lobe` is the share that the glossy lobe reflects of the
// light that the mirror leaves (stages/shading_tables.h: kMaterialLayered).
#define WHIT_SURFEL_COLUMNS(X, X3)             \
  WHIT_XYZ(X3, pos, always)                    \
  WHIT_XYZ(X3, ng, always)                     \
  WHIT_XYZ(X3, ns, always)                     \
  X(float, offset, always)                     \
  X(float, viewOffset, always)                 \
  WHIT_RGB(X3, diffuse, always)                \
  X(std::uint32_t, material, always)           \
  WHIT_RGB(X3, specular, glossy)               \
  X(float, alpha, glossy)                      \
  WHIT_RGB(X3, lobe, lobes)                    \
  WHIT_RGB(X3, emission, emissionFactors)      \
  X(float, coverage, coverage)                 \
  X(float, occlusion, occlusionMaps)           \
  WHIT_RGB(X3, mirror, mirrorMaps)             \
  WHIT_RGB(X3, transmission, transmissionMaps) \
  WHIT_XYZ(X3, shadowOffset, shadowOffset)     \
  X(float, cone, cones)                        \
  X(std::uint32_t, flags, transmission)        \
  X(std::uint32_t, mediaBehind, transmission)

// Shadow rays of one light, compacted. Directions reach from the surfel to the light, not
// normalized; `slot` is the surfel's.
#define WHIT_SHADOW_COLUMNS(X, X3) \
  WHIT_XYZ(X3, org, always)        \
  WHIT_XYZ(X3, dir, always)        \
  X(float, tFar, always)           \
  X(std::uint32_t, slot, always)

// One light's radiance a surfel, before and after its shadow is known (visible: 0 or 1).
#define WHIT_UNSHADOWED_COLUMNS(X, X3) \
  X3(rgb, "r", "g", "b", always)       \
  X(float, visible, always)

// `ended` is the share of radiance 1 at the ends of all paths that --depth and --cutoff end which
// would come back; a bound, by the largest of the three weights. `clear` is the share of the
// background that would come back, seen straight through all surfaces.
#define WHIT_RADIANCE_COLUMNS(X, X3) \
  X3(rgb, "r", "g", "b", always)     \
  X(float, ended, ended)             \
  WHIT_RGB(X3, clear, alpha)

WHIT_DECLARE_COLUMNS(RayColumns, WHIT_RAY_COLUMNS);
WHIT_DECLARE_COLUMNS(HitColumns, WHIT_HIT_COLUMNS);
WHIT_DECLARE_COLUMNS(SurfelColumns, WHIT_SURFEL_COLUMNS);
WHIT_DECLARE_COLUMNS(ShadowColumns, WHIT_SHADOW_COLUMNS);
WHIT_DECLARE_COLUMNS(UnshadowedColumns, WHIT_UNSHADOWED_COLUMNS);
WHIT_DECLARE_COLUMNS(RadianceColumns, WHIT_RADIANCE_COLUMNS);

inline constexpr std::uint32_t kMiss = 0xffffffffu;
inline constexpr std::uint32_t kEntering = 1;  // the ray hit the outside of the surface
inline constexpr std::uint32_t kHidden = 2;    // inside a dielectric of higher priority: not there

// Returns the same columns, starting `first` slots later.
template <typename Columns>
Columns advanced(const Columns& columns, std::size_t first) {
  Columns result = columns;
  Columns::forEachColumn(result, [&](const char*, auto*& column, Feature) {
    if (column) column += first;
  });
  return result;
}

// Owns the memory of one set of columns, zeroed and aligned to 64 bytes.
template <typename Columns>
class ColumnStore {
 public:
  ColumnStore() = default;
  ColumnStore(std::size_t capacity, FeatureSet features) { allocate(capacity, features); }

  void allocate(std::size_t capacity, FeatureSet features) {
    capacity_ = roundUpToBlock(capacity);
    // Four-byte elements. Columns one cache line further apart than a power of two, or all of them
    // would compete for the same sets of the L1 cache; one block to spare for a vector's overhang.
    const std::size_t stride = (capacity_ + 2 * kBlock) * sizeof(float);
    std::size_t count = 0;
    Columns::forEachColumn(
        columns_, [&](const char*, auto*&, Feature feature) { count += features.has(feature); });
    bytes_ = count * stride;
    memory_.reset(static_cast<std::byte*>(std::aligned_alloc(64, bytes_)));
    if (!memory_) throw std::bad_alloc();
    std::byte* next = memory_.get();
    std::fill(next, next + bytes_, std::byte{0});
    Columns::forEachColumn(columns_, [&](const char*, auto*& column, Feature feature) {
      using Element = std::remove_reference_t<decltype(*column)>;
      static_assert(sizeof(Element) == sizeof(float));
      column = features.has(feature) ? reinterpret_cast<Element*>(next) : nullptr;
      if (column) next += stride;
    });
  }

  const Columns& operator*() const { return columns_; }
  const Columns* operator->() const { return &columns_; }
  std::size_t capacity() const { return capacity_; }
  std::size_t bytes() const { return bytes_; }

 private:
  struct Free {
    void operator()(std::byte* p) const { std::free(p); }
  };
  std::unique_ptr<std::byte, Free> memory_;
  Columns columns_;
  std::size_t capacity_ = 0, bytes_ = 0;
};

// One row of the columns in double, as the scalar reference writes it. Made from the same lists: a
// column that is added there is in its row, and is compared.
template <typename Element>
using InRow = std::conditional_t<std::is_same_v<Element, float>, double, Element>;

#define WHIT_ROW_MEMBER(type, name, feature) InRow<type> name{};
#define WHIT_ROW_VISIT(type, name, feature) visit(#name, row.name, Feature::feature);
#define WHIT_ROW_COUNT(type, name, feature) +1
#define WHIT_ROW_VALUE(type, name, feature) static_cast<double>(name),
#define WHIT_ROW_LOAD(type, name, feature) \
  if (columns.name) row.name = static_cast<InRow<type>>(columns.name[i]);

#define WHIT_ROW_MEMBER3(name, x, y, z, feature) Vec3d name{};
#define WHIT_ROW_VISIT3(name, nameX, nameY, nameZ, feature) \
  visit(nameX, row.name.x, Feature::feature);               \
  visit(nameY, row.name.y, Feature::feature);               \
  visit(nameZ, row.name.z, Feature::feature);
#define WHIT_ROW_COUNT3(name, x, y, z, feature) +3
#define WHIT_ROW_VALUE3(name, nameX, nameY, nameZ, feature) name.x, name.y, name.z,
#define WHIT_ROW_LOAD3(name, nameX, nameY, nameZ, feature) \
  if (columns.name.x) row.name = Vec3d(columns.name.at(i));

// visit(name, value, feature). `at` leaves what the frame has no column for as it is made.
#define WHIT_DECLARE_ROW(Row, Struct, LIST)                                          \
  struct Row {                                                                       \
    using Columns = Struct;                                                          \
    static constexpr std::size_t kColumns = 0 LIST(WHIT_ROW_COUNT, WHIT_ROW_COUNT3); \
    LIST(WHIT_ROW_MEMBER, WHIT_ROW_MEMBER3)                                          \
    static Row at(const Struct& columns, std::size_t i) {                            \
      Row row;                                                                       \
      LIST(WHIT_ROW_LOAD, WHIT_ROW_LOAD3)                                            \
      return row;                                                                    \
    }                                                                                \
    std::array<double, kColumns> values() const {                                    \
      return {LIST(WHIT_ROW_VALUE, WHIT_ROW_VALUE3)};                                \
    }                                                                                \
    template <typename Self, typename Visitor>                                       \
    static void forEachColumn(Self& row, Visitor&& visit) {                          \
      LIST(WHIT_ROW_VISIT, WHIT_ROW_VISIT3)                                          \
    }                                                                                \
  }

WHIT_DECLARE_ROW(RayRow, RayColumns, WHIT_RAY_COLUMNS);
WHIT_DECLARE_ROW(HitRow, HitColumns, WHIT_HIT_COLUMNS);
WHIT_DECLARE_ROW(SurfelRow, SurfelColumns, WHIT_SURFEL_COLUMNS);
WHIT_DECLARE_ROW(ShadowRow, ShadowColumns, WHIT_SHADOW_COLUMNS);
WHIT_DECLARE_ROW(UnshadowedRow, UnshadowedColumns, WHIT_UNSHADOWED_COLUMNS);
WHIT_DECLARE_ROW(RadianceRow, RadianceColumns, WHIT_RADIANCE_COLUMNS);

}  // namespace whit
