// Numbers for people of what a scene holds: its items, as its author placed them, and the triangles
// of each. Scene::triangles has them in another order and without those that were left out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace whit {

// Names are kept of so many items.
inline constexpr std::size_t kNamedItems = 65536;

class ItemNumbers {
 public:
  // Triangles that follow each other in Scene::triangles, in their item and in its numbers.
  struct Run {
    std::uint32_t first = 0;   // in Scene::triangles
    std::uint32_t item = 0;    // of instanced ones counted from InstanceRecord::firstItem
    std::uint32_t number = 0;  // in the item, of the first
  };

  // In the order of Scene::triangles.
  void add(std::uint32_t triangle, std::uint32_t item, std::uint32_t number) {
    if (!runs_.empty()) {
      const Run& last = runs_.back();
      if (last.item == item && number - last.number == triangle - last.first) return;
    }
    runs_.push_back({triangle, item, number});
  }
  // The item of a triangle (or sphere), and its number there.
  Run find(std::uint32_t triangle) const;
  std::uint64_t bytes() const { return runs_.size() * sizeof(Run); }

  // Names of the items 0, 1, ...: at most kNamedItems.
  std::vector<std::string> names;
  std::uint64_t count = 0;  // of items

 private:
  std::vector<Run> runs_;
};

}  // namespace whit
