// The sections "objects" and "scene" of a scene file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/json_reader.h"
#include "io/scene/scene_context.h"
#include "io/scene/scene_layout.h"
#include "io/scene/scene_materials.h"

namespace whit {

class ItemReader {
 public:
  ItemReader(SceneContext& context, MaterialReader& materials)
      : context_(context), materials_(materials), layout_(context.budget) {}

  // Fills in the scene's objects and instances.
  void read(JsonObject& file);
  // A scene that is a model and nothing else, but for the section "materials" of `file`: what
  // materials of the model are to be instead.
  void readModelAlone(JsonObject& file, const std::filesystem::path& path);

 private:
  struct NamedObject {
    JsonValue definition;
    enum class State { unread, reading, read } state = State::unread;
    std::uint32_t body = 0;
  };

  void readItems(const JsonValue& list, Body& to);
  void readItem(const JsonValue& value, Body& to);
  Body readShape(JsonObject& item, const JsonValue& name);
  Body readModel(JsonObject& item, const JsonValue& path);
  Body readMesh(JsonObject& item, const JsonValue& name);
  std::vector<std::uint32_t> modelMaterials(Model& model, JsonObject& item);
  std::uint32_t addMaterial(Model& model, std::size_t i, Material material,
                            const GivenMembers& given);
  Body contentOf(Model& model, const std::filesystem::path& path,
                 const std::vector<std::uint32_t>& materials);
  std::uint32_t object(const JsonValue& name);
  std::uint32_t readObject(NamedObject& object, const std::string& name);

  SceneContext& context_;
  MaterialReader& materials_;
  SceneLayout layout_;
  std::map<std::string, NamedObject> objects_;
  // Bodies of the meshes that a program hands over, by name and material.
  std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> meshes_;
  int depth_ = 0;  // of the item that is being read
};

}  // namespace whit
