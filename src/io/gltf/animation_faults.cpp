// Animations, played or not: what of them the specification forbids.
#include <array>
#include <cmath>
#include <set>

#include "io/gltf/elements.h"
#include "io/gltf/uses.h"

namespace whit {
namespace {

struct GltfTrack {
  std::string_view path, type;
  bool mayBeWhole;  // of normalized integers
};
constexpr std::array<GltfTrack, 4> kTracks = {{{"translation", "VEC3", false},
                                               {"rotation", "VEC4", true},
                                               {"scale", "VEC3", false},
                                               {"weights", "SCALAR", true}}};

const GltfTrack* trackOf(std::string_view path) {
  for (const GltfTrack& track : kTracks) {
    if (track.path == path) return &track;
  }
  return nullptr;
}

class AnimationChecker {
 public:
  AnimationChecker(const GltfText& text, const GltfElements& elements, GltfUses& uses)
      : text_(text), elements_(elements), uses_(uses) {}

  void check() {
    const LooseJson animations = text_.list("animations");
    for (std::size_t i = 0; i < animations.size(); ++i) {
      pointer_ = pointerTo("animations", i);
      const LooseJson samplers = animations.at(i)["samplers"];
      for (std::size_t k = 0; k < samplers.size(); ++k) lookAtSampler(samplers.at(k));
      const LooseJson channels = animations.at(i)["channels"];
      targets_.clear();
      for (std::size_t k = 0; k < channels.size(); ++k) lookAtChannel(channels.at(k), samplers);
    }
  }

 private:
  void fault(const char* what) const { text_.fault(what, pointer_); }

  void lookAtSampler(const LooseJson& sampler) {
    const auto output = sampler["output"].index(elements_.size());
    if (output) uses_.useAccessor(*output, GltfUse::keys, pointer_);
    const auto input = sampler["input"].index(elements_.size());
    if (!input) return;
    uses_.useAccessor(*input, GltfUse::times, pointer_);
    const GltfAccessorShape& shape = elements_.shape(*input);
    const LooseJson source = text_.list("accessors").at(*input);
    if (shape.type != "SCALAR" || !shape.isFloat()) {
      fault("an accessor of a type that does not fit its use");
    }
    if (!source["min"].exists() || !source["max"].exists()) {
      fault("times without their least and largest");
    }
    if (sampler["interpolation"].text() == "CUBICSPLINE" && shape.count < 2) {
      fault("a curve of fewer than two points");
    }
    lookAtTimes(*input);
  }

  void lookAtTimes(std::size_t input) {
    if (!elements_.bounds(input).known || elements_.shape(input).type != "SCALAR") return;
    if (!seen_.insert(input).second) return;
    const GltfRun run(text_, input);
    if (elements_.bounds(input).low[0] < 0) fault("times below 0");
    for (std::uint64_t i = 1; i < run.count(); ++i) {
      if (run.raw(i, 0) <= run.raw(i - 1, 0)) return fault("times that do not increase");
    }
  }

  void lookAtChannel(const LooseJson& channel, const LooseJson& samplers) {
    const std::optional<std::size_t> sampler = channel["sampler"].index(samplers.size());
    if (!sampler) fault("an index to nothing");
    const std::string_view path = channel["target"]["path"].text();
    const LooseJson nodes = text_.list("nodes");
    if (const auto node = channel["target"]["node"].index(nodes.size())) {
      lookAtTarget(nodes.at(*node), path);
      const std::string target = std::to_string(*node) + "/" + std::string(path);
      if (!targets_.insert(target).second) fault("two channels for one target");
      if (sampler) lookAtOutput(samplers.at(*sampler), nodes.at(*node), path);
    }
  }

  void lookAtTarget(const LooseJson& node, std::string_view path) const {
    if (node["matrix"].exists() && path != "weights") fault("a moved node that has a matrix");
    if (path == "weights" && targetsOf(node) == 0) {
      fault("moved weights of a mesh without morph targets");
    }
  }

  std::size_t targetsOf(const LooseJson& node) const {
    const LooseJson meshes = text_.list("meshes");
    return meshes.at(node["mesh"].wholeOr(meshes.size()))["primitives"].at(0)["targets"].size();
  }

  void lookAtOutput(const LooseJson& sampler, const LooseJson& node, std::string_view path) {
    const GltfTrack* track = trackOf(path);
    const auto output = sampler["output"].index(elements_.size());
    if (!track || !output) return;
    const GltfAccessorShape& shape = elements_.shape(*output);
    const bool isSmall = gltfBytesOf(shape.componentType) < 4 && shape.normalized;
    if (shape.type != track->type || !(shape.isFloat() || (track->mayBeWhole && isSmall))) {
      return fault("an accessor of a type that does not fit its use");
    }
    const auto input = sampler["input"].index(elements_.size());
    const bool isCubic = sampler["interpolation"].text() == "CUBICSPLINE";
    const std::uint64_t each = (path == "weights" ? targetsOf(node) : 1) * (isCubic ? 3 : 1);
    if (input && each > 0 && shape.count != elements_.shape(*input).count * each) {
      fault("another number of values than of times");
    }
    if (path == "rotation" && !isCubic && elements_.bounds(*output).known) lookAtRotations(*output);
  }

  void lookAtRotations(std::size_t output) {
    if (!seen_.insert(output).second) return;
    constexpr double kRounding = 0.00769;  // of 8 bits a component
    const GltfRun run(text_, output);
    for (std::uint64_t i = 0; i < run.count(); ++i) {
      double square = 0;
      for (std::size_t k = 0; k < 4; ++k) square += run.value(i, k) * run.value(i, k);
      if (!(std::abs(std::sqrt(square) - 1) <= kRounding)) {
        return fault("rotations that are not of unit length");
      }
    }
  }

  const GltfText& text_;
  const GltfElements& elements_;
  GltfUses& uses_;
  std::string pointer_;
  std::set<std::string> targets_;
  std::set<std::size_t> seen_;
};

}  // namespace

void countAnimationFaults(const GltfText& text, const GltfElements& elements, GltfUses& uses) {
  AnimationChecker(text, elements, uses).check();
}

}  // namespace whit
