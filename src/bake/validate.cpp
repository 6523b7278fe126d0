#include <cmath>

#include "bake/finalize_steps.h"
#include "core/formatted.h"
#include "scene/members.h"

namespace whit {

namespace {

std::string place(const std::string& scene, const std::string& kind, std::size_t i,
                  const std::string& name) {
  const std::string thing = kind + (name.empty() ? " " + std::to_string(i) : " '" + name + "'");
  return scene.empty() ? thing : scene + ": " + thing;
}

template <typename Noun>
void checkMembers(const Noun& noun, const std::string& where) {
  forEachMember<Noun>([&](const auto& member) {
    const auto& value = noun.*member.field;
    using Value = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_same_v<Value, Vec3f>) {
      if (!isFinite(value)) throwBadScene(where, std::string("expected a finite ") + member.name);
      if (member.rules.kind == MemberKind::color && value != max(value, Vec3f(0.0f))) {
        throwBadScene(where, std::string("expected channels of 0 or more in ") + member.name);
      }
    } else if constexpr (!std::is_enum_v<Value>) {
      const double low = member.rules.low, high = member.rules.high;
      if (value >= low && value <= high) return;
      throwBadScene(where, formatted("expected %s to be from %g to %g", member.name, low, high));
    }
  });
}

void checkLights(const SceneDescription& d) {
  for (std::size_t i = 0; i < d.lights.size(); ++i) {
    const Light& light = d.lights[i];
    const std::string where = place(d.name, "light", i, light.name);
    checkMembers(light, where);
    if (hasDirection(light) && !(maxComponent(abs(light.direction)) > 0)) {
      throwBadScene(where, "expected a direction that is not 0");
    }
    if (hasCone(light) && !(light.innerConeAngle < light.outerConeAngle)) {
      throwBadScene(where, "expected cone angles with inner < outer");
    }
  }
}

// Relative to the lengths of its columns, so that a uniformly tiny map is not taken for singular.
bool isSingular(const Affine& a) {
  constexpr double kSmallestSine = 1e-14;
  const double volume = length(a.x) * length(a.y) * length(a.z);
  return !(std::abs(a.determinant()) > kSmallestSine * volume);
}

void checkInstances(const SceneDescription& d) {
  for (std::size_t i = 0; i < d.instances.size(); ++i) {
    const Affine& map = d.instances[i].toWorld;
    const std::string where = place(d.name, "instance", i, d.objects[d.instances[i].object].name);
    for (const Vec3d& column : {map.x, map.y, map.z, map.p}) {
      if (maxComponent(abs(column)) <= kLargestCoordinate && isFinite(column)) continue;
      throwBadScene(where, "expected a transform of finite numbers up to 1.844e18");
    }
    if (isSingular(map)) {
      throwBadScene(where, "expected a transform that can be undone; this one flattens space");
    }
  }
}

}  // namespace

void validate(const std::string& scene, const Sky& sky, const Ambient& ambient) {
  const std::string prefix = scene.empty() ? "" : scene + ": ";
  checkMembers(sky, prefix + "sky");
  checkMembers(ambient, prefix + "ambient");
}

void validate(const SceneDescription& description) {
  checkLights(description);
  for (std::size_t i = 0; i < description.materials.size(); ++i) {
    const Material& material = description.materials[i];
    checkMembers(material, place(description.name, "material", i, material.name));
  }
  validate(description.name, description.sky, description.ambient);
  checkInstances(description);
}

}  // namespace whit
