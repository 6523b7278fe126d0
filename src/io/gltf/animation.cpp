#include "io/gltf/animation.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "io/gltf/accessor.h"
#include "io/scene/distinct_names.h"
#include "scene/track.h"

namespace whit {
namespace {

struct Target {
  std::string_view path, type;
  std::size_t components;  // of a key; 0: as many as the mesh has morph targets
  std::optional<Track> GltfTracks::*track;
};
constexpr Target kTargets[] = {
    {"translation", "VEC3", 3, &GltfTracks::translation},
    {"rotation", "VEC4", 4, &GltfTracks::rotation},
    {"scale", "VEC3", 3, &GltfTracks::scale},
    {"weights", "SCALAR", 0, &GltfTracks::weights},
};

const Target* targetOf(std::string_view path) {
  const auto found = std::find_if(std::begin(kTargets), std::end(kTargets),
                                  [&](const Target& target) { return target.path == path; });
  return found == std::end(kTargets) ? nullptr : found;
}

Track::Interpolation interpolationOf(const GltfValue& sampler) {
  const std::string name = sampler["interpolation"].text();
  if (name == "STEP") return Track::Interpolation::step;
  return name == "CUBICSPLINE" ? Track::Interpolation::cubic : Track::Interpolation::linear;
}

class AnimationReader {
 public:
  AnimationReader(const GltfDocument& document, const GltfValue& animation)
      : document_(document), animation_(animation), nodes_(document.list("nodes")) {}

  // Time of the last key of all samplers in use.
  double seconds() const {
    double last = 0;
    forEachChannel([&](std::size_t, const Target&, const GltfValue& sampler) {
      const GltfValue most = accessorOf(document_, sampler.need("input"))["max"];
      if (most.size() > 0) last = std::max(last, most[0].number(0));
    });
    return last;
  }

  std::size_t movedNodes() const {
    std::set<std::size_t> moved;
    forEachChannel([&](std::size_t node, const Target&, const GltfValue&) { moved.insert(node); });
    return moved.size();
  }

  void read(std::vector<GltfTracks>& tracks) const {
    forEachChannel([&](std::size_t node, const Target& target, const GltfValue& sampler) {
      Track track = readTrack(target, node, sampler);
      if (track.components > 0) tracks[node].*target.track = std::move(track);
    });
  }

 private:
  // Skips channels without a node and those that move what only an extension can move.
  template <typename Use>
  void forEachChannel(const Use& use) const {
    const GltfValue channels = animation_["channels"], samplers = animation_["samplers"];
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const GltfValue target = channels[i].need("target");
      const auto node = target["node"].index(nodes_);
      const Target* known = targetOf(target.need("path").text());
      if (!node || !known) continue;
      use(*node, *known, samplers[channels[i].need("sampler").index(samplers).value_or(0)]);
    }
  }

  std::size_t morphTargets(std::size_t node) const {
    const GltfValue meshes = document_.list("meshes");
    const auto mesh = nodes_[node]["mesh"].index(meshes);
    return mesh ? meshes[*mesh]["primitives"][std::size_t{0}]["targets"].size() : 0;
  }

  Track readTrack(const Target& target, std::size_t node, const GltfValue& sampler) const {
    Track track;
    track.interpolation = interpolationOf(sampler);
    track.rotation = target.path == "rotation";
    track.components = target.components > 0 ? target.components : morphTargets(node);
    if (track.components == 0) return track;
    track.times = readTimes(sampler.need("input"));
    const GltfValue output = sampler.need("output");
    const std::vector<float> values = readTuples(document_, output, target.type);
    const std::size_t each = track.interpolation == Track::Interpolation::cubic ? 3 : 1;
    const std::size_t expected = track.times.size() * track.components * each;
    if (values.size() != expected) {
      output.fail(std::to_string(expected) + " numbers for " + std::to_string(track.times.size()) +
                  " times, found " + std::to_string(values.size()));
    }
    if (!std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); })) {
      output.fail("finite numbers");
    }
    track.values.assign(values.begin(), values.end());
    return track;
  }

  std::vector<double> readTimes(const GltfValue& input) const {
    const std::vector<float> times = readTuples(document_, input, "SCALAR");
    if (times.empty()) input.fail("at least one time");
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (std::isfinite(times[i]) && (i == 0 || times[i] > times[i - 1])) continue;
      input.fail("times that increase: number " + std::to_string(i) + " does not");
    }
    return {times.begin(), times.end()};
  }

  const GltfDocument& document_;
  GltfValue animation_, nodes_;
};

}  // namespace

std::vector<Animation> listGltfAnimations(const GltfDocument& document) {
  const GltfValue animations = document.list("animations");
  std::vector<std::string> names;
  for (std::size_t i = 0; i < animations.size(); ++i) {
    const std::string name = animations[i]["name"].text();
    names.push_back(name.empty() ? "animation " + std::to_string(i) : name);
  }
  names = distinctNames(names);
  std::vector<Animation> all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const AnimationReader reader(document, animations[i]);
    all.push_back({names[i], reader.seconds(), reader.movedNodes()});
  }
  return all;
}

std::vector<GltfTracks> readGltfTracks(const GltfDocument& document, const Instant& instant) {
  std::vector<GltfTracks> tracks(document.list("nodes").size());
  if (!instant.moves()) return tracks;
  const std::vector<Animation> all = listGltfAnimations(document);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!instant.animation.empty() && all[i].name != instant.animation) continue;
    AnimationReader(document, document.list("animations")[i]).read(tracks);
    break;
  }
  return tracks;
}

}  // namespace whit
