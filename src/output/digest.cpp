#include "output/digest.h"

#include <xxhash.h>

#include <array>
#include <memory>
#include <new>
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
  // Adds the length first, so that "ab", "c" and "a", "bc" differ.
  void text(std::string_view text) {
    const std::uint64_t size = text.size();
    bytes(&size, sizeof size);
    bytes(text.data(), text.size());
  }
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
    kIsOneOf<T, Vec3f, Vec3d, Affine, TriangleRecord, NormalRecord, ColorRecord, UvRecord>;
static_assert(sizeof(Affine) == 12 * sizeof(double) &&
              sizeof(TriangleRecord) == 16 * sizeof(float) &&
              sizeof(NormalRecord) == 9 * sizeof(float) &&
              sizeof(ColorRecord) == 9 * sizeof(float) && sizeof(UvRecord) == 6 * sizeof(float));
template <typename T, std::size_t n>
constexpr bool kPlain<std::array<T, n>> = kPlain<T>;

template <typename T>
requires kPlain<T>
void add(Digester& d, const T& value) { d.bytes(&value, sizeof value); }

// The bindings below name every member, so that a new member does not compile until it is added
// here.
void add(Digester& d, const InstanceRecord& instance) {
  const auto& [geometry, written, toWorld, mover, toMover, firstItem] = instance;
  add(d, geometry);
  add(d, toWorld);
}

template <typename Noun>
requires(std::tuple_size_v<decltype(kMembers<Noun>)> > 0) void add(Digester& d, const Noun& noun) {
  forEachMember<Noun>([&](const auto& member) { add(d, noun.*member.field); });
}

void add(Digester& d, const Texture& texture);
void add(Digester& d, const Geometry& geometry);

template <typename Table>
void addTable(Digester& d, const Table& table) {
  using T = typename Table::value_type;
  add(d, static_cast<std::uint64_t>(table.size()));
  if constexpr (kPlain<T>) {
    d.bytes(table.data(), table.size() * sizeof(T));
  } else {
    for (const T& element : table) add(d, element);
  }
}

void add(Digester& d, const Texture& texture) {
  const auto& [name, format, wrapU, wrapV, nearest, width, height, texels, shared] = texture;
  add(d, format);
  add(d, wrapU);
  add(d, wrapV);
  add(d, nearest);
  add(d, width);
  add(d, height);
  if (shared->recipe.empty()) {
    addTable(d, shared->kept());
  } else {
    d.text(shared->recipe);
  }
}
void add(Digester& d, const Geometry& geometry) {
  const auto& [position, index, classBegin, firstTriangle, firstSphere, spheres] = geometry;
  addTable(d, position);
  addTable(d, index);
  add(d, classBegin);
  add(d, firstTriangle);
  add(d, firstSphere);
  add(d, spheres);
}
void add(Digester& d, const EnvironmentImage& image) {
  const auto& [width, height, r, g, b] = image;
  add(d, width);
  add(d, height);
  addTable(d, r);
  addTable(d, g);
  addTable(d, b);
}

}  // namespace

std::string digestOf(const Scene& scene) {
  const auto& [name, isModel, origin, width, height, options, cameras, cameraPath, animations,
               variants, lights, sky, ambient, fog, materials, textures] =
      static_cast<const SceneContents&>(scene);
  const auto& [blurred, mediumOfMaterial, media, geometries, instances, triangles, firstSphere,
               normals, colors, secondUvs, lower, upper, instancedTriangles, instancedSpheres,
               items, coplanar, coincidentSpheres, motion, effects, reasons] =
      static_cast<const SceneTables&>(scene);

  Digester d;
  // Media, bounds and effects follow from these; the order in which things were written does not.
  addTable(d, lights);
  add(d, sky);
  add(d, sky.kind);
  add(d, sky.image);
  add(d, ambient);
  if (!isBlack(fog.density)) add(d, fog);  // scenes without fog keep their digests
  addTable(d, materials);
  addTable(d, textures);
  addTable(d, geometries);
  addTable(d, instances);
  addTable(d, triangles);
  addTable(d, normals);
  addTable(d, colors);
  addTable(d, secondUvs);
  addTable(d, coplanar.ranks());
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
    d.text(name);
    d.text(value);
  }
  return d.hex();
}

std::string digestOf(const Image& image) {
  Digester d;
  for (const int n : {image.width, image.height, image.window.x0, image.window.y0, image.window.x1,
                      image.window.y1}) {
    d.bytes(&n, sizeof n);
  }

  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  d.bytes(image.pixels.data(), image.pixels.size() * sizeof(Rgb));
  return d.hex();
}

}  // namespace whit
