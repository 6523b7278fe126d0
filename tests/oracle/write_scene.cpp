#include "oracle/write_scene.h"

#include <concepts>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace oracle {

namespace {

void save(const std::string& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file << bytes;
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

// A stream in which every double comes back.
std::ostringstream exactStream() {
  std::ostringstream out;
  out.precision(17);
  return out;
}

std::string json(double value) {
  std::ostringstream out = exactStream();
  out << value;
  return out.str();
}

std::string json(std::same_as<bool> auto value) { return value ? "true" : "false"; }

std::string json(const std::string& text) { return '"' + text + '"'; }

using List = std::vector<std::string>;  // of JSON

std::string json(const List& elements) {
  std::string text;
  for (const std::string& element : elements) text += (text.empty() ? "" : ", ") + element;
  return "[" + text + "]";
}

std::string json(const Vec& v) { return json(List{json(v.x), json(v.y), json(v.z)}); }

// The members of an object.
class Members {
 public:
  template <typename Value>
  Members& add(const std::string& key, const Value& value) {
    text_ += (text_.empty() ? "" : ",\n") + json(key) + ": " + json(value);
    return *this;
  }

  friend std::string json(const Members& members) { return "{" + members.text_ + "}"; }

 private:
  std::string text_;
};

std::string numbered(const std::string& kind, std::size_t number) {
  return kind + std::to_string(number);
}

Members membersOf(const Transform& t) {
  const auto& [x, y, z] = t.axis;
  return Members()
      .add("scale", t.scale)
      .add("rotate", List{json(x), json(y), json(z), json(t.degrees)})
      .add("translate", t.translate);
}

void addMotion(const Motion& motion, Members& members) {
  if (motion.keys.empty()) return;
  List keys;
  for (const auto& [time, scale, degrees, translate] : motion.keys) {
    const Transform place{scale, motion.axis, degrees, translate};
    keys.push_back(json(membersOf(place).add("time", time)));
  }
  const std::string way = motion.inSteps ? "step" : "linear";
  members.add("motion", Members().add("keys", keys).add("interpolation", way));
}

Members membersOf(const Camera& c) {
  Members members;
  members.add("eye", c.eye).add("at", c.at).add("up", c.up);
  if (c.orthographicHeight > 0) {
    members.add("orthographicHeight", c.orthographicHeight);
  } else {
    members.add("fov", c.fov);
  }
  if (c.aperture > 0) members.add("aperture", c.aperture).add("focus", c.focus);
  addMotion(c.motion, members);
  return members;
}

Members membersOf(const Light& light) {
  const std::string kinds[] = {"point", "spot", "directional"};
  Members members;
  members.add("type", kinds[static_cast<int>(light.kind)]);
  if (light.kind == Light::Kind::directional) {
    members.add("irradiance", light.intensity);
  } else {
    members.add("position", light.position)
        .add("intensity", light.intensity)
        .add("radius", light.radius);
  }

  if (light.kind != Light::Kind::point) members.add("direction", light.direction);
  if (light.kind == Light::Kind::spot) {
    members.add("innerConeAngle", light.innerConeAngle).add("outerConeAngle", light.outerConeAngle);
  }
  addMotion(light.motion, members);
  return members;
}

Members membersOf(const Sky& sky) {
  Members members;
  members.add("scale", sky.scale);
  if (sky.kind == Sky::Kind::image) {
    return members.add("image", std::string("sky.hdr")).add("rotation", sky.rotation);
  }
  return members.add("zenith", sky.zenith).add("horizon", sky.horizon).add("ground", sky.ground);
}

Members membersOf(const Ambient& ambient) {
  Members members;
  if (ambient.occlusion > 0) members.add("occlusion", ambient.occlusion);
  if (ambient.fromSky > 0) return members.add("fromSky", ambient.fromSky);
  return members.add("up", ambient.up).add("down", ambient.down);
}

Members membersOf(const Material& m) {
  Members members;
  members.add("diffuse", m.diffuse)
      .add("specular", m.specular)
      .add("roughness", m.roughness)
      .add("emission", m.emission)
      .add("mirror", m.mirror)
      .add("mirrorGrazing", m.mirrorGrazing);

  for (const auto& [key, map] : {std::pair{"diffuseMap", m.diffuseMap},
                                 {"specularMap", m.specularMap},
                                 {"emissionMap", m.emissionMap},
                                 {"normalMap", m.normalMap},
                                 {"alphaMap", m.alphaMap},
                                 {"coverageMap", m.coverageMap}}) {
    if (map != kNone) members.add(key, numbered("map", map));
  }

  if (m.alphaMap != kNone) members.add("alphaCutoff", m.alphaCutoff);
  if (m.coverage < 1) members.add("coverage", m.coverage);
  if (m.transmits()) {
    members.add("transmission", m.transmission)
        .add("ior", m.ior)
        .add("absorption", m.absorption)
        .add("priority", m.priority);
  }

  if (!m.diffuseReflection) members.add("diffuseReflection", false);
  if (m.thin) members.add("thin", true);
  if (m.frosted) members.add("frosted", true);
  if (m.coat) members.add("coat", true);
  if (m.glossyReflection != Choice::unsaid) {
    members.add("glossyReflection", m.glossyReflection == Choice::yes);
  }

  // Said only where it is not what the rest makes of it.
  const bool casts = !m.transmits() && m.coverage >= 0.5;
  if (m.castsShadow != casts) members.add("castsShadow", m.castsShadow);
  return members;
}

std::string ply(const Mesh& mesh) {
  std::ostringstream out = exactStream();
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

Members shapeOf(const Scene& scene, const Object& object) {
  Members members;
  if (object.radius > 0) {
    return members.add("shape", std::string("sphere"))
        .add("radius", object.radius)
        .add("material", numbered("material", object.material));
  }
  const Members material = membersOf(scene.materials[object.material]);
  return members.add("model", numbered("mesh", object.mesh) + ".ply")
      .add("materials", Members().add("*", material));
}

Members itemOf(const Scene& scene, const Body& body);

// The items of an object's list.
List contentOf(const Scene& scene, const Object& object) {
  List items;
  for (const Body& body : object.before) items.push_back(json(itemOf(scene, body)));
  items.push_back(json(shapeOf(scene, object)));
  for (const Body& body : object.after) items.push_back(json(itemOf(scene, body)));
  return items;
}

Members itemOf(const Scene& scene, const Body& body) {
  Members members;
  if (body.inPlace) {
    members.add("group", contentOf(scene, scene.objects[body.object]));
  } else {
    members.add("use", numbered("object", body.object));
  }
  members.add("transform", membersOf(body.transform));
  addMotion(body.motion, members);
  return members;
}

Members membersOf(const Scene& scene) {
  List lights, bodies;
  for (const Light& light : scene.lights) lights.push_back(json(membersOf(light)));
  for (const Body& body : scene.bodies) bodies.push_back(json(itemOf(scene, body)));

  Members textures, materials, objects;
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    const std::string name = numbered("map", i);
    textures.add(name, Members().add("image", name + ".tga"));
  }
  // Shapes name their materials; models have them.
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    objects.add(numbered("object", i), contentOf(scene, object));
    if (!(object.radius > 0)) continue;
    materials.add(numbered("material", object.material),
                  membersOf(scene.materials[object.material]));
  }

  return Members()
      .add("whit", 1)
      .add("size", List{json(scene.width), json(scene.height)})
      .add("cameras", Members().add("main", membersOf(scene.camera)))
      .add("lights", lights)
      .add("sky", membersOf(scene.sky))
      .add("ambient", membersOf(scene.ambient))
      .add("textures", textures)
      .add("materials", materials)
      .add("objects", objects)
      .add("scene", bodies);
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
  save(folder + "/scene.json", json(membersOf(scene)));
  return folder + "/scene.json";
}

}  // namespace oracle
