// The layout of a scene while its file is read: bodies that hold meshes and other bodies.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/affine.h"
#include "io/memory_budget.h"
#include "scene/description.h"

namespace whit {

// Limit on items within items, by "group" or "use".
inline constexpr int kNestingLimit = 256;

inline constexpr std::uint32_t kNoObject = 0xffffffffu, kNoBody = 0xffffffffu;

// Returns the memory that a mesh takes.
std::uint64_t bytesOf(const Mesh& mesh);

using ItemName = std::shared_ptr<const std::string>;

// The number of a mesh and that of its item, both in the order of the scene file.
struct OrderNumbers {
  std::uint64_t rank = 0, item = 0;

  void operator+=(const OrderNumbers& more) {
    rank += more.rank;
    item += more.item;
  }
};

// A mesh or a body, where it stands in another body.
struct Placement {
  std::uint32_t body = kNoBody;          // kNoBody: `mesh` is placed
  std::shared_ptr<Mesh> mesh = nullptr;  // shared by its copies
  Affine toParent = {};
  SharedMotion motion = nullptr;  // motion of a body, applied before toParent
  std::string mover = {};         // RigNode::name
  // The name of the item that the mesh is part of; of a body, the name of its items that have none.
  // A mesh without either is called after the body that it is in.
  ItemName item = nullptr;
  bool goesOn = false;   // a mesh of the same item as the one before it
  OrderNumbers at = {};  // counted from the beginning of the body it is in; moveTo() fills it in

  bool isMesh() const { return body == kNoBody; }
};

struct Body {
  std::string name;
  std::vector<Placement> placements;  // placements in the file's order

  // SceneLayout::moveTo() fills these in.
  OrderNumbers within{};             // the meshes and items that it holds, its bodies' included
  BoxOf<Vec3d> box{};                // bounds at 0 s
  double places = 0;                 // how often it is placed
  int height = 0;                    // levels of bodies within one another, this one included
  std::uint32_t object = kNoObject;  // object of the scene, if the body is placed more than once
  Vec3d origin{};                    // subtracted from the object's coordinates, see originOf()

  bool hasMeshes() const { return std::ranges::any_of(placements, &Placement::isMesh); }
  // Adds a mesh to the only item of the body.
  void addMesh(Mesh mesh) {
    const bool goesOn = !placements.empty();
    placements.push_back({.mesh = std::make_shared<Mesh>(std::move(mesh)), .goesOn = goesOn});
  }
};

// Body 0 is the scene; no body may hold itself, directly or through others.
class SceneLayout {
 public:
  explicit SceneLayout(MemoryBudget& budget) : budget_(budget) { add("scene"); }

  std::uint32_t add(const std::string& name);
  Body& body(std::uint32_t index) { return bodies_[index]; }
  // Adds copies of what `from` holds to `to`, moved by `placements`.
  void append(const Body& from, const std::vector<Affine>& placements, Body& to);

  // Fills in objects, instances and the rig that carries those, and leaves the layout without its
  // meshes. A body that is placed once and stands still adds its meshes to the world one by one,
  // each with its own map, so that vertices are rounded once; one that moves or is placed more
  // often becomes an object with an instance for each place. Ranks and the numbers of items follow
  // the file. Throws Error(limit) where bodies are nested deeper than kNestingLimit.
  // Returns originOf() all meshes at 0 s, which is zero unless they are far away.
  Vec3d moveTo(SceneDescription& scene);
  // Does the same, but subtracts that origin from all positions and sets scene.origin to it.
  Vec3d moveToOrigin(SceneDescription& scene);

 private:
  // Finds out how often, in which order and how far away everything is placed. Returns the origin.
  Vec3d measureScene(SceneDescription& scene);
  // Computes `within`, `height` and Placement::at of a body and of all that it holds, and adds
  // these to `order`, each behind the bodies in it. Returns the height.
  int measure(std::uint32_t index, int depth, std::vector<std::uint32_t>& order);
  BoxOf<Vec3d> boundsOf(const Body& body) const;
  // Adds what a placement holds to the scene. `toMover` maps to the space of the rig's node that
  // carries it, or to the world.
  void place(const Placement& placed, const Affine& toMover, std::uint32_t mover, OrderNumbers at,
             SceneDescription& scene);
  void placeOnce(Body& body, const Affine& toWorld, OrderNumbers at, SceneDescription& scene);
  void addObject(Body& body, SceneDescription& scene);
  Mesh take(Placement& placed, const std::string& body);

  MemoryBudget& budget_;
  std::deque<Body> bodies_;  // a deque: references stay valid
};

}  // namespace whit
