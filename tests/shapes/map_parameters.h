// Parameters from maps for tests, as strict about ranges as the reader of scene files.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "make/shape.h"

namespace whit::test {

using Value = std::variant<double, bool, Vec3d, std::string>;

class MapParameters : public ShapeParameters {
 public:
  MapParameters() = default;
  explicit MapParameters(std::map<std::string, Value> values) : values_(std::move(values)) {}

  double number(const std::string& key, double fallback, double low, double high) override {
    // Defaults have to be within the range, too.
    const double value = get(key, fallback);
    if (!(value >= low && value <= high)) throwBadScene(key, "out of range");
    return value;
  }
  int integer(const std::string& key, int fallback, int low, int high) override {
    return static_cast<int>(number(key, fallback, low, high));
  }
  bool flag(const std::string& key, bool fallback) override { return get(key, fallback); }
  Vec3d vector(const std::string& key, const Vec3d& fallback) override {
    return get(key, fallback);
  }
  std::string word(const std::string& key, const std::string& fallback,
                   const std::vector<std::string>& choices) override {
    const std::string value = get(key, fallback);
    if (std::find(choices.begin(), choices.end(), value) == choices.end()) {
      throwBadScene(key, "not a choice");
    }
    return value;
  }

  // Throws if a key was given but not queried.
  void expectAllAsked() const {
    for (const auto& [key, value] : values_) {
      if (!asked_.contains(key)) throwBadScene(key, "unknown key");
    }
  }

 private:
  template <typename T>
  T get(const std::string& key, const T& fallback) {
    asked_.insert(key);
    const auto found = values_.find(key);
    return found == values_.end() ? fallback : std::get<T>(found->second);
  }

  std::map<std::string, Value> values_;
  std::set<std::string> asked_;
};

// Calls the generator of this name. The parameters are all that it may ask for.
template <typename Generators>
auto madeBy(const Generators& generators, const std::string& name,
            std::map<std::string, Value> values) {
  MapParameters parameters(std::move(values));
  auto made = generators.at(name)(parameters);
  parameters.expectAllAsked();
  return made;
}

inline Shape generate(const std::string& name, std::map<std::string, Value> values = {}) {
  return madeBy(shapeGenerators(), name, std::move(values));
}

// Returns the mesh of a shape that has no other part.
inline Mesh meshOf(const std::string& name, std::map<std::string, Value> values = {}) {
  const Shape shape = generate(name, std::move(values));
  if (shape.parts.size() != 1) throwBadScene(name, "several parts");
  return shape.parts[0].mesh;
}

inline Texture paint(const std::string& name, std::map<std::string, Value> values = {}) {
  Texture texture = madeBy(patternGenerators(), name, std::move(values));
  texture.texels = texture.shared->make();
  return texture;
}

}  // namespace whit::test
