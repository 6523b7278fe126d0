#include "io/scene/scene_layout.h"

#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "scene/origin.h"

namespace whit {

std::uint64_t bytesOf(const Mesh& mesh) {
  return mesh.positions.size() * sizeof(Vec3f) + mesh.normals.size() * sizeof(Vec3f) +
         (mesh.uvs.size() + mesh.secondUvs.size()) * sizeof(Vec2f) +
         mesh.colors.size() * sizeof(Rgb) + mesh.triangles.size() * 3 * sizeof(std::uint32_t) +
         mesh.spheres.size() * sizeof(Affine) + mesh.materials.size() * sizeof(std::uint32_t);
}

namespace {

// Adds the box `own`, moved by `map`.
void addMoved(const BoxOf<Vec3d>& own, const Affine& map, BoxOf<Vec3d>& box) {
  if (own.empty()) return;
  for (int corner = 0; corner < 8; ++corner) box.add(map.point(own.corner(corner)));
}

BoxOf<Vec3d> boundsOfMesh(const Mesh& mesh) {
  // Vertices that no triangle uses are no part of the mesh. Indices are not validated yet.
  Box corners;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      if (corner < mesh.positions.size()) corners.add(mesh.positions[corner]);
    }
  }

  BoxOf<Vec3d> box;
  if (!corners.empty()) box = {Vec3d(corners.lower), Vec3d(corners.upper)};
  const BoxOf<Vec3d> unit{Vec3d(-1.0), Vec3d(1.0)};
  for (const Affine& sphere : mesh.spheres) addMoved(unit, sphere, box);
  return box;
}

}  // namespace

std::uint32_t SceneLayout::add(const std::string& name) {
  bodies_.emplace_back().name = name;
  return size32(bodies_) - 1;
}

void SceneLayout::append(const Body& from, const std::vector<Affine>& placements, Body& to) {
  budget_.charge(from.placements.size() * sizeof(Placement), placements.size(), "repeated items");
  for (const Affine& placement : placements) {
    for (const Placement& placed : from.placements) {
      to.placements.push_back(placed);
      to.placements.back().toParent = placement * placed.toParent;
    }
  }
}

// A body that is reached again may lie deeper than before.
int SceneLayout::measure(std::uint32_t index, int depth, std::vector<std::uint32_t>& order) {
  Body& body = bodies_[index];
  if (depth + std::max(body.height, 1) > kNestingLimit) {
    throwLimit(concat("objects are nested deeper than ", kNestingLimit));
  }
  if (body.height > 0) return body.height;

  int height = 1;
  OrderNumbers& within = body.within;
  for (Placement& placed : body.placements) {
    if (placed.isMesh()) {
      if (!placed.goesOn) ++within.item;
      placed.at = {within.rank++, within.item - 1};
    } else {
      placed.at = within;
      height = std::max(height, 1 + measure(placed.body, depth + 1, order));
      within += bodies_[placed.body].within;
    }
  }

  order.push_back(index);
  body.height = height;
  return height;
}

// Returns the bounds of the body at 0 s. The bodies that it holds must have their boxes.
BoxOf<Vec3d> SceneLayout::boundsOf(const Body& body) const {
  BoxOf<Vec3d> box;
  for (const Placement& placed : body.placements) {
    const Affine map = placed.motion ? placed.toParent * (*placed.motion)(0) : placed.toParent;
    addMoved(placed.isMesh() ? boundsOfMesh(*placed.mesh) : bodies_[placed.body].box, map, box);
  }
  return box;
}

Vec3d SceneLayout::measureScene(SceneDescription& scene) {
  std::vector<std::uint32_t> order;
  measure(0, 0, order);
  for (const std::uint32_t index : order) bodies_[index].box = boundsOf(bodies_[index]);

  // A body is placed as often as all bodies that hold it together.
  double instances = 0;  // may be more than an integer can hold
  bodies_[0].places = 1;
  for (auto index = order.rbegin(); index != order.rend(); ++index) {
    const Body& body = bodies_[*index];
    instances += body.places;
    for (const Placement& placed : body.placements) {
      if (!placed.isMesh()) bodies_[placed.body].places += body.places;
    }
  }

  constexpr double kMany = 1e18;
  budget_.charge(static_cast<std::uint64_t>(std::min(instances, kMany)), sizeof(Instance),
                 "instances");

  scene.items = bodies_[0].within.item;
  scene.itemNames.resize(std::min<std::uint64_t>(scene.items, kNamedItems));

  return originOf(bodies_[0].box);
}

