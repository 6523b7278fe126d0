#include "io/gltf/animation.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "io/gltf/accessor.h"
#include "io/gltf/loose_json.h"
#include "io/scene/distinct_names.h"
#include "scene/track.h"

namespace whit {
namespace {

struct Target {
  std::string_view path;
  int type;
  std::size_t components;  // of a key; 0: as many as there are morph targets
  std::optional<Track> GltfTracks::*track;
};
constexpr Target kTargets[] = {
    {"translation", TINYGLTF_TYPE_VEC3, 3, &GltfTracks::translation},
    {"rotation", TINYGLTF_TYPE_VEC4, 4, &GltfTracks::rotation},
    {"scale", TINYGLTF_TYPE_VEC3, 3, &GltfTracks::scale},
    {"weights", TINYGLTF_TYPE_SCALAR, 0, &GltfTracks::weights},
};

const Target* targetOf(std::string_view path) {
  const auto found = std::find_if(std::begin(kTargets), std::end(kTargets),
                                  [&](const Target& target) { return target.path == path; });
  return found == std::end(kTargets) ? nullptr : found;
}

Track::Interpolation interpolationOf(const LooseJson& sampler) {
  const std::string_view name = sampler["interpolation"].text();
  if (name == "STEP") return Track::Interpolation::step;
  return name == "CUBICSPLINE" ? Track::Interpolation::cubic : Track::Interpolation::linear;
}

class AnimationReader {
 public:
  AnimationReader(const GltfDocument& document, std::size_t index)
      : document_(document),
        index_(index),
        animation_(document.animations().at(index)),
        nodes_(document.model().nodes.size()),
        accessors_(document.model().accessors.size()) {}

  // That of the last key of all samplers in use.
  double seconds() const {
    double last = 0;
    forEachChannel([&](std::size_t, const Target&, const LooseJson& sampler, std::size_t) {
      const auto input = sampler["input"].index(accessors_);
      if (!input) return;
      const std::vector<double>& most = document_.model().accessors[*input].maxValues;
      if (!most.empty() && std::isfinite(most[0])) last = std::max(last, most[0]);
    });
    return last;
  }

  std::size_t movedNodes() const {
    std::set<std::size_t> moved;
    forEachChannel([&](std::size_t node, const Target&, const LooseJson&, std::size_t) {
      moved.insert(node);
    });
    return moved.size();
  }

  void read(std::vector<GltfTracks>& tracks) const {
    forEachChannel(
        [&](std::size_t node, const Target& target, const LooseJson& sampler, std::size_t number) {
          Track track = readTrack(target, node, sampler, number);
          if (track.components > 0) tracks[node].*target.track = std::move(track);
        });
  }

 private:
  std::string where(std::size_t sampler, const char* member) const {
    return document_.where("animations", index_,
                           "/samplers/" + std::to_string(sampler) + "/" + member);
  }

  // Those that aim at a node of the document, at something that is known here.
  template <typename Use>
  void forEachChannel(Use&& use) const {
    const LooseJson channels = animation_["channels"], samplers = animation_["samplers"];
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const LooseJson aim = channels.at(i)["target"];
      const auto node = aim["node"].index(nodes_);
      const Target* target = targetOf(aim["path"].text());
      const auto sampler = channels.at(i)["sampler"].index(samplers.size());
      if (node && target && sampler) use(*node, *target, samplers.at(*sampler), *sampler);
    }
  }

  std::size_t morphTargets(std::size_t node) const {
    const int mesh = document_.model().nodes[node].mesh;
    if (mesh < 0) return 0;
    const auto& primitives = document_.model().meshes[static_cast<std::size_t>(mesh)].primitives;
    return primitives.empty() ? 0 : primitives[0].targets.size();
  }

  Track readTrack(const Target& target, std::size_t node, const LooseJson& sampler,
                  std::size_t number) const {
    Track track;
    track.interpolation = interpolationOf(sampler);
    track.rotation = target.path == "rotation";
    track.components = target.components > 0 ? target.components : morphTargets(node);
    if (track.components == 0) return track;
    track.times = readTimes(sampler, number);
    const auto output = sampler["output"].index(accessors_);
    if (!output) throwBadScene(where(number, "output"), "expected an accessor");
    const std::vector<float> values = readTuples(document_, *output, target.type);
    const std::size_t each = track.interpolation == Track::Interpolation::cubic ? 3 : 1;
    const std::size_t expected = track.times.size() * track.components * each;
    if (values.size() != expected) {
      throwBadScene(where(number, "output"), "expected " + std::to_string(expected) +
                                                 " numbers for " +
                                                 std::to_string(track.times.size()) +
                                                 " times, found " + std::to_string(values.size()));
    }
    if (!std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); })) {
      throwBadScene(where(number, "output"), "expected finite numbers");
    }
    track.values.assign(values.begin(), values.end());
    return track;
  }

  std::vector<double> readTimes(const LooseJson& sampler, std::size_t number) const {
    const auto input = sampler["input"].index(accessors_);
    if (!input) throwBadScene(where(number, "input"), "expected an accessor");
    const std::vector<float> times = readTuples(document_, *input, TINYGLTF_TYPE_SCALAR);
    if (times.empty()) throwBadScene(where(number, "input"), "expected at least one time");
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (std::isfinite(times[i]) && (i == 0 || times[i] > times[i - 1])) continue;
      throwBadScene(where(number, "input"),
                    "expected times that increase: number " + std::to_string(i) + " does not");
    }
    return {times.begin(), times.end()};
  }

  const GltfDocument& document_;
  std::size_t index_;
  LooseJson animation_;
  std::size_t nodes_, accessors_;
};

}  // namespace

std::vector<Animation> listGltfAnimations(const GltfDocument& document) {
  const LooseJson animations = document.animations();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < animations.size(); ++i) {
    const std::string_view name = animations.at(i)["name"].text();
    names.push_back(name.empty() ? "animation " + std::to_string(i) : std::string(name));
  }
  names = distinctNames(names);
  std::vector<Animation> all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const AnimationReader reader(document, i);
    all.push_back({names[i], reader.seconds(), reader.movedNodes()});
  }
  return all;
}

std::vector<GltfTracks> readGltfTracks(const GltfDocument& document, const Instant& instant) {
  std::vector<GltfTracks> tracks(document.model().nodes.size());
  if (!instant.moves()) return tracks;
  const std::vector<Animation> all = listGltfAnimations(document);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!instant.animation.empty() && all[i].name != instant.animation) continue;
    AnimationReader(document, i).read(tracks);
    break;
  }
  return tracks;
}

}  // namespace whit
