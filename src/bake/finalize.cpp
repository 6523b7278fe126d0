#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bake/edit_scene.h"
#include "bake/finalize_steps.h"
#include "core/index.h"
#include "core/machine_limits.h"
#include "core/text.h"
#include "scene/members.h"

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

  // The bounding sphere has to fit into the narrower of the two fields of view.
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

std::string place(const std::string& scene, const std::string& kind, std::size_t i,
                  const std::string& name) {
  const std::string thing = kind + (name.empty() ? concat(" ", i) : " '" + name + "'");
  return scene.empty() ? thing : scene + ": " + thing;
}

template <typename Noun>
void checkMembers(const Noun& noun, const std::string& where) {
  forEachMember<Noun>([&](const auto& member) {
    const auto& value = noun.*member.field;
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, Vec3f>) {
      if (!isFinite(value)) throwBadScene(where, std::string("expected a finite ") + member.name);
      if (member.rules.kind == MemberKind::color && value != max(value, Vec3f(0.0f))) {
        throwBadScene(where, std::string("expected channels of 0 or more in ") + member.name);
      }
    } else if constexpr (!std::is_enum_v<Value>) {
      const double low = member.rules.low, high = member.rules.high;
      if (value >= low && value <= high) return;
      throwBadScene(where, formatted("expected %s to be from %g to %g", member.name, low, high));
    }
  });
}

void checkLights(const SceneDescription& d) {
  for (const auto i : indices(d.lights)) {
    const Light& light = d.lights[i];
    const std::string where = place(d.name, "light", i, light.name);
    checkMembers(light, where);
    if (hasDirection(light) && !(maxComponent(abs(light.direction)) > 0)) {
      throwBadScene(where, "expected a direction that is not 0");
    }
    if (hasCone(light) && !(light.innerConeAngle < light.outerConeAngle)) {
      throwBadScene(where, "expected cone angles with inner < outer");
    }
  }
}

// Relative to the lengths of its columns, so that a uniformly tiny map is not taken for singular.
bool isSingular(const Affine& a) {
  constexpr double kSmallestSine = 1e-14;
  const double volume = length(a.x) * length(a.y) * length(a.z);
  return !(std::abs(a.determinant()) > kSmallestSine * volume);
}

void checkInstances(const SceneDescription& d) {
  for (const auto i : indices(d.instances)) {
    const Affine& map = d.instances[i].toWorld;
    const std::string where = place(d.name, "instance", i, d.objects[d.instances[i].object].name);
    for (const Vec3d& column : {map.x, map.y, map.z, map.p}) {
      if (maxComponent(abs(column)) <= kLargestCoordinate && isFinite(column)) continue;
      throwBadScene(where, "expected a transform of finite numbers up to 1.844e18");
    }
    if (isSingular(map)) {
      throwBadScene(where, "expected a transform that can be undone; this one flattens space");
    }
  }
}

// The box of an instance is that of its object, moved: exact unless it is turned.
void addInstance(const Scene& scene, const InstanceRecord& instance, const std::vector<Box>& boxes,
                 Box& all) {
  const Box& own = boxes[instance.geometry];
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d world = instance.toWorld.point(Vec3d(own.corner(corner)));
    if (!(maxComponent(abs(world)) <= kLargestCoordinate)) {
      throwBadScene(concat(scene.name, ": instance of geometry ", instance.geometry),
                    "expected coordinates up to 1.844e18 after its transform");
    }
    all.add(Vec3f(world));
  }
}

// The largest coordinate of everything that rays start from: surfaces and eyes.
float farthestStart(const Scene& scene, const std::vector<Box>& boxes) {
  Box all = boxes[0];
  for (const InstanceRecord& instance : scene.instances) addInstance(scene, instance, boxes, all);
  float farthest = 0;
  const auto add = [&](const Vec3f& p) { farthest = std::max(farthest, maxComponent(abs(p))); };
  if (!all.empty()) {
    add(all.lower);
    add(all.upper);
  }

  // Rays start at points of the lens, and in stereo pairs beside the eye.
  const auto addStarts = [&](const Camera& camera) {
    add(abs(camera.eye) + Vec3f(camera.aperture + camera.eyeDistance));
  };
  for (const Camera& camera : scene.cameras) addStarts(camera);
  for (const Keyframe& frame : scene.cameraPath) addStarts(frame.camera);
  return farthest;
}

}  // namespace

void numberMedia(Scene& scene) {
  scene.media.assign(1, Medium{});
  scene.mediumOfMaterial.assign(scene.materials.size(), 0);
  const std::vector<std::uint64_t> uses = trianglesOfMaterials(scene);

  for (const auto i : indices(scene.materials)) {
    const Material& m = scene.materials[i];
    if (!m.boundsMedium() || uses[i] == 0) continue;

    // Equal dielectrics share a number.
    const Medium medium{m.ior, m.absorption, m.priority};
    const auto known = std::find(scene.media.begin() + 1, scene.media.end(), medium);
    const std::size_t number = known - scene.media.begin();
    if (number > kMediaLimit) throwLimit(scene.name + ": more than 255 different dielectrics");

    scene.mediumOfMaterial[i] = static_cast<std::uint8_t>(number);
    if (known == scene.media.end()) scene.media.push_back(medium);
  }
}

