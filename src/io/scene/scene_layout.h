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

inline constexpr std::uint32_t kNoObject = 0xffffffffu;

// Memory that a mesh takes.
std::uint64_t bytesOf(const Mesh& mesh);

using ItemName = std::shared_ptr<const std::string>;

struct BodyPart {
  std::shared_ptr<Mesh> mesh;  // shared by copies of the part
  Affine toBody;
  std::uint32_t item = 0;  // index into Body::items
};

struct Placement {
  std::uint32_t body = 0;
  Affine toParent;
  std::size_t partsBefore = 0;    // number of the parent's parts that precede it
  SharedMotion motion = nullptr;  // applied before toParent
  std::string mover = {};         // RigNode::name
  ItemName item = nullptr;        // the name of a body that is one item
};

// Numbers of parts and of items, which are also a place in the order of the scene.
struct Standing {
  std::uint64_t rank = 0, item = 0;

  void operator+=(const Standing& more) {
    rank += more.rank;
    item += more.item;
  }
};

struct Body {
  std::string name;
  std::vector<BodyPart> parts;
  std::vector<Placement> children;
  // The names of its own items, whose parts follow each other. Without names it is one item, if it
  // has parts, which is called as its placement says, otherwise as the body.
  std::vector<ItemName> items;

  // SceneLayout::moveTo() fills these in.
  Standing within{};                 // the parts and items that it holds, its children's included
  double places = 0;                 // how often it is placed
  int height = 0;                    // how many bodies are within one another from this one down
  std::uint32_t object = kNoObject;  // of the scene, where the body is placed more than once

  std::size_t itemCount() const { return items.empty() && !parts.empty() ? 1 : items.size(); }
  // The number of own items that come before a part.
  std::size_t itemsBefore(std::size_t part) const {
    return part < parts.size() ? parts[part].item : itemCount();
  }
};

// Parts and children keep the file's order, see Placement::partsBefore. Body 0 is the scene; no
// body may hold itself, directly or through others.
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
  void moveTo(SceneDescription& scene);

 private:
  // Computes `within` and `height` of a body and of all that it holds, and adds these to `order`,
  // each behind its children. Returns the height.
  int measure(std::uint32_t index, int depth, std::vector<std::uint32_t>& order);
  // Places counted from the body's beginning, with what its children hold.
  std::vector<Standing> standingsOfParts(const Body& body) const;
  void nameItems(const Body& body, const ItemName& placed, std::uint64_t first,
                 SceneDescription& scene) const;
  // `toMover`: to the space of the rig's node that carries it, or to the world.
  void place(const Placement& placed, const Affine& toMover, std::uint32_t mover, Standing at,
             SceneDescription& scene);
  void placeOnce(Body& body, const Affine& toWorld, Standing at, SceneDescription& scene);
  void addObject(Body& body, SceneDescription& scene);
  Mesh take(BodyPart& part, const std::string& body);

  MemoryBudget& budget_;
  std::deque<Body> bodies_;  // a deque: references stay valid
};

}  // namespace whit
