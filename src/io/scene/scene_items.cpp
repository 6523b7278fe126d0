// The sections "objects" and "scene" of a scene file.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/affine.h"
#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "core/vec3.h"
#include "io/json_reader.h"
#include "io/scene/scene_layout.h"
#include "io/scene/scene_sections.h"
#include "io/scene/up_axis.h"
#include "scene/generation_limit.h"

namespace whit {

namespace {

constexpr int kRepeatLimit = 10'000'000;  // copies made by one "repeat"

Affine readScale(const JsonValue& value) {
  const Vec3d scale = value.isNumber() ? Vec3d(value.number()) : value.vector();
  if (scale.x == 0 || scale.y == 0 || scale.z == 0) value.fail("a scale other than 0");
  return Affine::scaling(scale);
}

Affine readRotations(const JsonValue& value) {
  const auto elements = value.elements();
  const auto rotation = [](const JsonValue& turn) {
    const auto [axis, degrees] = readTurn(turn);
    return Affine::rotation(axis, degrees);
  };
  if (elements.empty() || !elements[0].isArray()) return rotation(value);
  Affine result;
  for (const JsonValue& element : elements) result = rotation(element) * result;
  return result;
}

Affine readMatrix(const JsonValue& value) {
  const auto e = value.elements(12, "12 numbers: a matrix of 3 rows of 4");
  const auto column = [&](std::size_t i) {
    return Vec3d{e[i].number(), e[i + 4].number(), e[i + 8].number()};
  };
  return {column(0), column(1), column(2), column(3)};
}

Affine readOne(const JsonValue& value) {
  JsonObject object(value);
  Affine result;
  if (const JsonValue matrix = object.find("matrix")) {
    result = readMatrix(matrix);
  } else {
    if (const JsonValue scale = object.find("scale")) result = readScale(scale);
    if (const JsonValue rotate = object.find("rotate")) result = readRotations(rotate) * result;
    if (const JsonValue translate = object.find("translate")) {
      result = Affine::translation(translate.vector()) * result;
    }
  }
  object.finish();
  return result;
}

// Reads {"translate", "rotate", "scale"} (scale first, translate last), {"matrix": 12 numbers,
// row-major 3x4}, or a list of those, the first applied first. Fails for maps that flatten space.
Affine readTransform(const JsonValue& value) {
  Affine result;
  if (value.isArray()) {
    for (const JsonValue& element : value.elements()) result = readOne(element) * result;
  } else {
    result = readOne(value);
  }
  const double volume = result.determinant();
  if (!std::isfinite(volume) || volume == 0) value.fail("a transform that can be undone");
  return result;
}

// Returns where the copies of an item stand in its parent, one or more: "transform", and then moved
// by multiples of the step of "repeat".
std::vector<Affine> readPlacements(JsonObject& item) {
  const JsonValue transform = item.find("transform"), value = item.find("repeat");
  const Affine once = transform ? readTransform(transform) : Affine();
  if (!value) return {once};

  JsonObject repeat(value);
  const JsonValue countValue = repeat.need("count");
  const auto counts = countValue.elements(3, "three numbers of copies [nx, ny, nz]");
  const Vec3d step = repeat.need("step").vector();
  repeat.finish();

  int n[3];
  double total = 1;
  for (const auto i : indices(3)) {
    n[i] = counts[i].integer(1, kRepeatLimit);
    total *= n[i];
  }
  if (total > kRepeatLimit) countValue.fail(concat("at most ", kRepeatLimit, " copies"));

  std::vector<Affine> result;
  result.reserve(static_cast<std::size_t>(total));
  for (int z = 0; z < n[2]; ++z) {
    for (int y = 0; y < n[1]; ++y) {
      for (int x = 0; x < n[0]; ++x) {
        result.push_back(Affine::translation(step * Vec3d(x, y, z)) * once);
      }
    }
  }
  return result;
}

// Gives this name to everything in the content that has none.
void nameItem(Body& content, const std::string& pointer) {
  const ItemName name = std::make_shared<const std::string>(pointer);
  for (Placement& placed : content.placements) {
    if (!placed.item) placed.item = name;
  }
}

// Returns the index of `key` in `names`. An error at `slot` suggests the nearest name.
std::size_t slotOf(const JsonValue& slot, const std::string& key,
                   const std::vector<std::string>& names, const std::string& kind) {
  const auto found = std::ranges::find(names, key);
  if (found == names.end()) throwBadScene(slot.where(), "unknown " + kind + suggestion(key, names));
  return found - names.begin();
}

// Returns the rotation that turns this axis upwards.
Affine uprightFrom(char up) {
  if (up == 'z') return {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {}};
  if (up == 'x') return {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {}};
  return {};
}

class ItemReader {
 public:
  ItemReader(SceneContext& context, MaterialReader& materials)
      : context_(context), materials_(materials), layout_(context.budget) {}

