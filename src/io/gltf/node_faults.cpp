// Nodes, the trees that they make, and the scenes that show them.
#include <array>
#include <map>
#include <vector>

#include "io/gltf/faults.h"

namespace whit {
namespace {

class NodeChecker {
 public:
  explicit NodeChecker(const GltfText& text)
      : text_(text), nodes_(text.list("nodes")), hasParent_(nodes_.size()) {}

  void check() {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const std::string pointer = pointerTo("nodes", i);
      lookAtPlace(nodes_.at(i), pointer);
      lookAtMesh(nodes_.at(i), pointer);
      const LooseJson children = nodes_.at(i)["children"];
      for (std::size_t k = 0; k < children.size(); ++k) {
        if (const auto child = children.at(k).index(nodes_.size())) hasParent_[*child] = true;
      }
    }
    lookAtScenes();
  }

 private:
  void lookAtPlace(const LooseJson& node, const std::string& pointer) {
    const LooseJson matrix = node["matrix"];
    if (!matrix.exists()) return;
    for (const char* part : {"translation", "rotation", "scale"}) {
      if (node[part].exists()) text_.fault("a node with a matrix and what makes one", pointer);
    }
    std::array<double, 16> m{};
    for (std::size_t i = 0; i < m.size(); ++i) m[i] = matrix.at(i).number().value_or(0);
    const double determinant = m[0] * (m[5] * m[10] - m[6] * m[9]) -
                               m[4] * (m[1] * m[10] - m[2] * m[9]) +
                               m[8] * (m[1] * m[6] - m[2] * m[5]);
    if (determinant == 0) text_.fault("a matrix that flattens space", pointer);
  }

  void lookAtMesh(const LooseJson& node, const std::string& pointer) {
    for (const char* part : {"skin", "weights"}) {
      if (node[part].exists() && !node["mesh"].exists()) {
        text_.fault("a property that needs another one", pointer + "/" + part);
      }
    }
    const LooseJson meshes = text_.list("meshes");
    const LooseJson primitives = meshes.at(node["mesh"].wholeOr(meshes.size()))["primitives"];
    if (primitives.size() == 0) return;
    if (node["weights"].isList() && node["weights"].size() != primitives.at(0)["targets"].size()) {
      text_.fault("another number of weights than of morph targets", pointer + "/weights");
    }
    if (node["skin"].exists() && !hasJoints(primitives)) {
      text_.fault("a skin for a mesh without joints", pointer);
    }
  }

  bool hasJoints(const LooseJson& primitives) {
    const auto [known, isNew] = hasJoints_.try_emplace(primitives.json(), true);
    for (std::size_t i = 0; isNew && i < primitives.size(); ++i) {
      known->second = known->second && primitives.at(i)["attributes"]["JOINTS_0"].exists();
    }
    return known->second;
  }

  void lookAtScenes() {
    const LooseJson scenes = text_.list("scenes");
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      const LooseJson roots = scenes.at(i)["nodes"];
      for (std::size_t k = 0; k < roots.size(); ++k) {
        const auto root = roots.at(k).index(nodes_.size());
        if (root && hasParent_[*root]) {
          text_.fault("a scene that shows a node which has a parent", pointerTo("scenes", i));
        }
      }
    }
  }

  const GltfText& text_;
  LooseJson nodes_;
  std::vector<bool> hasParent_;
  std::map<const Json*, bool> hasJoints_;  // all primitives of a mesh
};

}  // namespace

void countNodeFaults(const GltfText& text) { NodeChecker(text).check(); }

}  // namespace whit
