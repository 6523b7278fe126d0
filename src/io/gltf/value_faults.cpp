// What accessors hold: as their bounds say, finite, and of unit length where directions are asked
// for. Tolerances are those of quantization to 8 bits.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "io/gltf/elements.h"

namespace whit {
namespace {

constexpr double kUnitRounding = 0.00674;
constexpr double kSumRounding = 0.0039;  // of each weight

class ValueChecker {
 public:
  ValueChecker(const GltfText& text, const GltfElements& elements)
      : text_(text), elements_(elements) {}

  void check() {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      if (elements_.bounds(i).known) lookAtBounds(i);
      lookAtSparse(i);
    }
    const LooseJson meshes = text_.list("meshes");
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      const LooseJson primitives = meshes.at(i)["primitives"];
      for (std::size_t k = 0; k < primitives.size(); ++k) {
        pointer_ = pointerTo("meshes", i, pointerTo("primitives", k));
        lookAtAttributes(primitives.at(k)["attributes"]);
      }
    }
    lookAtJoints();
  }

 private:
  void fault(const char* what) const { text_.fault(what, pointer_); }

  // Files that name the same bytes again and again are not looked at for ever.
  bool mayLookAt(std::uint64_t elements) {
    const bool may = elements <= left_;
    left_ -= may ? elements : 0;
    return may;
  }

  void lookAtBounds(std::size_t accessor) {
    pointer_ = pointerTo("accessors", accessor);
    const GltfBounds& bounds = elements_.bounds(accessor);
    const GltfAccessorShape& shape = elements_.shape(accessor);
    if (!bounds.finite) return fault("values that are no numbers");
    const LooseJson source = text_.list("accessors").at(accessor);
    for (std::size_t k = 0; k < gltfComponents(shape.type); ++k) {
      const auto differs = [&](const char* name, double found) {
        const std::optional<double> said = source[name].at(k).number();
        return said && (shape.isFloat() ? static_cast<float>(*said) : *said) != found;
      };
      if (differs("min", bounds.low[k]) || differs("max", bounds.high[k])) {
        return fault("bounds that are not those of the values");
      }
    }
  }

  void lookAtSparse(std::size_t accessor) {
    const LooseJson sparse = text_.list("accessors").at(accessor)["sparse"];
    if (!sparse.isObject()) return;
    pointer_ = pointerTo("accessors", accessor, "/sparse");
    const std::uint64_t count = elements_.shape(accessor).count;
    if (sparse["count"].wholeOr(0) > count) fault("more replaced elements than there are");
    const GltfRun run = GltfRun::indicesOf(text_, sparse);
    if (!run.isReadable() || !mayLookAt(run.count())) return;
    for (std::uint64_t i = 1; i < run.count(); ++i) {
      if (run.raw(i, 0) <= run.raw(i - 1, 0)) {
        return fault("indices of replaced elements that do not increase");
      }
    }
  }

  void lookAtAttributes(const LooseJson& attributes) {
    if (!attributes.isObject()) return;
    for (const auto& [name, value] : attributes.json()->items()) {
      const auto accessor = LooseJson(value).index(elements_.size());
      if (!accessor || !elements_.bounds(*accessor).known || !seen_.insert(*accessor).second)
        continue;
      const GltfRun run(text_, *accessor);
      if (name == "NORMAL" && run.components() == 3) lookAtDirections(run);
      if (name == "TANGENT" && run.components() == 4) lookAtDirections(run);
      if (name.starts_with("COLOR_")) lookAtColors(*accessor);
    }
    lookAtWeights(attributes);
  }

  void lookAtDirections(const GltfRun& run) const {
    for (std::uint64_t i = 0; i < run.count(); ++i) {
      const double x = run.value(i, 0), y = run.value(i, 1), z = run.value(i, 2);
      if (!(std::abs(std::sqrt(x * x + y * y + z * z) - 1) <= kUnitRounding)) {
        return fault("directions that are not of unit length");
      }
      if (run.components() == 4 && std::abs(run.value(i, 3)) != 1) {
        return fault("tangents without a sign");
      }
    }
  }