  void read(JsonObject& file) {
    const auto objects = file.find("objects").members();
    for (const auto& [name, value] : objects) objects_.emplace(name, NamedObject{value});
    for (const auto& [name, value] : objects) readObject(objects_.at(name), name);

    const std::vector<JsonValue> items = file.find("scene").elements();
    for (const auto i : indices(items)) {
      reportProgress(context_.progress, "reading scene",
                     static_cast<double>(i) / static_cast<double>(items.size()));
      readItem(items[i], layout_.body(0));
    }

    if (layout_.moveTo(context_.scene) != Vec3d()) {
      context_.warnings.note(
          "scene far from the origin: single precision rounds its coordinates (its items should be "
          "moved to the origin)",
          context_.scene.name);
    }

    addViews(file);
  }

  void readModelAlone(JsonObject& file, const std::filesystem::path& path) {
    Model& model = context_.model(path, "");
    Body content = contentOf(model, path, file);
    nameItem(content, path.stem().string());
    context_.scene.upright = upright(file, path, content);
    layout_.append(content, {context_.scene.upright}, layout_.body(0));

    const Vec3d origin = layout_.moveToOrigin(context_.scene);
    if (origin != Vec3d()) {
      context_.warnings.note(
          formatted("model far from the origin: origin moved by %.17g,%.17g,%.17g", origin.x,
                    origin.y, origin.z),
          context_.scene.name);
    }

    model.addView(context_.scene, Affine());
  }

 private:
  // A model of the list "scene" whose cameras and lights the scene may take over, and where it
  // stands.
  struct ViewedModel {
    Model* model;
    Affine toWorld;
    std::string where;
  };

  // With "view" the scene takes the cameras and lights of its models. A picture whose size is
  // stated keeps it. Otherwise a scene has its own, and those of models are left out.
  void addViews(JsonObject& file) {
    SceneDescription& scene = context_.scene;
    const bool takesViews = file.has("view");
    const int width = scene.width;
    for (const ViewedModel& viewed : viewed_) {
      if (takesViews) {
        viewed.model->addView(scene, viewed.toWorld);
      } else {
        warnOfView(*viewed.model, viewed.where);
      }
    }

    if (file.has("size")) scene.width = width;
    std::vector<std::string> names = distinctNames(namesIn(scene.cameras));
    for (const auto i : indices(names)) scene.cameras[i].name = std::move(names[i]);
  }

  void warnOfView(const Model& model, const std::string& where) {
    context_.warnings.add(
        "cameras and lights of a model left out: a scene states its own, or takes those of the "
        "models in \"scene\", placed once and at rest, by \"view\": \"model\"",
        where, model.viewSize());
  }

  // Returns the rotation that makes the model stand. Files of OBJ, PLY and OFF do not say which
  // axis is up. In STL files it is z by custom.
  Affine upright(JsonObject& file, const std::filesystem::path& path, const Body& content) {
    const std::string format = extensionOf(path);
    const bool says =
        format.starts_with(".gl") || format == ".fbx" || format == ".dae" || format == ".3ds";
    if (const JsonValue up = file.find("up")) {
      const std::string axis = up.text();
      if (says) up.fail("no axis, because files of this format say which one is up");
      if (axis != "x" && axis != "y" && axis != "z") up.fail("\"x\", \"y\" or \"z\"");
      return uprightFrom(axis[0]);
    }

    if (format == ".stl") return uprightFrom('z');
    if (says || !seemsZUp(content)) return {};
    context_.warnings.add("model in which z seems to be up was turned (--up y leaves it as it is)",
                          path.filename().string());
    return uprightFrom('z');
  }

