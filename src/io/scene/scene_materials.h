// The sections "textures" and "materials" of a scene file.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "io/json_reader.h"
#include "io/scene/scene_context.h"

namespace whit {

class MaterialReader {
 public:
  // Reads both sections. Images are asked for when a material names their texture: the kind of
  // map says how they are to be read. Patterns are computed while the rest is read, so that the
  // errors of their parameters come from TextureLoader::finish().
  MaterialReader(JsonObject& file, SceneContext& context);

  // The index of the material that the text of `name` stands for.
  std::uint32_t find(const JsonValue& name) const;
  // The material of items that name none: the one called "default", or else a gray one.
  std::uint32_t defaultMaterial();
  // Adds the material as it is, returns its index.
  std::uint32_t add(Material material);

  // Reads the textures that no material names, for their errors' sake.
  void checkUnused();

  // Changes what `object` gives and nothing else. A map may be null: none.
  void read(JsonObject& object, Material& material);
  // Reads members of a model's material before its images are asked for. Members that the model may
  // not change any more are added to `given`.
  void override(JsonObject& object, Material& material, GivenMembers& given);

 private:
  struct NamedTexture {
    JsonValue definition;
    // By use; a pattern has the slot of its only use.
    std::map<TextureUse, std::int32_t> slots;
  };

  std::int32_t texture(const JsonValue& name, TextureUse use);
  std::int32_t load(const JsonValue& definition, const JsonValue& name, TextureUse use);
  std::int32_t loadArray(JsonObject& object, const JsonValue& name, TextureUse use);

  SceneContext& context_;
  std::map<std::string, NamedTexture> textures_;
  std::map<std::string, std::uint32_t> materials_;
  std::optional<std::uint32_t> default_;
};

}  // namespace whit
