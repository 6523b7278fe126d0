#include "oracle/write_scene.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace oracle {

// Members keep their order, which is that of what they name. Every double comes back.
using Json = nlohmann::ordered_json;

static void to_json(Json& json, const Vec& v) { json = {v.x, v.y, v.z}; }

namespace {

void save(const std::string& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

std::string numbered(const std::string& kind, std::size_t number) {
  return kind + std::to_string(number);
}

Json jsonOf(const Transform& t) {
  const auto& [x, y, z] = t.axis;
  return {{"scale", t.scale}, {"rotate", {x, y, z, t.degrees}}, {"translate", t.translate}};
}

void addMotion(const Motion& motion, Json& noun) {
  if (motion.keys.empty()) return;
  Json keys;
  for (const auto& [time, scale, degrees, translate] : motion.keys) {
    keys.push_back(jsonOf(Transform{scale, motion.axis, degrees, translate}));
    keys.back()["time"] = time;
  }
  noun["motion"] = {{"keys", keys}, {"interpolation", motion.inSteps ? "step" : "linear"}};
}

Json jsonOf(const Camera& c) {
  Json json{{"eye", c.eye}, {"at", c.at}, {"up", c.up}};
  if (c.orthographicHeight > 0) {
    json["orthographicHeight"] = c.orthographicHeight;
  } else {
    json["fov"] = c.fov;
  }
  if (c.aperture > 0) json.update({{"aperture", c.aperture}, {"focus", c.focus}});
  addMotion(c.motion, json);
  return json;
}

Json jsonOf(const Light& light) {
  const char* const kinds[] = {"point", "spot", "directional"};
  Json json{{"type", kinds[static_cast<int>(light.kind)]}};
  if (light.kind == Light::Kind::directional) {
    json["irradiance"] = light.intensity;
  } else {
    json.update(
        {{"position", light.position}, {"intensity", light.intensity}, {"radius", light.radius}});
  }

  if (light.kind != Light::Kind::point) json["direction"] = light.direction;
  if (light.kind == Light::Kind::spot) {
    json.update(
        {{"innerConeAngle", light.innerConeAngle}, {"outerConeAngle", light.outerConeAngle}});
  }
  addMotion(light.motion, json);
  return json;
}

Json jsonOf(const Sky& sky) {
  if (sky.kind == Sky::Kind::image) {
    return {{"scale", sky.scale}, {"image", "sky.hdr"}, {"rotation", sky.rotation}};
  }
  return {{"scale", sky.scale},
          {"zenith", sky.zenith},
          {"horizon", sky.horizon},
          {"ground", sky.ground}};
}

Json jsonOf(const Ambient& ambient) {
  Json json;
  if (ambient.occlusion > 0) json["occlusion"] = ambient.occlusion;
  if (ambient.fromSky > 0) {
    json["fromSky"] = ambient.fromSky;
  } else {
    json.update({{"up", ambient.up}, {"down", ambient.down}});
  }
  return json;
}

Json jsonOf(const Material& m) {
  Json json{{"diffuse", m.diffuse},   {"specular", m.specular}, {"roughness", m.roughness},
            {"emission", m.emission}, {"mirror", m.mirror},     {"mirrorGrazing", m.mirrorGrazing}};

  for (const auto& [key, map] : {std::pair{"diffuseMap", m.diffuseMap},
                                 {"specularMap", m.specularMap},
                                 {"emissionMap", m.emissionMap},
                                 {"normalMap", m.normalMap},
                                 {"alphaMap", m.alphaMap},
                                 {"coverageMap", m.coverageMap}}) {
    if (map != kNone) json[key] = numbered("map", map);
  }

  if (m.alphaMap != kNone) json["alphaCutoff"] = m.alphaCutoff;
  if (m.coverage < 1) json["coverage"] = m.coverage;
  if (m.transmits()) {
    json.update({{"transmission", m.transmission},
                 {"ior", m.ior},
                 {"absorption", m.absorption},
                 {"priority", m.priority}});
  }

  if (!m.diffuseReflection) json["diffuseReflection"] = false;
  if (m.thin) json["thin"] = true;
  if (m.frosted) json["frosted"] = true;
  if (m.coat) json["coat"] = true;
  if (m.glossyReflection != Choice::unsaid) {
    json["glossyReflection"] = m.glossyReflection == Choice::yes;
  }

  // Said only where it is not what the rest makes of it.
  const bool casts = !m.transmits() && m.coverage >= 0.5;
  if (m.castsShadow != casts) json["castsShadow"] = m.castsShadow;
  return json;
}

std::string ply(const Mesh& mesh) {
  std::ostringstream out;
  out.precision(17);  // every double comes back
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.positions.size()
      << "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!mesh.normals.empty()) out << "property float nx\nproperty float ny\nproperty float nz\n";
  if (!mesh.colors.empty())
    out << "property float red\nproperty float green\nproperty float blue\n";
  if (!mesh.uvs.empty()) out << "property float u\nproperty float v\n";
  out << "element face " << mesh.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";

  const auto put = [&](const Vec& v) { out << v.x << ' ' << v.y << ' ' << v.z << ' '; };
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    put(mesh.positions[i]);
    if (!mesh.normals.empty()) put(mesh.normals[i]);
    if (!mesh.colors.empty()) put(mesh.colors[i]);
    if (!mesh.uvs.empty()) out << mesh.uvs[i][0] << ' ' << mesh.uvs[i][1];
    out << '\n';
  }

  for (const auto& [a, b, c] : mesh.triangles) out << "3 " << a << ' ' << b << ' ' << c << '\n';
  return out.str();
}

// Radiance's format without run lengths: channels in 256ths, by an exponent that is always 0.
std::string hdr(const Sky& sky) {
  std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(sky.height) +
                     " +X " + std::to_string(sky.width) + "\n";
  for (const Color& c : sky.texels) {
    for (const double channel : {c.x, c.y, c.z, 0.5}) file += char(static_cast<int>(channel * 256));
  }
  return file;
}

// Uncompressed, rows from the top, blue first.
std::string tga(const Texture& texture) {
  std::string file(18, '\0');
  file[2] = 2;
  file[12] = char(texture.width);
  file[14] = char(texture.height);
  file[16] = 24;
  file[17] = 0x20;
  for (const auto& [r, g, b] : texture.texels) {
    for (const int channel : {b, g, r}) file += char(channel);
  }
  return file;
}

Json shapeOf(const Scene& scene, const Object& object) {
  if (object.radius > 0) {
    return {{"shape", "sphere"},
            {"radius", object.radius},
            {"material", numbered("material", object.material)}};
  }
  return {{"model", numbered("mesh", object.mesh) + ".ply"},
          {"materials", {{"*", jsonOf(scene.materials[object.material])}}}};
}

Json itemOf(const Scene& scene, const Body& body);

// The items of an object's list.
Json contentOf(const Scene& scene, const Object& object) {
  Json items;
  for (const Body& body : object.before) items.push_back(itemOf(scene, body));
  items.push_back(shapeOf(scene, object));
  for (const Body& body : object.after) items.push_back(itemOf(scene, body));
  return items;
}

Json itemOf(const Scene& scene, const Body& body) {
  Json json{{"transform", jsonOf(body.transform)}};
  if (body.inPlace) {
    json["group"] = contentOf(scene, scene.objects[body.object]);
  } else {
    json["use"] = numbered("object", body.object);
  }
  addMotion(body.motion, json);
  return json;
}

Json jsonOf(const Scene& scene) {
  Json lights = Json::array(), bodies = Json::array();
  for (const Light& light : scene.lights) lights.push_back(jsonOf(light));
  for (const Body& body : scene.bodies) bodies.push_back(itemOf(scene, body));

  Json textures = Json::object(), materials = Json::object(), objects = Json::object();
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    const std::string name = numbered("map", i);
    textures[name] = {{"image", name + ".tga"}};
  }
  // Shapes name their materials; models have them.
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    objects[numbered("object", i)] = contentOf(scene, object);
    if (!(object.radius > 0)) continue;
    materials[numbered("material", object.material)] = jsonOf(scene.materials[object.material]);
  }

  return {{"whit", 1},
          {"size", {scene.width, scene.height}},
          {"cameras", {{"main", jsonOf(scene.camera)}}},
          {"lights", lights},
          {"sky", jsonOf(scene.sky)},
          {"ambient", jsonOf(scene.ambient)},
          {"textures", textures},
          {"materials", materials},
          {"objects", objects},
          {"scene", bodies}};
}

}  // namespace

std::string writeScene(const Scene& scene, const std::string& folder) {
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    save(folder + numbered("/mesh", i) + ".ply", ply(scene.meshes[i]));
  }
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    save(folder + numbered("/map", i) + ".tga", tga(scene.textures[i]));
  }
  if (scene.sky.kind == Sky::Kind::image) save(folder + "/sky.hdr", hdr(scene.sky));
  save(folder + "/scene.json", jsonOf(scene).dump());
  return folder + "/scene.json";
}

}  // namespace oracle