  struct NamedObject {
    JsonValue definition;
    enum class State { unread, reading, read } state = State::unread;
    std::uint32_t body = 0;
  };

  void readItems(const JsonValue& list, Body& to) {
    for (const JsonValue& item : list.elements()) readItem(item, to);
  }

  void readItem(const JsonValue& value, Body& to) {
    if (++depth_ > kNestingLimit) {
      throwBadScene(value.where(), concat("nested deeper than ", kNestingLimit, " items"));
    }

    JsonObject item(value);
    Body content;
    Model* model = nullptr;
    if (const JsonValue shape = item.find("shape")) {
      content = readShape(item, shape);
    } else if (const JsonValue path = item.find("model")) {
      model = &modelAt(path);
      content = contentOf(*model, path.text(), item);
    } else if (context_.parts && item.has("mesh")) {
      content = readMesh(item, item.find("mesh"));
    } else if (const JsonValue use = item.find("use")) {
      const std::string name = findNamed(objects_, use, "an object")->first;
      content.placements.push_back({.body = readObject(objects_.at(name), name)});
    } else if (const JsonValue group = item.find("group")) {
      readItems(group, content);
    } else {
      item.finish();
      value.fail("an item with \"shape\", \"model\", \"use\" or \"group\"");
    }

    nameItem(content, value.pointer());
    std::vector<Affine> placements = readPlacements(item);
    const SharedMotion motion = readMotion(item, context_.instant, context_.scene);
    item.finish();

    const bool isOnceInScene = &to == &layout_.body(0) && placements.size() == 1 && !motion;
    if (model && isOnceInScene) {
      viewed_.push_back({model, placements[0], value.where()});
    } else if (model) {
      warnOfView(*model, value.where());
    }

    // What moves is a body of its own, which its placement carries.
    if (motion && context_.instant.moves()) {
      const std::uint32_t carried = layout_.add("");
      layout_.append(content, placements, layout_.body(carried));
      to.placements.push_back(
          {.body = carried, .motion = motion, .mover = movableName(item, context_.instant)});
    } else {
      if (motion) {
        for (Affine& placement : placements) placement = (*motion)(0) * placement;
      }
      layout_.append(content, placements, to);
    }

    --depth_;
  }

  Body readShape(JsonObject& item, const JsonValue& name) {
    const GenerationLimit limit(context_.budget.left());
    Shape shape = generate(name, shapeGenerators(), item);

    const JsonValue everywhere = item.find("material");
    std::map<std::string, std::uint32_t> slots;
    std::vector<std::string> names;
    for (const ShapePart& part : shape.parts) names.push_back(part.slot);

    for (const auto& [slot, material] : item.find("materials").members()) {
      slotOf(material, slot, names, "slot of this shape");
      slots[slot] = materials_.find(material);
    }

    Body content;
    for (ShapePart& part : shape.parts) {
      const auto slot = slots.find(part.slot);
      std::uint32_t material = 0;
      if (slot != slots.end()) {
        material = slot->second;
      } else {
        material = everywhere ? materials_.find(everywhere) : materials_.defaultMaterial();
      }

      context_.budget.charge(1, bytesOf(part.mesh), name.where());
      part.mesh.materials = {material};
      if (part.mesh.name.empty()) part.mesh.name = name.text() + "/" + part.slot;
      content.addMesh(std::move(part.mesh));
    }

    if (shape.placements.empty()) return content;
    const std::uint32_t body = layout_.add(name.text());
    layout_.body(body) = std::move(content);

    Body placed;
    for (const Affine& placement : shape.placements)
      placed.placements.push_back({.body = body, .toParent = placement});
    return placed;
  }

