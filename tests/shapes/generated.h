// Shapes and patterns by the members that a scene file gives them.
#pragma once

#include <string>

#include "io/scene/scene_sections.h"
#include "io/scene_files.h"
#include "make/shape.h"

namespace whit::test {

// Calls the generator of this name with these members, which are all that it may ask for.
template <typename Generators>
auto madeBy(const Generators& generators, const std::string& name, const std::string& members) {
  const JsonDocument document{name, parseJson(asJson("{" + members + "}"), name), {}};
  JsonObject object{JsonValue(document)};
  JsonShapeParameters parameters(object);
  auto made = generators.at(name)(parameters);
  object.finish();
  return made;
}

inline Shape generate(const std::string& name, const std::string& members = "") {
  return madeBy(shapeGenerators(), name, members);
}

// Returns the mesh of a shape that has no other part.
inline Mesh meshOf(const std::string& name, const std::string& members = "") {
  const Shape shape = generate(name, members);
  EXPECT_EQ(shape.parts.size(), 1u) << name;
  return shape.parts.at(0).mesh;
}

inline Texture paint(const std::string& name, const std::string& members) {
  Texture texture = madeBy(patternGenerators(), name, members);
  texture.texels = texture.shared->make();
  return texture;
}

}  // namespace whit::test