Scene Scene::finalize(SceneDescription&& description, Warnings& warnings, Progress* progress) {
  SceneDescription d = std::move(description);
  validate(d);
  // Triangles are classified by the sides that are seen, so these are decided before baking.
  decideDoubleSided(d);
  if (d.isModel && d.motion.rig.empty()) noteHiddenSides(d, warnings);
  for (Texture& texture : d.textures) texture.share();

  Scene scene;
  SceneContents& contents = d;
  static_cast<SceneContents&>(scene) = std::move(contents);
  scene.motion.given = std::move(d.motion);

  SceneOrder order = bakeGeometry(d, scene, warnings, progress);
  // Tables that hold nothing but default values are dropped.
  if (!hasSmoothNormals(scene)) scene.normals = {};
  if (!hasVertexColors(scene)) scene.colors = {};

  numberMedia(scene);
  gatherEffects(scene);

  // moveScene() searches scenes that move for coplanar triangles and coincident spheres.
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

  // The scene starts at 0 s, because the pairs that are found there serve other times as well.
  moveScene(scene, 0);

  if (scene.cameras.empty()) {
    scene.cameras.push_back(scene.cameraPath.empty() ? framingCamera(scene)
                                                     : scene.cameraPath.front().camera);
  }

  if (scene.motion.given.seconds != 0) moveScene(scene, scene.motion.given.seconds);
  return scene;
}

ItemNumbers::Run ItemNumbers::find(std::uint32_t triangle) const {
  const auto isBehind = [](std::uint32_t t, const Run& run) { return t < run.first; };
  Run run = *(std::upper_bound(runs_.begin(), runs_.end(), triangle, isBehind) - 1);
  run.number += triangle - run.first;
  run.first = triangle;
  return run;
}

Scene::HitNumbers Scene::numbersOf(std::uint32_t triangle, std::uint32_t instance) const {
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
  for (const Texture& t : textures) bytes += t.shared->keptBytes();
  return bytes;
}

void validate(const std::string& scene, const Sky& sky, const Ambient& ambient) {
  const std::string prefix = scene.empty() ? "" : scene + ": ";
  checkMembers(sky, prefix + "sky");
  checkMembers(ambient, prefix + "ambient");
}

void validate(const SceneDescription& description) {
  checkLights(description);
  for (const auto i : indices(description.materials)) {
    const Material& material = description.materials[i];
    checkMembers(material, place(description.name, "material", i, material.name));
  }
  validate(description.name, description.sky, description.ambient);
  checkInstances(description);
}

void boundInstances(Scene& scene, const std::vector<Box>& boxes, Warnings& warnings) {
  // A ray from anywhere has to stay within Embree's range in the space of each instance.
  const float farthest = farthestStart(scene, boxes);
  const auto lost = std::erase_if(scene.instances, [&](const InstanceRecord& instance) {
    return !(instanceReach(instance.toWorld) > farthest);
  });
  warnings.add("instance too small or too flat to be traced left out", scene.name, lost);

  Box box = boxes[0];
  for (const InstanceRecord& instance : scene.instances) addInstance(scene, instance, boxes, box);
  countInstanced(scene);
  if (scene.instancedTriangles + scene.instancedSpheres == 0) return;
  scene.lower = box.lower;
  scene.upper = box.upper;
}

void countInstanced(Scene& scene) {
  scene.instancedTriangles = scene.geometries[0].index.size();
  scene.instancedSpheres = scene.geometries[0].spheres;
  for (const InstanceRecord& instance : scene.instances) {
    scene.instancedTriangles += scene.geometries[instance.geometry].index.size();
    scene.instancedSpheres += scene.geometries[instance.geometry].spheres;
  }
}

float instanceReach(const Affine& toWorld) {
  // Far from where products of three floats lose bits or leave their range.
  constexpr double kSmallest = 1e-35, kLargest = 1e35;
  const double determinant = std::abs(toWorld.determinant());
  if (!(determinant >= kSmallest && determinant <= kLargest)) return 0;

  // Bounds of the inverse map: how much it lengthens coordinates, and how far it shifts them.
  const std::array<Vec3d, 3> adjoint{cross(toWorld.y, toWorld.z), cross(toWorld.z, toWorld.x),
                                     cross(toWorld.x, toWorld.y)};
  double stretch = 0, shift = 0;
  for (const Vec3d& row : adjoint) {
    const Vec3d size = abs(row);
    if (!(maxComponent(size) <= kLargest)) return 0;
    stretch = std::max(stretch, (size.x + size.y + size.z) / determinant);
    shift = std::max(shift, dot(size, abs(toWorld.p)) / determinant);
  }
  // Half of the range is reserved for the rounding of these computations.
  const double room = 0.5 * kLargestCoordinate - shift;
  return room > 0 ? static_cast<float>(std::min<double>(room / stretch, kLargestCoordinate)) : 0.0f;
}

}  // namespace whit
