// Skins: what of them the specification forbids.
#include <set>
#include <vector>

#include "io/gltf/elements.h"
#include "io/gltf/uses.h"

namespace whit {
namespace {

constexpr std::size_t kNoParent = ~std::size_t{0};

class SkinChecker {
 public:
  SkinChecker(const GltfText& text, const GltfElements& elements, GltfUses& uses)
      : text_(text), elements_(elements), uses_(uses), nodes_(text.list("nodes")) {
    parents_.resize(nodes_.size(), kNoParent);
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const LooseJson children = nodes_.at(i)["children"];
      for (std::size_t k = 0; k < children.size(); ++k) {
        if (const auto child = children.at(k).index(nodes_.size())) parents_[*child] = i;
      }
    }
  }

  void check() {
    findRoots();
    const LooseJson skins = text_.list("skins");
    for (std::size_t i = 0; i < skins.size(); ++i) look(skins.at(i), pointerTo("skins", i));
    lookAtScenes(skins);
  }

 private:
  // A loop has none.
  void findRoots() {
    roots_.resize(nodes_.size(), kNoParent);
    std::vector<std::vector<std::size_t>> children(nodes_.size());
    std::vector<std::size_t> waiting;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (parents_[i] != kNoParent) {
        children[parents_[i]].push_back(i);
      } else {
        roots_[i] = i;
        waiting.push_back(i);
      }
    }
    while (!waiting.empty()) {
      const std::size_t node = waiting.back();
      waiting.pop_back();
      for (const std::size_t child : children[node]) {
        roots_[child] = roots_[node];
        waiting.push_back(child);
      }
    }
  }

  std::size_t rootOf(const LooseJson& node) const {
    const auto index = node.index(nodes_.size());
    return index ? roots_[*index] : kNoParent;
  }

  void look(const LooseJson& skin, const std::string& pointer) {
    const LooseJson joints = skin["joints"];
    lookAtMatrices(skin, joints.size(), pointer);
    if (joints.size() == 0) return;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      if (rootOf(joints.at(i)) == rootOf(joints.at(0)) && rootOf(joints.at(i)) != kNoParent)
        continue;
      return text_.fault("a skin whose joints have no common root", pointer);
    }
    const std::optional<std::size_t> skeleton = skin["skeleton"].index(nodes_.size());
    if (skeleton) lookAtSkeleton(*skeleton, joints, pointer);
  }

  void lookAtSkeleton(std::size_t skeleton, const LooseJson& joints, const std::string& pointer) {
    std::set<std::size_t> below = {skeleton}, visited;
    for (std::size_t i = 0; i < joints.size(); ++i) {
      std::size_t at = joints.at(i).index(nodes_.size()).value_or(kNoParent);
      while (at != kNoParent && !below.contains(at) && visited.insert(at).second) at = parents_[at];
      if (at == kNoParent) return text_.fault("a skeleton that is no root of its joints", pointer);
    }
  }

  void lookAtMatrices(const LooseJson& skin, std::size_t joints, const std::string& pointer) {
    const auto matrices = skin["inverseBindMatrices"].index(elements_.size());
    if (!matrices) return;
    uses_.useAccessor(*matrices, GltfUse::matrices, pointer + "/inverseBindMatrices");
    const GltfAccessorShape& shape = elements_.shape(*matrices);
    if (shape.type != "MAT4" || !shape.isFloat()) {
      return text_.fault("an accessor of a type that does not fit its use", pointer);
    }
    if (shape.count < joints) text_.fault("fewer matrices than joints", pointer);
    const GltfBounds& bounds = elements_.bounds(*matrices);
    for (const std::size_t k : {3u, 7u, 11u, 15u}) {
      const double wanted = k == 15 ? 1 : 0;
      if (bounds.known && (bounds.low[k] != wanted || bounds.high[k] != wanted)) {
        text_.fault("matrices of joints whose last row is not 0 0 0 1", pointer);
      }
    }
  }

  // A scene that shows the skinned mesh shows its joints.
  void lookAtScenes(const LooseJson& skins) const {
    std::set<std::pair<std::size_t, std::size_t>> together;  // roots of meshes and joints
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const auto skin = nodes_.at(i)["skin"].index(skins.size());
      if (!skin) continue;
      const std::size_t joints = rootOf(skins.at(*skin)["joints"].at(0));
      if (joints != kNoParent && joints != roots_[i]) together.insert({roots_[i], joints});
    }
    constexpr std::size_t kMostPairs = 1000;  // no real file has as many trees
    const LooseJson scenes = text_.list("scenes");
    for (std::size_t s = 0; together.size() < kMostPairs && s < scenes.size(); ++s) {
      const std::set<std::size_t> shown = rootsOf(scenes.at(s));
      for (const auto& [mesh, joints] : together) {
        if (!shown.contains(mesh) || shown.contains(joints)) continue;
        text_.fault("a scene that shows a skinned mesh and not its joints", pointerTo("scenes", s));
      }
    }
  }
  std::set<std::size_t> rootsOf(const LooseJson& scene) const {
    std::set<std::size_t> roots;
    for (std::size_t i = 0; i < scene["nodes"].size(); ++i) {
      roots.insert(rootOf(scene["nodes"].at(i)));
    }
    return roots;
  }

  const GltfText& text_;
  const GltfElements& elements_;
  GltfUses& uses_;
  LooseJson nodes_;
  std::vector<std::size_t> parents_, roots_;
};

}  // namespace

void countSkinFaults(const GltfText& text, const GltfElements& elements, GltfUses& uses) {
  SkinChecker(text, elements, uses).check();
}

}  // namespace whit
