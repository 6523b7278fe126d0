#include "output/digest.h"

#include <xxhash.h>

#include <array>
#include <memory>
#include <new>
#include <ranges>
#include <tuple>

#include "core/option_table.h"
#include "core/text.h"
#include "scene/members.h"

namespace whit {

namespace {

class Digester {
 public:
  Digester() : state_(XXH3_createState(), XXH3_freeState) {
    if (!state_) throw std::bad_alloc();
    XXH3_128bits_reset(state_.get());
  }
  void bytes(const void* data, std::size_t size) { XXH3_128bits_update(state_.get(), data, size); }
  std::string hex() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return formatted("%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                     static_cast<unsigned long long>(hash.low64));
  }

 private:
  std::shared_ptr<XXH3_state_t> state_;
};

template <typename T, typename... Others>
constexpr bool kIsOneOf = (std::is_same_v<T, Others> || ...);
// True for types without padding and pointers, whose bytes are their value.
template <typename T>
constexpr bool kPlain =
    std::is_arithmetic_v<T> || std::is_enum_v<T> ||
    kIsOneOf<T, Crop, Vec3f, Vec3d, Affine, TriangleRecord, NormalRecord, ColorRecord, UvRecord>;
static_assert(sizeof(Crop) == 4 * sizeof(int) && sizeof(Affine) == 12 * sizeof(double) &&
              sizeof(TriangleRecord) == 16 * sizeof(float) &&
              sizeof(NormalRecord) == 9 * sizeof(float) &&
              sizeof(ColorRecord) == 9 * sizeof(float) && sizeof(UvRecord) == 6 * sizeof(float));
template <typename T, std::size_t n>
constexpr bool kPlain<std::array<T, n>> = kPlain<T>;

template <typename T>
requires kPlain<T>
void add(Digester& d, const T& value) { d.bytes(&value, sizeof value); }

// Adds the values in this order.
template <typename... Values>
requires(sizeof...(Values) > 1) void add(Digester& d, const Values&... values) {
  (add(d, values), ...);
}

// Adds the length of a table or text first, so that "ab", "c" and "a", "bc" differ.
template <std::ranges::contiguous_range Table>
requires(!kPlain<Table>) void add(Digester& d, const Table& table) {
  using T = typename Table::value_type;
  add(d, std::uint64_t{table.size()});
  if constexpr (kPlain<T>) {
    d.bytes(table.data(), table.size() * sizeof(T));
  } else {
    for (const T& element : table) add(d, element);
  }
}

template <typename Noun>
requires(std::tuple_size_v<decltype(kMembers<Noun>)> > 0) void add(Digester& d, const Noun& noun) {
  forEachMember<Noun>([&](const auto& member) { add(d, noun.*member.field); });
}

// The bindings below name every member, so that a new member does not compile until it is added
// here.
void add(Digester& d, const InstanceRecord& instance) {
  const auto& [geometry, written, toWorld, mover, toMover, firstItem] = instance;
  add(d, geometry, toWorld);
}

void add(Digester& d, const Texture& texture) {
  const auto& [name, format, wrapU, wrapV, nearest, width, height, texels, shared] = texture;
  add(d, format, wrapU, wrapV, nearest, width, height);
  if (shared->recipe.empty()) {
    add(d, shared->kept());
  } else {
    add(d, shared->recipe);
  }
}

void add(Digester& d, const Geometry& geometry) {
  const auto& [position, index, classBegin, firstTriangle, firstSphere, spheres] = geometry;
  add(d, position, index, classBegin, firstTriangle, firstSphere, spheres);
}

void add(Digester& d, const EnvironmentImage& image) {
  const auto& [width, height, r, g, b] = image;
  add(d, width, height, r, g, b);
}

}  // namespace

std::string digestOf(const Scene& scene) {
  const auto& [name, isModel, origin, upright, width, height, options, cameras, cameraPath,
               animations, variants, lights, sky, ambient, fog, materials, textures] =
      static_cast<const SceneContents&>(scene);
  const auto& [blurred, mediumOfMaterial, media, geometries, instances, triangles, firstSphere,
               normals, colors, secondUvs, lower, upper, instancedTriangles, instancedSpheres,
               items, coplanar, coincidentSpheres, motion, effects, reasons] =
      static_cast<const SceneTables&>(scene);

  Digester d;
  // Media, bounds and effects follow from these; the order in which things were written does not.
  add(d, lights, sky, sky.kind, sky.image, ambient);
  if (!isBlack(fog.density)) add(d, fog);  // scenes without fog keep their digests
  add(d, materials, textures, geometries, instances, triangles, normals, colors, secondUvs,
      coplanar.ranks());
  // Options place the camera in coordinates of the file.
  if (origin != Vec3d()) add(d, origin);

  for (const auto& sphere : coincidentSpheres) {
    for (const PlacedTriangleId& id : *sphere.second) add(d, orderOf(id));
  }
  return d.hex();
}

std::string digestOf(const RenderOptions& options) {
  Digester d;
  for (const auto& [name, value] : pictureOptions(options)) {
    if (name == "quality") continue;
    add(d, name, value);
  }
  return d.hex();
}

std::string digestOf(const Image& image) {
  Digester d;
  add(d, image.width, image.height, image.window);

  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  d.bytes(image.pixels.data(), image.pixels.size() * sizeof(Rgb));
  return d.hex();
}

}  // namespace whit