Vec3d SceneLayout::moveTo(SceneDescription& scene) {
  const Vec3d origin = measureScene(scene);
  place({.body = 0}, Affine(), kNoNode, {}, scene);
  return origin;
}

Vec3d SceneLayout::moveToOrigin(SceneDescription& scene) {
  const Vec3d origin = measureScene(scene);
  const bool isFar = origin != Vec3d();
  if (isFar) scene.origin = origin;
  place({.body = 0}, isFar ? Affine::translation(-origin) : Affine(), kNoNode, {}, scene);
  return origin;
}

// Hands the mesh to its last user, and a copy to the others.
Mesh SceneLayout::take(Placement& placed, const std::string& body) {
  const std::shared_ptr<Mesh> mesh = std::move(placed.mesh);
  if (mesh.use_count() == 1) return std::move(*mesh);
  budget_.charge(1, bytesOf(*mesh), "object " + body);
  return *mesh;
}

void SceneLayout::placeOnce(Body& body, const Affine& toWorld, OrderNumbers at,
                            SceneDescription& scene) {
  for (Placement& placed : body.placements) {
    if (!placed.isMesh()) continue;
    Mesh mesh = take(placed, body.name);
    scene.instances.push_back({size32(scene.objects), toWorld * placed.toParent,
                               at.rank + placed.at.rank, kNoNode, at.item + placed.at.item});
    scene.objects.push_back({mesh.name, {}});
    scene.objects.back().meshes.push_back(std::move(mesh));
  }
}

void SceneLayout::addObject(Body& body, SceneDescription& scene) {
  body.object = size32(scene.objects);
  BoxOf<Vec3d> box;
  const Placement* bent = nullptr;
  for (const Placement& placed : body.placements) {
    if (!placed.isMesh()) continue;
    addMoved(boundsOfMesh(*placed.mesh), placed.toParent, box);
    // Meshes that bend stay as they are: all of the body's have the same Deformation::origin.
    if (placed.mesh->deformation) bent = &placed;
  }
  body.origin = bent ? bent->toParent.p : originOf(box);

  Object object{body.name, {}};
  for (Placement& placed : body.placements) {
    if (!placed.isMesh()) continue;

    Mesh mesh = take(placed, body.name);
    Affine toObject = placed.toParent;
    toObject.p = toObject.p - body.origin;
    if (!(toObject == Affine())) transform(mesh, toObject);

    mesh.rank = placed.at.rank;
    mesh.item = static_cast<std::uint32_t>(placed.at.item);
    object.meshes.push_back(std::move(mesh));
  }
  scene.objects.push_back(std::move(object));
}

void SceneLayout::place(const Placement& placed, const Affine& toMover, std::uint32_t mover,
                        OrderNumbers at, SceneDescription& scene) {
  Body& body = bodies_[placed.body];

  // The items get their names.
  for (const Placement& own : body.placements) {
    const std::uint64_t number = at.item + own.at.item;
    if (number >= scene.itemNames.size()) break;
    if (!own.isMesh()) continue;
    const ItemName& name = own.item ? own.item : placed.item;
    scene.itemNames[number] = name ? *name : body.name;
  }

  // The meshes go into the world, or become an object that has an instance here.
  if (body.places == 1 && mover == kNoNode) {
    placeOnce(body, toMover, at, scene);
  } else if (body.hasMeshes()) {
    if (body.object == kNoObject) addObject(body, scene);
    const bool isMoved = body.origin != Vec3d();
    const Affine toObject = isMoved ? toMover * Affine::translation(body.origin) : toMover;
    scene.instances.push_back({body.object, toObject, at.rank, mover, at.item});
  }

  // The bodies in it follow; one that moves is carried by a node of its own.
  for (const Placement& child : body.placements) {
    if (child.isMesh()) continue;
    const Affine toChild = toMover * child.toParent;
    OrderNumbers ofChild = at;
    ofChild += child.at;
    if (child.motion) {
      const auto node = size32(scene.motion.rig);
      budget_.charge(1, sizeof(RigNode), "what moves");
      scene.motion.rig.push_back({mover, toChild, child.motion, child.mover});
      place(child, Affine(), node, ofChild, scene);
    } else {
      place(child, toChild, mover, ofChild, scene);
    }
  }
}

}  // namespace whit
