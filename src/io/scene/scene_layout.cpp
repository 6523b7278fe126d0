#include "io/scene/scene_layout.h"

#include "core/error.h"

namespace whit {

std::uint64_t bytesOf(const Mesh& mesh) {
  return mesh.positions.size() * sizeof(Vec3f) + mesh.normals.size() * sizeof(Vec3f) +
         (mesh.uvs.size() + mesh.secondUvs.size()) * sizeof(Vec2f) +
         mesh.colors.size() * sizeof(Rgb) + mesh.triangles.size() * 3 * sizeof(std::uint32_t) +
         mesh.spheres.size() * sizeof(Affine) + mesh.materials.size() * sizeof(std::uint32_t);
}

std::uint32_t SceneLayout::add(const std::string& name) {
  bodies_.emplace_back().name = name;
  return static_cast<std::uint32_t>(bodies_.size() - 1);
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

// A body that is met again may be met deeper than before.
int SceneLayout::measure(std::uint32_t index, int depth, std::vector<std::uint32_t>& order) {
  Body& body = bodies_[index];
  if (depth + std::max(body.height, 1) > kNestingLimit) {
    throwLimit("objects are nested deeper than " + std::to_string(kNestingLimit));
  }
  if (body.height > 0) return body.height;
  int height = 1;
  Standing& within = body.within;
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
  return body.height = height;
}

void SceneLayout::moveTo(SceneDescription& scene) {
  std::vector<std::uint32_t> order;
  measure(0, 0, order);
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
  place({.body = 0}, Affine(), kNoNode, {}, scene);
}

// The last user of a mesh gets it, others a copy.
Mesh SceneLayout::take(Placement& placed, const std::string& body) {
  const std::shared_ptr<Mesh> mesh = std::move(placed.mesh);
  if (mesh.use_count() == 1) return std::move(*mesh);
  budget_.charge(1, bytesOf(*mesh), "object " + body);
  return *mesh;
}

void SceneLayout::placeOnce(Body& body, const Affine& toWorld, Standing at,
                            SceneDescription& scene) {
  for (Placement& placed : body.placements) {
    if (!placed.isMesh()) continue;
    Mesh mesh = take(placed, body.name);
    scene.instances.push_back({static_cast<std::uint32_t>(scene.objects.size()),
                               toWorld * placed.toParent, at.rank + placed.at.rank, kNoNode,
                               at.item + placed.at.item});
    scene.objects.push_back({mesh.name, {}});
    scene.objects.back().meshes.push_back(std::move(mesh));
  }
}

void SceneLayout::addObject(Body& body, SceneDescription& scene) {
  body.object = static_cast<std::uint32_t>(scene.objects.size());
  Object object{body.name, {}};
  for (Placement& placed : body.placements) {
    if (!placed.isMesh()) continue;
    Mesh mesh = take(placed, body.name);
    if (!(placed.toParent == Affine())) transform(mesh, placed.toParent);
    mesh.rank = placed.at.rank;
    mesh.item = static_cast<std::uint32_t>(placed.at.item);
    object.meshes.push_back(std::move(mesh));
  }
  scene.objects.push_back(std::move(object));
}

void SceneLayout::place(const Placement& placed, const Affine& toMover, std::uint32_t mover,
                        Standing at, SceneDescription& scene) {
  Body& body = bodies_[placed.body];
  for (const Placement& own : body.placements) {
    const std::uint64_t number = at.item + own.at.item;
    if (number >= scene.itemNames.size()) break;
    if (!own.isMesh()) continue;
    const ItemName& name = own.item ? own.item : placed.item;
    scene.itemNames[number] = name ? *name : body.name;
  }
  if (body.places == 1 && mover == kNoNode) {
    placeOnce(body, toMover, at, scene);
  } else if (body.hasMeshes()) {
    if (body.object == kNoObject) addObject(body, scene);
    scene.instances.push_back({body.object, toMover, at.rank, mover, at.item});
  }
  for (const Placement& child : body.placements) {
    if (child.isMesh()) continue;
    const Affine toChild = toMover * child.toParent;
    Standing ofChild = at;
    ofChild += child.at;
    if (child.motion) {
      const auto node = static_cast<std::uint32_t>(scene.motion.rig.size());
      budget_.charge(1, sizeof(RigNode), "what moves");
      scene.motion.rig.push_back({mover, toChild, child.motion, child.mover});
      place(child, Affine(), node, ofChild, scene);
    } else {
      place(child, toChild, mover, ofChild, scene);
    }
  }
}

}  // namespace whit
