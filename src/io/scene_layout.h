// The layout of a scene while its file is read: bodies that hold meshes and other bodies.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "core/affine.h"
#include "io/memory_budget.h"
#include "scene/scene.h"

namespace whit {

// Items within items, by "group" or "use".
inline constexpr int kNestingLimit = 256;

// What a mesh takes in memory.
std::uint64_t bytesOf(const Mesh& mesh);

struct BodyPart {
  std::shared_ptr<Mesh> mesh;  // shared by copies of the part
  Affine toBody;
  bool mingles = false;  // its triangles come among those of the part before, see Mesh::order
};

struct Placement {
  std::uint32_t body = 0;
  Affine toParent;
  std::size_t partsBefore = 0;                     // of the parent's parts so many come before it
  std::shared_ptr<const Motion> motion = nullptr;  // within the place that toParent gives it
  std::string mover = {};                          // RigNode::name
};

struct Body {
  std::string name;
  std::vector<BodyPart> parts;
  std::vector<Placement> children;
};

// Parts and children come in the order in which the file has them, see Placement::partsBefore.
// Body 0 is the scene; a body may hold only bodies that were added before it is placed (no
// circles).
class SceneLayout {
 public:
  explicit SceneLayout(MemoryBudget& budget) : budget_(budget) { add("scene"); }

  std::uint32_t add(const std::string& name);
  Body& body(std::uint32_t index) { return bodies_[index]; }
  // Adds `count` copies of what `from` holds to `to`, moved by `placements`.
  void append(const Body& from, const std::vector<Affine>& placements, Body& to);

  // Fills in objects, instances and the rig that carries those. A body that is placed once and
  // stands still adds its meshes to the world one by one, each with its own map, so that vertices
  // are rounded once; one that moves or is placed more often becomes an object with an instance for
  // each place. Leaves the layout without its meshes.
  // Ranks follow the file: a part or child after the other, a child's own where it stands.
  // Throws Error(limit) where bodies are nested deeper than kNestingLimit.
  void moveTo(SceneDescription& scene);

 private:
  std::vector<std::uint64_t> ranksOfParts(const Body& body) const;
  // `toMover`: to the space of the rig's node that carries it, or to the world.
  void place(std::uint32_t index, const Affine& toMover, std::uint32_t mover, std::uint64_t rank,
             SceneDescription& scene);
  void placeOnce(Body& body, const Affine& toWorld, std::uint64_t rank, SceneDescription& scene);
  void addObject(std::uint32_t index, SceneDescription& scene);
  Mesh take(BodyPart& part, const std::string& body);

  MemoryBudget& budget_;
  std::deque<Body> bodies_;  // a deque: references stay valid
  std::vector<std::uint64_t> counts_;
  std::vector<std::uint64_t> sizes_;    // parts of bodies and of all within them
  std::vector<std::uint32_t> objects_;  // of bodies placed more than once
};

}  // namespace whit
