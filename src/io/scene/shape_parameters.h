// Parameters of shapes and patterns, from a scene file.
#pragma once

#include "io/json_reader.h"
#include "make/shape.h"

namespace whit {

class JsonShapeParameters : public ShapeParameters {
 public:
  // The object reports keys that were not asked for, at its finish().
  explicit JsonShapeParameters(JsonObject& object) : object_(object) {}

  double number(const std::string& key, double fallback, double low, double high) override {
    const auto value = object_.find(key);
    return value ? value->number(low, high) : fallback;
  }
  int integer(const std::string& key, int fallback, int low, int high) override {
    const auto value = object_.find(key);
    return value ? value->integer(low, high) : fallback;
  }
  bool flag(const std::string& key, bool fallback) override {
    const auto value = object_.find(key);
    return value ? value->flag() : fallback;
  }
  Vec3d vector(const std::string& key, const Vec3d& fallback) override {
    const auto value = object_.find(key);
    return value ? value->vector() : fallback;
  }
  std::string word(const std::string& key, const std::string& fallback,
                   const std::vector<std::string>& choices) override {
    const auto value = object_.find(key);
    return value ? value->word(choices) : fallback;
  }

 private:
  JsonObject& object_;
};

// The generator that the text of `name` stands for; an error names the nearest.
template <typename Generator>
Generator findGenerator(const JsonValue& name, const std::map<std::string, Generator>& generators) {
  std::vector<std::string> names;
  names.reserve(generators.size());
  for (const auto& [known, generator] : generators) names.push_back(known);
  return generators.at(name.word(names));
}

}  // namespace whit
