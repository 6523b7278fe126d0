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
};

struct Placement {
  std::uint32_t body = 0;
  Affine toParent;
};

struct Body {
  std::string name;
  std::vector<BodyPart> parts;
  std::vector<Placement> children;
};

// Body 0 is the scene; a body may hold only bodies that were added before it is placed (no
// circles).
class SceneLayout {
 public:
  explicit SceneLayout(MemoryBudget& budget) : budget_(budget) { add("scene"); }

  std::uint32_t add(const std::string& name);
  Body& body(std::uint32_t index) { return bodies_[index]; }
  // Adds `count` copies of what `from` holds to `to`, moved by `placements`.
  void append(const Body& from, const std::vector<Affine>& placements, Body& to);

  // Fills in objects and instances. A body that is placed once adds its meshes to the world one by
  // one, each with its own map, so that vertices are rounded once; one that is placed more often
  // becomes an object with an instance for each place. Leaves the layout without its meshes.
  // Throws Error(limit) where bodies are nested deeper than kNestingLimit.
  void moveTo(SceneDescription& scene);

 private:
  void place(std::uint32_t body, const Affine& toWorld, SceneDescription& scene);
  void placeOnce(Body& body, const Affine& toWorld, SceneDescription& scene);
  Mesh take(BodyPart& part, const std::string& body);

  MemoryBudget& budget_;
  std::deque<Body> bodies_;  // a deque: references stay valid
  std::vector<std::uint64_t> counts_;
  std::vector<std::uint32_t> objects_;  // of bodies placed more than once
};

}  // namespace whit
