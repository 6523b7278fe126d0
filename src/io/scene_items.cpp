#include "io/scene_items.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/nearest_name.h"
#include "io/scene_transform.h"
#include "io/shape_parameters.h"
#include "scene/generation_limit.h"

namespace whit {
namespace {

// The member of "materials" that has to do with `name` is read; the rest must be names as well.
[[noreturn]] void failSlot(const JsonValue& slot, const std::string& key,
                           const std::vector<std::string>& names, const std::string& kind) {
  const std::string nearest = nearestName(key, names);
  throwBadScene(
      slot.where(),
      "unknown " + kind + (nearest.empty() ? std::string() : "; is \"" + nearest + "\" meant?"));
}

// By which scene files call the materials of a model: their names, with a number after those that
// are taken.
std::vector<std::string> distinctNames(const std::vector<Material>& materials) {
  std::set<std::string> taken;
  for (const Material& material : materials) taken.insert(material.name);
  std::map<std::string, int> uses;
  std::vector<std::string> names;
  for (const Material& material : materials) {
    std::string name = material.name;
    int& use = uses[material.name];
    while (++use > 1 && !taken.insert(name = material.name + "#" + std::to_string(use)).second) {
    }
    names.push_back(name);
  }
  return names;
}

}  // namespace

void ItemReader::read(JsonObject& file) {
  const auto objects = file.find("objects");
  if (objects) {
    for (const auto& [name, value] : objects->members()) {
      objects_.emplace(name, NamedObject{value});
    }
    for (const auto& [name, value] : objects->members()) readObject(objects_.at(name), name);
  }
  if (const auto scene = file.find("scene")) {
    const std::vector<JsonValue> items = scene->elements();
    for (std::size_t i = 0; i < items.size(); ++i) {
      reportProgress(context_.progress, "reading scene",
                     static_cast<double>(i) / static_cast<double>(items.size()));
      readItem(items[i], layout_.body(0));
    }
  }
  layout_.moveTo(context_.scene);
}

void ItemReader::readModelAlone(JsonObject& file, const std::filesystem::path& path) {
  Model& model = context_.model(path);
  const std::vector<std::uint32_t> materials = modelMaterials(model, file);
  layout_.append(contentOf(model, path, materials), {Affine()}, layout_.body(0));
  layout_.moveTo(context_.scene);
  model.addView(context_.scene);
}

std::uint32_t ItemReader::readObject(NamedObject& object, const std::string& name) {
  using State = NamedObject::State;
  if (object.state == State::reading) {
    throwBadScene(object.definition.where(), "this object contains itself");
  }
  if (object.state == State::unread) {
    object.state = State::reading;
    object.body = layout_.add(name);
    readItems(object.definition, layout_.body(object.body));
    object.state = State::read;
  }
  return object.body;
}

std::uint32_t ItemReader::object(const JsonValue& name) {
  const auto found = objects_.find(name.text());
  if (found != objects_.end()) return readObject(found->second, found->first);
  std::vector<std::string> names;
  for (const auto& [known, object] : objects_) names.push_back(known);
  const std::string nearest = nearestName(name.text(), names);
  name.fail("the name of an object" +
            (nearest.empty() ? std::string() : " (is \"" + nearest + "\" meant?)"));
}

void ItemReader::readItems(const JsonValue& list, Body& to) {
  for (const JsonValue& item : list.elements()) readItem(item, to);
}

void ItemReader::readItem(const JsonValue& value, Body& to) {
  if (++depth_ > kNestingLimit) {
    throwBadScene(value.where(), "nested deeper than " + std::to_string(kNestingLimit) + " items");
  }
  JsonObject item(value);
  Body content;
  if (const auto shape = item.find("shape")) {
    content = readShape(item, *shape);
  } else if (const auto model = item.find("model")) {
    content = readModel(item, *model);
  } else if (const auto use = item.find("use")) {
    content.children.push_back({object(*use), Affine()});
  } else if (const auto group = item.find("group")) {
    readItems(*group, content);
  } else {
    item.finish();
    value.fail("an item with \"shape\", \"model\", \"use\" or \"group\"");
  }
  const std::vector<Affine> placements = readPlacements(item);
  item.finish();
  layout_.append(content, placements, to);
  --depth_;
}

Body ItemReader::readShape(JsonObject& item, const JsonValue& name) {
  JsonShapeParameters parameters(item);
  const GenerationLimit limit(context_.budget.left());
  Shape shape = findGenerator(name, shapeGenerators())(parameters);
  const auto everywhere = item.find("material");
  const auto bySlot = item.find("materials");
  std::map<std::string, std::uint32_t> slots;
  if (bySlot) {
    std::vector<std::string> names;
    for (const ShapePart& part : shape.parts) names.push_back(part.slot);
    for (const auto& [slot, material] : bySlot->members()) {
      if (std::find(names.begin(), names.end(), slot) == names.end()) {
        failSlot(material, slot, names, "slot of this shape");
      }
      slots[slot] = materials_.find(material);
    }
  }
  Body content;
  for (ShapePart& part : shape.parts) {
    const auto slot = slots.find(part.slot);
    const std::uint32_t material = slot != slots.end() ? slot->second
                                   : everywhere        ? materials_.find(*everywhere)
                                                       : materials_.defaultMaterial();
    context_.budget.charge(1, bytesOf(part.mesh), name.where());
    part.mesh.materials = {material};
    if (part.mesh.name.empty()) part.mesh.name = name.text() + "/" + part.slot;
    content.parts.push_back({std::make_shared<Mesh>(std::move(part.mesh)), Affine()});
  }
  if (shape.placements.empty()) return content;
  const std::uint32_t body = layout_.add(name.text());
  layout_.body(body) = std::move(content);
  Body placed;
  for (const Affine& placement : shape.placements) placed.children.push_back({body, placement});
  return placed;
}

Body ItemReader::readModel(JsonObject& item, const JsonValue& path) {
  const auto file = context_.rules.resolve(path.text(), context_.folder, path.where());
  Model& model = context_.model(file);
  return contentOf(model, file, modelMaterials(model, item));
}

// Overrides first, then images are asked for: they are decoded while the geometry is read.
std::vector<std::uint32_t> ItemReader::modelMaterials(Model& model, JsonObject& item) {
  std::vector<Material> materials = model.materials();
  std::vector<GivenMembers> given(materials.size());
  const std::vector<std::string> names = distinctNames(materials);
  const std::string section = item.value().pointer() + "/materials/";
  for (std::size_t i = 0; i < materials.size(); ++i) {
    materials[i].pointer = section + escapePointer(names[i]);
  }
  if (const auto overrides = item.find("materials")) {
    const auto apply = [&](const JsonValue& value, std::size_t i) {
      JsonObject object(value);
      materials_.override(object, materials[i], given[i]);
      object.finish();
    };
    for (const auto& [name, value] : overrides->members()) {
      if (name != "*") continue;
      for (std::size_t i = 0; i < materials.size(); ++i) apply(value, i);
    }
    for (const auto& [name, value] : overrides->members()) {
      if (name == "*") continue;
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) failSlot(value, name, names, "material of this model");
      apply(value, static_cast<std::size_t>(found - names.begin()));
    }
  }
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    indices.push_back(addMaterial(model, i, std::move(materials[i]), given[i]));
  }
  return indices;
}

std::uint32_t ItemReader::addMaterial(Model& model, std::size_t i, Material material,
                                      const GivenMembers& given) {
  TexturedMaterial textured = model.withMaps(i, std::move(material), given, context_.textures);
  const std::uint32_t index = materials_.add(std::move(textured.material));
  if (textured.whenDecoded) {
    context_.textures.whenDone([index, change = std::move(textured.whenDecoded)](
                                   SceneDescription& scene) { change(scene.materials[index]); });
  }
  return index;
}

Body ItemReader::contentOf(Model& model, const std::filesystem::path& path,
                           const std::vector<std::uint32_t>& materials) {
  reportProgress(context_.progress, "reading " + path.filename().string(), 0);
  return model.content(layout_, materials);
}

}  // namespace whit