  void lookAtColors(std::size_t accessor) const {
    const GltfBounds& bounds = elements_.bounds(accessor);
    const GltfAccessorShape& shape = elements_.shape(accessor);
    for (std::size_t k = 0; shape.isFloat() && k < gltfComponents(shape.type); ++k) {
      if (bounds.low[k] < 0 || bounds.high[k] > 1) return fault("colors beyond 0 to 1");
    }
  }

  // Those of all sets together are 1.
  void lookAtWeights(const LooseJson& attributes) {
    std::vector<GltfRun> runs, joints;
    for (std::size_t set = 0;; ++set) {
      const std::string number = std::to_string(set);
      const auto accessor = attributes["WEIGHTS_" + number].index(elements_.size());
      const auto which = attributes["JOINTS_" + number].index(elements_.size());
      if (!accessor || !which) break;
      if (!elements_.bounds(*accessor).known || !elements_.bounds(*which).known) return;
      if (set == 0 && !weighted_.insert({*accessor, *which}).second) return;
      runs.emplace_back(text_, *accessor);
      joints.emplace_back(text_, *which);
      if (runs[set].components() != 4 || joints[set].components() != 4) return;
      if (runs[set].count() != runs[0].count() || joints[set].count() != runs[0].count()) return;
    }
    if (runs.empty() || !mayLookAt(runs[0].count() * runs.size())) return;
    for (std::uint64_t i = 0; i < runs[0].count(); ++i) {
      if (const char* what = faultOfVertex(runs, joints, i)) return fault(what);
    }
  }

  static const char* faultOfVertex(const std::vector<GltfRun>& weights,
                                   const std::vector<GltfRun>& joints, std::uint64_t i) {
    double sum = 0, rounding = 0;
    std::set<double> moved;
    for (std::size_t set = 0; set < weights.size(); ++set) {
      for (std::size_t k = 0; k < 4; ++k) {
        const double weight = weights[set].value(i, k);
        if (weight < 0) return "weights below 0";
        if (weight > 0 && !moved.insert(joints[set].raw(i, k)).second) {
          return "a joint that moves a vertex twice";
        }
        sum += weight;
        rounding += weight > 0 ? kSumRounding : 0;
      }
    }
    return std::abs(sum - 1) <= rounding ? nullptr : "weights whose sum is not 1";
  }

  void lookAtJoints() {
    const LooseJson nodes = text_.list("nodes"), meshes = text_.list("meshes");
    const LooseJson skins = text_.list("skins");
    std::map<std::size_t, double> largest;  // of each mesh
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::uint64_t mesh = nodes.at(i)["mesh"].wholeOr(meshes.size());
      const std::uint64_t skin = nodes.at(i)["skin"].wholeOr(skins.size());
      if (mesh >= meshes.size() || skin >= skins.size()) continue;
      pointer_ = pointerTo("nodes", i);
      const auto [known, isNew] = largest.try_emplace(mesh, -1.0);
      if (isNew) known->second = largestJoint(meshes.at(mesh)["primitives"]);
      if (known->second >= static_cast<double>(skins.at(skin)["joints"].size())) {
        fault("a joint that the skin does not have");
      }
    }
  }

  // -1: none is known.
  double largestJoint(const LooseJson& primitives) const {
    double largest = -1;
    for (std::size_t i = 0; i < primitives.size(); ++i) {
      const auto accessor = primitives.at(i)["attributes"]["JOINTS_0"].index(elements_.size());
      if (!accessor || !elements_.bounds(*accessor).known) continue;
      for (std::size_t k = 0; k < 4; ++k) {
        largest = std::max(largest, elements_.bounds(*accessor).high[k]);
      }
    }
    return largest;
  }

  const GltfText& text_;
  const GltfElements& elements_;
  std::uint64_t left_ = 1u << 28;
  std::string pointer_;
  std::set<std::size_t> seen_;
  std::set<std::pair<std::size_t, std::size_t>> weighted_;
};

}  // namespace

void countValueFaults(const GltfText& text, const GltfElements& elements) {
  ValueChecker(text, elements).check();
}

}  // namespace whit
