#include "io/scene/scene_layout.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/error.h"

namespace whit {
namespace {

constexpr std::uint32_t kNoObject = 0xffffffffu;

std::uint64_t saturatingSum(std::uint64_t a, std::uint64_t b) {
  constexpr std::uint64_t kMany = std::numeric_limits<std::uint64_t>::max();
  return a > kMany - b ? kMany : a + b;
}

// Bodies reachable from `body`, each behind all that it holds.
class BodyOrder {
 public:
  explicit BodyOrder(const std::deque<Body>& bodies) : bodies_(bodies), heights_(bodies.size()) {}

  std::vector<std::uint32_t> below(std::uint32_t body) {
    visit(body, 0);
    return std::move(order_);
  }

 private:
  // How many bodies are within one another, from `body` down. A body that is met again may be met
  // deeper than before.
  int visit(std::uint32_t body, int depth) {
    if (depth + std::max(heights_[body], 1) > kNestingLimit) {
      throwLimit("objects are nested deeper than " + std::to_string(kNestingLimit));
    }
    if (heights_[body] > 0) return heights_[body];
    int height = 1;
    for (const Placement& child : bodies_[body].children) {
      height = std::max(height, 1 + visit(child.body, depth + 1));
    }
    order_.push_back(body);
    return heights_[body] = height;
  }

  const std::deque<Body>& bodies_;
  std::vector<int> heights_;  // 0: not met yet
  std::vector<std::uint32_t> order_;
};

}  // namespace

std::uint64_t bytesOf(const Mesh& mesh) {
  return mesh.positions.size() * sizeof(Vec3f) + mesh.normals.size() * sizeof(Vec3f) +
         (mesh.uvs.size() + mesh.secondUvs.size()) * sizeof(Vec2f) +
         mesh.colors.size() * sizeof(Rgb) + mesh.triangles.size() * 3 * sizeof(std::uint32_t) +
         mesh.spheres.size() * sizeof(Affine) +
         (mesh.materials.size() + mesh.order.size()) * sizeof(std::uint32_t);
}

void SceneLayout::Standing::operator+=(const Standing& more) {
  rank = saturatingSum(rank, more.rank);
  item = saturatingSum(item, more.item);
}

std::uint32_t SceneLayout::add(const std::string& name) {
  bodies_.push_back({name, {}, {}, {}});
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
      to.parts.push_back({part.mesh, placement * part.toBody, part.mingles, items + part.item});
    }
    to.items.insert(to.items.end(), from.items.begin(), from.items.end());
    for (const Placement& child : from.children) {
      to.children.push_back({child.body, placement * child.toParent, before + child.partsBefore,
                             child.motion, child.mover, child.item});
    }
  }
}

void SceneLayout::moveTo(SceneDescription& scene) {
  const std::vector<std::uint32_t> order = BodyOrder(bodies_).below(0);
  counts_.assign(bodies_.size(), 0);
  objects_.assign(bodies_.size(), kNoObject);
  counts_[0] = 1;
  std::uint64_t instances = 0;
  for (auto body = order.rbegin(); body != order.rend(); ++body) {
    instances = saturatingSum(instances, counts_[*body]);
    for (const Placement& child : bodies_[*body].children) {
      counts_[child.body] = saturatingSum(counts_[child.body], counts_[*body]);
    }
  }
  budget_.charge(instances, sizeof(Instance), "instances");
  within_.assign(bodies_.size(), {});
  for (const std::uint32_t body : order) {
    within_[body] = {bodies_[body].parts.size(), bodies_[body].itemCount()};
    for (const Placement& child : bodies_[body].children) within_[body] += within_[child.body];
  }
  scene.items = within_[0].item;
  scene.itemNames.resize(std::min<std::uint64_t>(scene.items, kNamedItems));
  place({0, Affine()}, Affine(), kNoNode, {}, scene);
}

std::vector<SceneLayout::Standing> SceneLayout::standingsOfParts(const Body& body) const {
  std::vector<Standing> standings(body.parts.size());
  Standing children;
  auto child = body.children.begin();
  for (std::size_t i = 0; i < standings.size(); ++i) {
    for (; child != body.children.end() && child->partsBefore <= i; ++child) {
      children += within_[child->body];
    }
    standings[i] = children;
    standings[i] += {i, body.parts[i].item};
    if (body.parts[i].mingles) standings[i].rank = standings[i - 1].rank;
  }
  return standings;
}

// Names the body's own items; `first` is the number of the first item within the body.
void SceneLayout::nameItems(const Body& body, const ItemName& placed, std::uint64_t first,
                            SceneDescription& scene) const {
  if (first >= scene.itemNames.size()) return;
  const std::vector<Standing> standings = standingsOfParts(body);
  for (std::size_t i = 0; i < standings.size(); ++i) {
    const std::uint64_t number = saturatingSum(first, standings[i].item);
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
    if (!part.mingles) {
      scene.instances.push_back({static_cast<std::uint32_t>(scene.objects.size()),
                                 toWorld * part.toBody, at.rank + standings[i].rank, kNoNode,
                                 saturatingSum(at.item, standings[i].item)});
      scene.objects.push_back({mesh.name, {}});
    }
    scene.objects.back().meshes.push_back(std::move(mesh));
  }
}

void SceneLayout::addObject(std::uint32_t index, SceneDescription& scene) {
  Body& body = bodies_[index];
  objects_[index] = static_cast<std::uint32_t>(scene.objects.size());
  const std::vector<Standing> standings = standingsOfParts(body);
  Object object{body.name, {}};
  for (std::size_t i = 0; i < body.parts.size(); ++i) {
    Mesh mesh = take(body.parts[i], body.name);
    if (!(body.parts[i].toBody == Affine())) transform(mesh, body.parts[i].toBody);
    mesh.rank = standings[i].rank;
    mesh.item = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(standings[i].item, std::numeric_limits<std::uint32_t>::max()));
    object.meshes.push_back(std::move(mesh));
  }
  scene.objects.push_back(std::move(object));
}

void SceneLayout::place(const Placement& placed, const Affine& toMover, std::uint32_t mover,
                        Standing at, SceneDescription& scene) {
  const std::uint32_t index = placed.body;
  Body& body = bodies_[index];
  nameItems(body, placed.item, at.item, scene);
  if (counts_[index] == 1 && mover == kNoNode) {
    placeOnce(body, toMover, at, scene);
  } else if (!body.parts.empty()) {
    if (objects_[index] == kNoObject) addObject(index, scene);
    scene.instances.push_back({objects_[index], toMover, at.rank, mover, at.item});
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
    at += within_[child.body];
  }
}

}  // namespace whit
