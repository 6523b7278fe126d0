#include <algorithm>
#include <limits>
#include <utility>

#include "bake/finalize_steps.h"
#include "bake/move_scene.h"
#include "core/usable_threads.h"

namespace whit {

namespace {

constexpr std::size_t kMediaLimit = std::numeric_limits<std::uint8_t>::max();

// From the front, a little to the right and above, far enough for all of the bounds' sphere.
Camera framingCamera(const Scene& scene) {
  Camera camera;
  const Vec3d lower(scene.lower), upper(scene.upper);
  const Vec3d center = (lower + upper) * 0.5;
  const double radius = length(upper - lower) * 0.5;
  if (!(radius > 0)) return camera;
  const double half = camera.fov * (3.14159265358979323846 / 360);
  const double aspect = static_cast<double>(scene.width) / scene.height;
  const double narrow = std::atan(std::tan(half) * std::min(1.0, aspect));
  camera.at = Vec3f(center);
  camera.eye = Vec3f(center + normalized(Vec3d{0.5, 0.4, 1.0}) * (radius / std::sin(narrow)));
  return camera;
}

template <typename Vector>
std::uint64_t bytesOf(const Vector& v) {
  return static_cast<std::uint64_t>(v.size()) * sizeof(typename Vector::value_type);
}

}  // namespace

void numberMedia(Scene& scene) {
  scene.media.assign(1, Medium{});
  scene.mediumOfMaterial.assign(scene.materials.size(), 0);
  const std::vector<std::uint64_t> uses = trianglesOfMaterials(scene);
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    if (!m.boundsMedium() || uses[i] == 0) continue;
    const Medium medium{m.ior, m.absorption, m.priority};
    const auto known = std::find(scene.media.begin() + 1, scene.media.end(), medium);
    const auto number = static_cast<std::size_t>(known - scene.media.begin());
    if (number > kMediaLimit) throwLimit(scene.name + ": more than 255 different dielectrics");
    scene.mediumOfMaterial[i] = static_cast<std::uint8_t>(number);
    if (known == scene.media.end()) scene.media.push_back(medium);
  }
}

Scene Scene::finalize(SceneDescription&& description, Warnings& warnings, Progress* progress) {
  SceneDescription d = std::move(description);
  validate(d);
  settleSides(d);
  if (d.isModel && d.motion.rig.empty()) noteHiddenSides(d, warnings);
  packTextures(d.textures, usableThreads());
  Scene scene;
  SceneContents& contents = d;
  static_cast<SceneContents&>(scene) = std::move(contents);
  scene.motion.given = std::move(d.motion);
  SceneOrder order = bakeGeometry(d, scene, warnings, progress);
  if (!hasSmoothNormals(scene)) scene.normals = {};
  if (!hasVertexColors(scene)) scene.colors = {};
  numberMedia(scene);
  gatherEffects(scene);
  if (scene.motion.ofGeometry) {
    scene.motion.order = std::move(order);
  } else {
    bool complete = true;
    scene.coplanar = findCoplanarTriangles(scene, usableThreads(), complete);
    warnings.add("search for coplanar faces cut short: too many triangles or overlapping instances",
                 scene.name, complete ? 0 : 1);
    scene.coplanar.rankBy(scene, order);
    scene.coincidentSpheres = findCoincidentSpheres(scene, order);
  }
  moveScene(scene, 0, deformVertices);
  if (scene.cameras.empty()) {
    scene.cameras.push_back(scene.cameraPath.empty() ? framingCamera(scene)
                                                     : scene.cameraPath.front().camera);
  }
  if (scene.motion.given.seconds != 0) moveScene(scene, scene.motion.given.seconds, deformVertices);
  return scene;
}

ItemNumbers::Run ItemNumbers::find(std::uint32_t triangle) const {
  const auto isBehind = [](std::uint32_t t, const Run& run) { return t < run.first; };
  Run run = *(std::upper_bound(runs_.begin(), runs_.end(), triangle, isBehind) - 1);
  run.number += triangle - run.first;
  run.first = triangle;
  return run;
}

Scene::MetNumbers Scene::numbersOf(std::uint32_t triangle, std::uint32_t instance) const {
  constexpr std::uint64_t kLast = std::numeric_limits<std::uint32_t>::max() - 1;
  const ItemNumbers::Run own = items.find(triangle);
  const std::uint64_t first = instance == kNoInstance ? 0 : instances[instance].firstItem;
  return {static_cast<std::uint32_t>(std::min(first + own.item, kLast)), own.number};
}

std::uint64_t Scene::memoryBytes() const {
  std::uint64_t bytes = bytesOf(triangles) + bytesOf(normals) + bytesOf(colors) +
                        bytesOf(secondUvs) + bytesOf(instances) + bytesOf(sky.image.r) +
                        bytesOf(sky.image.g) + bytesOf(sky.image.b) + coplanar.bytes() +
                        items.bytes();
  for (const Geometry& g : geometries) bytes += bytesOf(g.position) + bytesOf(g.index);
  for (const Texture& t : textures) bytes += t.packedSize() * sizeof(std::uint32_t);
  return bytes;
}

}  // namespace whit