  Model& modelAt(const JsonValue& path) {
    const auto file = context_.rules.resolve(path.text(), context_.folder, path.where());
    if (!isModelFile(file)) path.fail("a model (" + modelExtensions() + ")");
    return context_.model(file, path.where());
  }

  // Makes each mesh a body of its own, so that a mesh which is placed several times is stored once.
  Body readMesh(JsonObject& item, const JsonValue& name) {
    const auto found = findNamed(context_.parts->meshes, name, "a mesh");
    const JsonValue named = item.find("material");
    const std::uint32_t material = named ? materials_.find(named) : materials_.defaultMaterial();

    const auto [entry, isNew] = meshes_.try_emplace({found->first, material}, 0);
    if (isNew) {
      Mesh mesh = meshOf(found->second, name.where());
      context_.budget.charge(1, bytesOf(mesh), name.where());
      mesh.name = found->first;
      mesh.materials = {material};
      entry->second = layout_.add(found->first);
      layout_.body(entry->second).addMesh(std::move(mesh));
    }

    Body content;
    content.placements.push_back({.body = entry->second});
    return content;
  }

  Body contentOf(Model& model, const std::filesystem::path& path, JsonObject& item) {
    const std::vector<std::uint32_t> materials = modelMaterials(model, item);
    reportProgress(context_.progress, "reading " + path.filename().string(), 0);

    model.variant.reset();
    if (const JsonValue name = item.find("variant")) {
      const std::vector<std::string> names = model.variants();
      if (names.empty()) name.fail("no variant, because the model has none");
      model.variant = std::ranges::find(names, name.word(names)) - names.begin();
    }

    return model.content(layout_, materials);
  }

  // Applies the overrides of materials, and then requests their images, which are decoded while the
  // geometry is read. Returns the scene's index of each material.
  std::vector<std::uint32_t> modelMaterials(Model& model, JsonObject& item) {
    std::vector<Material> materials = model.materials();
    std::vector<GivenMembers> given(materials.size());
    const std::vector<std::string> names = distinctNames(namesIn(materials));
    const std::string section = item.value().pointer() + "/materials/";

    for (const auto i : indices(materials)) {
      materials[i].pointer = section + escapePointer(names[i]);
    }

    const auto apply = [&](const JsonValue& value, std::size_t i) {
      JsonObject object(value);
      materials_.override(object, materials[i], given[i]);
      object.finish();
    };

    // Overrides of all materials come before those of one.
    const auto overrides = item.find("materials").members();
    for (const auto& [name, value] : overrides) {
      if (name != "*") continue;
      for (const auto i : indices(materials)) apply(value, i);
    }
    for (const auto& [name, value] : overrides) {
      if (name != "*") apply(value, slotOf(value, name, names, "material of this model"));
    }

    std::vector<std::uint32_t> numbers;
    for (const auto i : indices(materials)) {
      TexturedMaterial textured =
          model.withMaps(i, std::move(materials[i]), given[i], context_.textures);
      const std::uint32_t index =
          numbers.emplace_back(materials_.add(std::move(textured.material)));
      if (!textured.whenDecoded) continue;
      context_.textures.whenDone([index, change = std::move(textured.whenDecoded)](
                                     SceneDescription& scene) { change(scene.materials[index]); });
    }
    return numbers;
  }

  std::uint32_t readObject(NamedObject& object, const std::string& name) {
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

  SceneContext& context_;
  MaterialReader& materials_;
  SceneLayout layout_;
  std::map<std::string, NamedObject> objects_;
  // Bodies of the meshes that a program hands over, by name and material.
  std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> meshes_;
  std::vector<ViewedModel> viewed_;
  int depth_ = 0;  // depth of the item that is being read
};

}  // namespace

void readItems(JsonObject& file, SceneContext& context, MaterialReader& materials) {
  ItemReader(context, materials).read(file);
}

void readModelAlone(JsonObject& file, const std::filesystem::path& path, SceneContext& context,
                    MaterialReader& materials) {
  ItemReader(context, materials).readModelAlone(file, path);
}

}  // namespace whit
