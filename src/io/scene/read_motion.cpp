// The member "motion" of things in a scene file.
#include <algorithm>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "io/scene/scene_sections.h"
#include "scene/motion.h"

namespace whit {

namespace {

constexpr double kLeastScale = 1e-9, kLargestScale = 1e9;

// Numbers of a key: three of translation, the degrees, three of scale.
constexpr std::size_t kKeyNumbers = 7;

Vec3d readKeyScale(const JsonValue& value) {
  const Vec3d scale = value.isNumber() ? Vec3d(value.number()) : value.vector();
  for (const double s : {scale.x, scale.y, scale.z}) {
    if (!(s >= kLeastScale && s <= kLargestScale)) value.fail("a scale above 0");
  }
  return scale;
}

// `axis` is 0 before the first rotation.
double readDegrees(const JsonValue& value, Vec3d& axis) {
  const auto [about, degrees] = readTurn(value);
  if (axis == Vec3d()) axis = about;
  if (!(axis == about)) value.fail("the axis of the keys before: groups turn about several");
  return degrees;
}

void readKey(const JsonValue& value, Track& track, Vec3d& axis) {
  JsonObject key(value);
  const JsonValue time = key.need("time"), translate = key.find("translate");
  const JsonValue rotate = key.find("rotate"), scale = key.find("scale");
  if (!track.times.empty() && !(time.number() > track.times.back())) {
    time.fail("a time after that of the key before");
  }
  track.times.push_back(time.number());
  const Vec3d t = translate ? translate.vector() : Vec3d();
  const double degrees = rotate ? readDegrees(rotate, axis) : 0;
  const Vec3d s = scale ? readKeyScale(scale) : Vec3d(1.0);
  track.values.insert(track.values.end(), {t.x, t.y, t.z, degrees, s.x, s.y, s.z});
  key.finish();
}

// Along the line between the neighbors; at the ends along that to the only one, but where a loop
// ends as it begins: there it goes on.
void addTangents(bool loops, Track& track) {
  const std::size_t last = track.times.size() - 1;
  const auto value = [&](std::size_t key) {
    return std::span(track.values).subspan(key * kKeyNumbers, kKeyNumbers);
  };
  const bool closed = loops && last > 1 && std::ranges::equal(value(0), value(last));
  std::vector<double> all;
  for (std::size_t i = 0; i <= last; ++i) {
    const bool joined = closed && (i == 0 || i == last);
    const std::size_t a = joined ? last - 1 : i - std::min<std::size_t>(i, 1);
    const std::size_t b = joined ? 1 : std::min(i + 1, last);
    double span = track.times[b] - track.times[a];
    if (joined) span += track.times[last] - track.times[0];
    std::vector<double> tangent(kKeyNumbers);
    for (std::size_t k = 0; a != b && k < kKeyNumbers; ++k) {
      tangent[k] = (value(b)[k] - value(a)[k]) / span;
    }
    all.insert(all.end(), tangent.begin(), tangent.end());
    all.insert(all.end(), value(i).begin(), value(i).end());
    all.insert(all.end(), tangent.begin(), tangent.end());
  }
  track.values = std::move(all);
}

Track::Interpolation readInterpolation(JsonObject& motion) {
  const JsonValue value = motion.find("interpolation");
  const std::string word = value ? value.word({"linear", "step", "cubic"}) : "linear";
  if (word == "step") return Track::Interpolation::step;
  return word == "cubic" ? Track::Interpolation::cubic : Track::Interpolation::linear;
}

double looped(double seconds, double first, double last) {
  const double period = last - first;
  if (!(period > 0)) return first;
  const double within = std::fmod(seconds - first, period);
  return first + (within < 0 ? within + period : within);
}

class KeyedMotion : public Motion {
 public:
  KeyedMotion(Track track, const Vec3d& axis, bool loops)
      : track_(std::move(track)), axis_(axis), loops_(loops) {}

  Affine at(double seconds) const override {
    const std::vector<double> v = valueAt(
        track_, loops_ ? looped(seconds, track_.times.front(), track_.times.back()) : seconds);
    const Vec3d scale = max(Vec3d(v[4], v[5], v[6]), Vec3d(kLeastScale));  // cubic may overshoot
    return Affine::translation({v[0], v[1], v[2]}) * Affine::rotation(axis_, v[3]) *
           Affine::scaling(scale);
  }

 private:
  Track track_;
  Vec3d axis_;
  bool loops_;
};

void count(double seconds, SceneDescription& scene) {
  const auto known = std::ranges::find(scene.animations, kSceneMotion, &Animation::name);
  Animation& all = known != scene.animations.end() ? *known : scene.animations.emplace_back();
  all.name = kSceneMotion;
  all.seconds = std::max(all.seconds, seconds);
  ++all.nodes;
}

}  // namespace

std::pair<Vec3d, double> readTurn(const JsonValue& value) {
  const auto e = value.elements(4, "a rotation [x, y, z, degrees]");
  const Vec3d axis{e[0].number(), e[1].number(), e[2].number()};
  if (axis == Vec3d()) value.fail("an axis other than 0");
  return {axis, e[3].number()};
}

std::string movableName(const JsonObject& object, const Instant& instant) {
  const std::string& pointer = object.value().pointer();
  return instant.movable.contains(pointer) ? pointer : std::string();
}

std::shared_ptr<const Motion> readMotion(JsonObject& object, const Instant& instant,
                                         SceneDescription& scene) {
  const JsonValue value = object.find("motion");
  if (!value) {
    if (movableName(object, instant).empty()) return nullptr;
    return std::make_shared<const FixedMotion>(Affine());
  }
  JsonObject motion(value);
  const JsonValue list = motion.need("keys");
  Track track{readInterpolation(motion), false, kKeyNumbers, {}, {}};
  Vec3d axis;  // 0: nothing is turned
  for (const JsonValue& key : list.elements()) readKey(key, track, axis);
  if (track.times.empty()) list.fail("at least one key");
  const bool loops = motion.find("loop").flagOr(false);
  motion.finish();
  if (track.interpolation == Track::Interpolation::cubic) addTangents(loops, track);
  count(track.times.back(), scene);
  return std::make_shared<const KeyedMotion>(std::move(track), axis, loops);
}

}  // namespace whit
