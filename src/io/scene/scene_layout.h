// The layout of a scene while its file is read: bodies that hold meshes and other bodies.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "core/affine.h"
#include "io/memory_budget.h"
#include "scene/description.h"

namespace whit {

// Items within items, by "group" or "use".
inline constexpr int kNestingLimit = 256;

// Memory that a mesh takes.
std::uint64_t bytesOf(const Mesh& mesh);

// Shared by the copies of what it names.
using ItemName = std::shared_ptr<const std::string>;

struct BodyPart {
  std::shared_ptr<Mesh> mesh;  // shared by copies of the part
  Affine toBody;
  bool mingles = false;    // its triangles come among those of the part before, see Mesh::order
  std::uint32_t item = 0;  // of its body's own
};

struct Placement {
  std::uint32_t body = 0;
  Affine toParent;
  std::size_t partsBefore = 0;                     // of the parent's parts so many come before it
  std::shared_ptr<const Motion> motion = nullptr;  // within the place that toParent gives it
  std::string mover = {};                          // RigNode::name
  ItemName item = nullptr;                         // the name of a body that is one item
};

struct Body {
  std::string name;
  std::vector<BodyPart> parts;
  std::vector<Placement> children;
  // The names of its own items, whose parts follow each other. None: it is one item, if it has
  // parts, whose name is that of where it is placed, else the body's.
  std::vector<ItemName> items;

  std::size_t itemCount() const { return items.empty() && !parts.empty() ? 1 : items.size(); }
  // The number of own items that come before a part.
  std::size_t itemsBefore(std::size_t part) const {
    return part < parts.size() ? parts[part].item : itemCount();
  }
};

// Parts and children come in the order in which the file has them, see Placement::partsBefore.
// Body 0 is the scene; a body may hold only bodies that were added before it is placed (no
// circles).
class SceneLayout {
 public:
  explicit SceneLayout(MemoryBudget& budget) : budget_(budget) { add("scene"); }

  std::uint32_t add(const std::string& name);
  Body& body(std::uint32_t index) { return bodies_[index]; }
  // Adds copies of what `from` holds to `to`, moved by `placements`.
  void append(const Body& from, const std::vector<Affine>& placements, Body& to);

  // Fills in objects, instances and the rig that carries those. A body that is placed once and
  // stands still adds its meshes to the world one by one, each with its own map, so that vertices
  // are rounded once; one that moves or is placed more often becomes an object with an instance for
  // each place. Leaves the layout without its meshes.
  // Ranks and the numbers of items follow the file: a part or child after the other, a child's own
  // where it stands.
  // Throws Error(limit) where bodies are nested deeper than kNestingLimit.
  void moveTo(SceneDescription& scene);

 private:
  // A place in the order of the scene: counted in parts, and in items.
  struct Standing {
    std::uint64_t rank = 0, item = 0;
    void operator+=(const Standing& more);
  };
  // Counted from the body's beginning, what its children hold included. A part that mingles with
  // the part before shares its rank.
  std::vector<Standing> standingsOfParts(const Body& body) const;
  void nameItems(const Body& body, const ItemName& placed, std::uint64_t first,
                 SceneDescription& scene) const;
  // `toMover`: to the space of the rig's node that carries it, or to the world.
  void place(const Placement& placed, const Affine& toMover, std::uint32_t mover, Standing at,
             SceneDescription& scene);
  void placeOnce(Body& body, const Affine& toWorld, Standing at, SceneDescription& scene);
  void addObject(std::uint32_t index, SceneDescription& scene);
  Mesh take(BodyPart& part, const std::string& body);

  MemoryBudget& budget_;
  std::deque<Body> bodies_;  // a deque: references stay valid
  std::vector<std::uint64_t> counts_;
  std::vector<Standing> within_;        // numbers of parts and items of bodies and all within them
  std::vector<std::uint32_t> objects_;  // of bodies placed more than once
};

}  // namespace whit
