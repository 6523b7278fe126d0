#include "io/gltf_deformation.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "io/gltf_accessor.h"

namespace whit {

namespace {

using Attributes = std::map<std::string, int>;

class Deformer {
 public:
  Deformer(const GltfDocument& document, const tinygltf::Primitive& primitive,
           const std::string& where, Mesh& mesh)
      : document_(document), primitive_(primitive), where_(where), mesh_(mesh) {
    document_.budget().charge(mesh.positions.size() + mesh.normals.size(), sizeof(Vec3d), where_);
    for (const Vec3f& position : mesh.positions) positions_.emplace_back(position);
    for (const Vec3f& normal : mesh.normals) normals_.emplace_back(normal);
  }

  void morph(const std::vector<double>& weights) {
    for (std::size_t i = 0; i < std::min(weights.size(), primitive_.targets.size()); ++i) {
      if (weights[i] == 0) continue;
      const Attributes& target = primitive_.targets[i];
      add(target, "POSITION", weights[i], positions_);
      add(target, "NORMAL", weights[i], normals_);
    }
  }

  void bend(const std::vector<Affine>& joints) {
    const std::size_t count = positions_.size();
    std::vector<Affine> maps(count, Affine{{}, {}, {}, {}});
    std::vector<double> sums(count, 0.0);
    document_.budget().charge(count, sizeof(Affine) + sizeof(double), where_);
    bool held = false;
    for (int set = 0;; ++set) {
      const int indices = accessorOf(primitive_.attributes, "JOINTS_" + std::to_string(set));
      const int weights = accessorOf(primitive_.attributes, "WEIGHTS_" + std::to_string(set));
      if (indices < 0 || weights < 0) break;
      addSet(joints, indices, weights, maps, sums);
      held = true;
    }
    if (!held) return warn("skinned mesh without joints and weights shown as it was modelled");
    std::size_t mirrored = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!(sums[i] > 0) || !std::isfinite(sums[i])) {
        warn("vertex that no joint holds left where it was modelled");
        continue;
      }
      const Affine map = scaled(maps[i], 1 / sums[i]);
      positions_[i] = map.point(positions_[i]);
      if (i < normals_.size()) normals_[i] = map.normal(normals_[i]);
      if (map.determinant() < 0) ++mirrored;
    }
    if (2 * mirrored > count) {
      for (auto& triangle : mesh_.triangles) std::swap(triangle[1], triangle[2]);
    }
  }

  void finish() {
    for (std::size_t i = 0; i < positions_.size(); ++i) mesh_.positions[i] = Vec3f(positions_[i]);
    for (std::size_t i = 0; i < normals_.size(); ++i) {
      mesh_.normals[i] = Vec3f(normalized(normals_[i], Vec3d()));
    }
  }

 private:
  void warn(const char* what) const { document_.warnings().add(what, where_); }

  static int accessorOf(const Attributes& attributes, const std::string& name) {
    const auto found = attributes.find(name);
    return found == attributes.end() ? -1 : found->second;
  }

  static Affine scaled(const Affine& map, double by) {
    return {map.x * by, map.y * by, map.z * by, map.p * by};
  }

  void checkLength(std::size_t found, std::size_t expected, const std::string& name) const {
    if (found == expected) return;
    throwBadScene(where_ + name, "expected as many as positions, " + std::to_string(expected) +
                                     ", found " + std::to_string(found));
  }

  void add(const Attributes& target, const std::string& name, double weight,
           std::vector<Vec3d>& to) const {
    const int accessor = accessorOf(target, name);
    if (accessor < 0 || to.empty()) return;
    if (static_cast<std::size_t>(accessor) >= document_.model().accessors.size()) {
      return warn("morph target that cannot be read left out");
    }
    const std::vector<Vec3f> moved = readVectors(document_, static_cast<std::size_t>(accessor));
    checkLength(moved.size(), to.size(), "/targets");
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = to[i] + Vec3d(moved[i]) * weight;
  }

  // Four more joints of each vertex.
  void addSet(const std::vector<Affine>& joints, int indices, int weights,
              std::vector<Affine>& maps, std::vector<double>& sums) const {
    const std::vector<float> j =
        readTuples(document_, static_cast<std::size_t>(indices), TINYGLTF_TYPE_VEC4);
    const std::vector<float> w =
        readTuples(document_, static_cast<std::size_t>(weights), TINYGLTF_TYPE_VEC4);
    checkLength(j.size() / 4, maps.size(), "/attributes/JOINTS");
    checkLength(w.size() / 4, maps.size(), "/attributes/WEIGHTS");
    for (std::size_t i = 0; i < j.size(); ++i) {
      const double weight = w[i];
      if (!(weight > 0)) continue;
      if (!(j[i] >= 0 && j[i] < static_cast<float>(joints.size()))) {
        warn("joint that the skin does not have left out");
        continue;
      }
      const Affine& joint = joints[static_cast<std::size_t>(j[i])];
      Affine& map = maps[i / 4];
      map = {map.x + joint.x * weight, map.y + joint.y * weight, map.z + joint.z * weight,
             map.p + joint.p * weight};
      sums[i / 4] += weight;
    }
  }

  const GltfDocument& document_;
  const tinygltf::Primitive& primitive_;
  const std::string& where_;
  Mesh& mesh_;
  std::vector<Vec3d> positions_, normals_;
};

}  // namespace

bool GltfDeformation::none() const {
  return joints.empty() &&
         std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0; });
}

void deform(const GltfDocument& document, const tinygltf::Primitive& primitive,
            const GltfDeformation& deformation, const std::string& where, Mesh& mesh) {
  Deformer deformer(document, primitive, where, mesh);
  deformer.morph(deformation.weights);
  if (!deformation.joints.empty()) deformer.bend(deformation.joints);
  deformer.finish();
}

}  // namespace whit
