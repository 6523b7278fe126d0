#include "io/scene/scene_layout.h"

#include <algorithm>
#include <utility>

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
  budget_.charge(from.parts.size() * sizeof(BodyPart) + from.children.size() * sizeof(Placement) +
                     from.items.size() * sizeof(ItemName),
                 placements.size(), "repeated items");
  for (const Affine& placement : placements) {
    const std::size_t before = to.parts.size();
    const auto items = static_cast<std::uint32_t>(to.items.size());
    for (const BodyPart& part : from.parts) {
      to.parts.push_back({part.mesh, placement * part.toBody, items + part.item});
    }
    to.items.insert(to.items.end(), from.items.begin(), from.items.end());
    for (const Placement& child : from.children) {
      to.children.push_back({child.body, placement * child.toParent, before + child.partsBefore,
                             child.motion, child.mover, child.item});
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
  body.within = {body.parts.size(), body.itemCount()};
  for (const Placement& child : body.children) {
    height = std::max(height, 1 + measure(child.body, depth + 1, order));
    body.within += bodies_[child.body].within;
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
    for (const Placement& child : body.children) bodies_[child.body].places += body.places;
  }
  constexpr double kMany = 1e18;
  budget_.charge(static_cast<std::uint64_t>(std::min(instances, kMany)), sizeof(Instance),
                 "instances");
  scene.items = bodies_[0].within.item;
  scene.itemNames.resize(std::min<std::uint64_t>(scene.items, kNamedItems));
  place({0, Affine()}, Affine(), kNoNode, {}, scene);
}

std::vector<Standing> SceneLayout::standingsOfParts(const Body& body) const {
  std::vector<Standing> standings(body.parts.size());
  Standing children;
  auto child = body.children.begin();
  for (std::size_t i = 0; i < standings.size(); ++i) {
    for (; child != body.children.end() && child->partsBefore <= i; ++child) {
      children += bodies_[child->body].within;
    }
    standings[i] = children;
    standings[i] += {i, body.parts[i].item};
  }
  return standings;
}

// Names the body's own items; `first` is the number of the first item within the body.
void SceneLayout::nameItems(const Body& body, const ItemName& placed, std::uint64_t first,
                            SceneDescription& scene) const {
  if (first >= scene.itemNames.size()) return;
  const std::vector<Standing> standings = standingsOfParts(body);
  for (std::size_t i = 0; i < standings.size(); ++i) {
    const std::uint64_t number = first + standings[i].item;
    if (number >= scene.itemNames.size()) continue;
    const ItemName& own = body.items.empty() ? placed : body.items[body.parts[i].item];
    scene.itemNames[number] = own ? *own : body.name;
  }
}

// The last user of a mesh gets it, others a copy.
Mesh SceneLayout::take(BodyPart& part, const std::string& body) {
  const std::shared_ptr<Mesh> mesh = std::move(part.mesh);
  if (mesh.use_count() == 1) return std::move(*mesh);
  budget_.charge(1, bytesOf(*mesh), "object " + body);
  return *mesh;
}

void SceneLayout::placeOnce(Body& body, const Affine& toWorld, Standing at,
                            SceneDescription& scene) {
  const std::vector<Standing> standings = standingsOfParts(body);
  for (std::size_t i = 0; i < body.parts.size(); ++i) {
    BodyPart& part = body.parts[i];
    Mesh mesh = take(part, body.name);
    scene.instances.push_back({static_cast<std::uint32_t>(scene.objects.size()),
                               toWorld * part.toBody, at.rank + standings[i].rank, kNoNode,
                               at.item + standings[i].item});
    scene.objects.push_back({mesh.name, {}});
    scene.objects.back().meshes.push_back(std::move(mesh));
  }
}

void SceneLayout::addObject(Body& body, SceneDescription& scene) {
  body.object = static_cast<std::uint32_t>(scene.objects.size());
  const std::vector<Standing> standings = standingsOfParts(body);
  Object object{body.name, {}};
  for (std::size_t i = 0; i < body.parts.size(); ++i) {
    Mesh mesh = take(body.parts[i], body.name);
    if (!(body.parts[i].toBody == Affine())) transform(mesh, body.parts[i].toBody);
    mesh.rank = standings[i].rank;
    mesh.item = static_cast<std::uint32_t>(standings[i].item);
    object.meshes.push_back(std::move(mesh));
  }
  scene.objects.push_back(std::move(object));
}

void SceneLayout::place(const Placement& placed, const Affine& toMover, std::uint32_t mover,
                        Standing at, SceneDescription& scene) {
  Body& body = bodies_[placed.body];
  nameItems(body, placed.item, at.item, scene);
  if (body.places == 1 && mover == kNoNode) {
    placeOnce(body, toMover, at, scene);
  } else if (!body.parts.empty()) {
    if (body.object == kNoObject) addObject(body, scene);
    scene.instances.push_back({body.object, toMover, at.rank, mover, at.item});
  }
  for (const Placement& child : body.children) {
    const Affine toChild = toMover * child.toParent;
    Standing ofChild = at;
    ofChild += {child.partsBefore, body.itemsBefore(child.partsBefore)};
    if (child.motion) {
      const auto node = static_cast<std::uint32_t>(scene.motion.rig.size());
      budget_.charge(1, sizeof(RigNode), "what moves");
      scene.motion.rig.push_back({mover, toChild, child.motion, child.mover});
      place(child, Affine(), node, ofChild, scene);
    } else {
      place(child, toChild, mover, ofChild, scene);
    }
    at += bodies_[child.body].within;
  }
}

}  // namespace whit
