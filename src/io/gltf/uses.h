// What the accessors and buffer views of a glTF file are used as: each as one thing only.
#pragma once

#include <optional>
#include <vector>

#include "io/gltf/faults.h"

namespace whit {

enum class GltfUse { vertices, indices, matrices, times, keys, image };

class GltfUses {
 public:
  explicit GltfUses(const GltfText& text);

  // From `pointer`.
  void useAccessor(std::size_t accessor, GltfUse use, const std::string& pointer);
  void useView(std::size_t view, GltfUse use, const std::string& pointer);

  // Accessors of vertices in this view.
  std::size_t sharers(std::size_t view) const { return sharers_[view]; }

 private:
  const GltfText& text_;
  std::vector<std::optional<GltfUse>> accessors_, views_;
  std::vector<std::size_t> sharers_;
};

}  // namespace whit
