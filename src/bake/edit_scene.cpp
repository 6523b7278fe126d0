#include "bake/edit_scene.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "bake/bake_triangles.h"
#include "bake/finalize_steps.h"
#include "bake/sphere.h"
#include "core/error.h"
#include "core/index.h"
#include "core/machine_limits.h"
#include "core/warnings.h"
#include "scene/members.h"

namespace whit {

namespace {

// True if replacing one material by the other neither adds nor removes an effect or a medium.
bool sameKind(const Material& a, const Material& b) {
  const bool sameMedium = !a.boundsMedium() || (a.ior == b.ior && a.absorption == b.absorption &&
                                                a.priority == b.priority);
  return sameMedium && a.boundsMedium() == b.boundsMedium() && effectsOf(a) == effectsOf(b);
}

bool sameKindOfLight(const Light& a, const Light& b) {
  return a.kind == b.kind && hasExtent(a) == hasExtent(b) &&
         isBlack(a.intensity) == isBlack(b.intensity);
}

// Returns whether both skies are known to differ at most in brightness and rotation.
bool sameBlurredSky(const Sky& a, const Sky& b) {
  if (a.kind != b.kind) return false;
  if (a.kind == Sky::Kind::image) return !a.name.empty() && a.name == b.name;
  return a.zenith == b.zenith && a.horizon == b.horizon && a.ground == b.ground;
}

void keepBaked(const Material& from, Material& to) {
  const Material next = to;
  forEachMember<Material>([&](const auto& member) {
    if (member.rules.baked) to.*member.field = from.*member.field;
  });

  // No triangle depends on these maps, so they can be left out.
  for (auto map : {&Material::roughnessMap, &Material::mirrorMap, &Material::transmissionMap}) {
    if (next.*map == kNoTexture) to.*map = kNoTexture;
  }
}

void moveCamera(const Scene& scene, const MovingCamera& moving, const std::vector<Affine>& poses,
                double seconds, Camera& camera) {
  if (moving.node != kNoNode) {
    carry(moving.own, poses[moving.node], camera);
    return;
  }

  camera = cameraAt(scene.cameraPath, seconds);
  camera.name = moving.own.name;
}

void moveView(Scene& scene, const std::vector<Affine>& poses, double seconds) {
  for (const MovingCamera& moving : scene.motion.given.cameras) {
    moveCamera(scene, moving, poses, seconds, scene.cameras[moving.camera]);
  }
  for (const MovingLight& moving : scene.motion.given.lights) {
    carry(moving, poses[moving.node], scene.lights[moving.light]);
  }
}

void setCorners(const Geometry& geometry, const std::array<std::uint32_t, 3>& corners,
                TriangleRecord& record) {
  for (const auto i : indices(3)) {
    const Vec3f& p = geometry.position[corners[i]];
    std::copy_n(&p.x, 3, record.position + 3 * i);
  }
}

// `normals` are those of the bent vertices, by their places among them; the face's where there are
// none or where one has no direction.
void setNormals(const std::vector<Vec3f>& normals, const std::array<std::uint32_t, 3>& places,
                const TriangleRecord& triangle, NormalRecord& record) {
  const Vec3f face(faceNormal(triangle));
  for (const auto i : indices(3)) {
    Vec3f n = normals.empty() ? face : normals[places[i]];
    if (n == Vec3f()) n = face;
    std::copy_n(&n.x, 3, record.normal + 3 * i);
  }
}

template <std::size_t kCount>
void swapLastCorners(float (&values)[kCount]) {
  std::swap_ranges(values + kCount / 3, values + 2 * kCount / 3, values + 2 * kCount / 3);
}

// Reverses the winding of a triangle. bend() sets its positions and normals.
void turnOver(std::uint32_t triangle, std::array<std::uint32_t, 3>& corners, Scene& scene) {
  std::swap(corners[1], corners[2]);
  swapLastCorners(scene.triangles[triangle].uv);
  if (!scene.secondUvs.empty()) swapLastCorners(scene.secondUvs[triangle].uv);
  if (!scene.colors.empty()) swapLastCorners(scene.colors[triangle].color);
}

void bend(Scene& scene, BentVertices& bent, double seconds) {
  Geometry& geometry = scene.geometries[bent.geometry];
  DeformedVertices vertices = deformVertices(*bent.deformation, poseAt(*bent.deformation, seconds));
  // The loader has wound the triangles for the pose at 0 s, for which this is called first.
  if (bent.sides.empty()) bent.sides = vertices.sides;

  std::ranges::copy(vertices.positions, geometry.position.begin() + bent.firstVertex);
  const std::size_t count = vertices.positions.size();

  for (const auto i : indices(geometry.index)) {
    auto& corners = geometry.index[i];
    if (corners[0] < bent.firstVertex || corners[0] - bent.firstVertex >= count) continue;

    const auto number = static_cast<std::uint32_t>(geometry.firstTriangle + i);
    std::array<std::uint32_t, 3> places = corners;
    for (std::uint32_t& place : places) place -= bent.firstVertex;

    // A triangle that the skin begins or ceases to mirror is wound the other way round.
    if (turnsOver(bent.sides, places) != turnsOver(vertices.sides, places)) {
      turnOver(number, corners, scene);
      std::swap(places[1], places[2]);
    }

    TriangleRecord& record = scene.triangles[number];
    setCorners(geometry, corners, record);
    if (scene.normals.empty()) continue;
    setNormals(vertices.normals, places, record, scene.normals[number]);
  }
  bent.sides = std::move(vertices.sides);
}

Box boxOf(const Scene& scene, const Geometry& geometry) {
  Box box;
  for (const auto& corners : geometry.index) {
    for (const std::uint32_t corner : corners) box.add(geometry.position[corner]);
  }

  for (std::uint32_t i = 0; i < geometry.spheres; ++i) {
    const Box own = sphereBounds(sphereMap(scene.triangles[geometry.firstSphere + i]));
    box.add(own.lower);
    box.add(own.upper);
  }
  return box;
}

// True if the coplanar triangles found at 0 s are used again. They refer to instances by index, so
// the same instances have to be left. Where these stand elsewhere, surfaces may have met since. A
// scene of many triangles leaves such meetings to Embree, because a search takes longer than its
// frames.
bool servesAtStart(const Scene& scene) {
  const std::vector<InstanceRecord>& atStart = scene.motion.instancesAtStart;
  const auto areEqual = [&](auto InstanceRecord::*member) {
    return std::ranges::equal(scene.instances, atStart, {}, member, member);
  };
  if (!scene.motion.isSearched || !areEqual(&InstanceRecord::written)) return false;
  return scene.instancedTriangles > kMostSearchedInMotion || areEqual(&InstanceRecord::toWorld);
}

bool setMotion(const std::string& name, const SharedMotion& motion, Rig& rig) {
  bool found = false;
  for (RigNode& node : rig) {
    if (node.name.empty() || node.name != name) continue;  // most have none
    node.motion = motion;
    found = true;
  }
  return found;
}

}  // namespace

void editShading(Scene& scene, std::vector<Material> materials, std::vector<Light> lights) {
  if (materials.size() != scene.materials.size() || lights.size() != scene.lights.size()) {
    throwUsage("an edit cannot change the number of materials or lights");
  }

  // The new values are validated before the scene changes.
  SceneDescription d;
  d.name = scene.name;
  d.lights = lights;
  d.materials = materials;
  validate(d);
  for (const auto i : indices(materials)) keepBaked(scene.materials[i], materials[i]);

  const bool kindsStay = std::ranges::equal(materials, scene.materials, sameKind) &&
                         std::ranges::equal(lights, scene.lights, sameKindOfLight);
  scene.materials.swap(materials);
  scene.lights.swap(lights);
  if (kindsStay) return;

  try {
    numberMedia(scene);
  } catch (...) {  // too many media
    scene.materials.swap(materials);
    scene.lights.swap(lights);
    numberMedia(scene);
    throw;
  }
  gatherEffects(scene);
}

void editSky(Scene& scene, Sky& sky, const Ambient& ambient) {
  validate(scene.name, sky, ambient);
  if (!sameBlurredSky(scene.sky, sky)) scene.blurredSky = EnvironmentImage();
  std::swap(scene.sky, sky);
  scene.ambient = ambient;
  gatherEffects(scene);
}

Camera cameraAt(const Scene& scene, std::size_t camera, double seconds) {
  const SceneMotion& motion = scene.motion.given;
  const auto moving = std::ranges::find(motion.cameras, camera, &MovingCamera::camera);
  if (moving == motion.cameras.end()) return scene.cameras[camera];

  Camera carried = moving->own;
  moveCamera(scene, *moving, poseRig(motion.rig, seconds), seconds, carried);
  return carried;
}

void setPlace(Scene& scene, const std::string& pointer, const Affine& place) {
  const SharedMotion motion = fixedMotion(place);
  bool found = setMotion(pointer, motion, scene.motion.given.rig);

  // Joints of skeletons can be placed too.
  for (BentVertices& bent : scene.motion.bent) {
    if (!bent.deformation->hasSkin()) continue;
    Rig skeleton = *bent.deformation->skeleton;
    if (!setMotion(pointer, motion, skeleton)) continue;

    Deformation deformation = *bent.deformation;  // other scenes may share it
    deformation.skeleton = std::make_shared<const Rig>(std::move(skeleton));
    bent.deformation = std::make_shared<const Deformation>(std::move(deformation));
    found = true;
  }

  if (!found) {
    throwUsage("\"" + pointer + "\" is not among what was to be moved when " + scene.name +
               " was loaded");
  }
}

void moveScene(Scene& scene, double seconds) {
  BakedMotion& motion = scene.motion;
  if (motion.empty()) return;

  const std::vector<Affine> poses = poseRig(motion.given.rig, seconds);
  moveView(scene, poses, seconds);
  if (!motion.ofGeometry) return;

  for (BentVertices& bent : motion.bent) {
    bend(scene, bent, seconds);
    motion.boxes[bent.geometry] = boxOf(scene, scene.geometries[bent.geometry]);
  }

  // All instances take part again, including those that were too flat at an earlier time.
  scene.instances = motion.instances;
  for (InstanceRecord& instance : scene.instances) {
    if (instance.mover != kNoNode) instance.toWorld = poses[instance.mover] * instance.toMover;
  }

  Warnings expected;  // instances that are flattened at times
  boundInstances(scene, motion.boxes, expected);
  scene.coincidentSpheres = findCoincidentSpheres(scene, motion.order);

  if (servesAtStart(scene)) {
    scene.coplanar = motion.coplanarAtStart;
    return;
  }

  bool complete = true;
  scene.coplanar = findCoplanarTriangles(scene, usableThreads(), complete);
  scene.coplanar.rankBy(scene, motion.order);
  if (std::exchange(motion.isSearched, true)) return;

  motion.coplanarAtStart = scene.coplanar;
  motion.instancesAtStart = scene.instances;
}

}  // namespace whit
