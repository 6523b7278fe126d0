#include "oracle/write_scene.h"

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

std::string number(double value) {
  std::ostringstream out = exactStream();
  out << value;
  return out.str();
}

std::string list(const Vec& v) {
  return "[" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + "]";
}

// The elements of a JSON list or object, one a line.
template <typename Element, typename Describe>
std::string joined(const std::vector<Element>& elements, const Describe& describe) {
  std::string text;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    text += (i == 0 ? "\n    " : ",\n    ") + describe(elements[i], std::to_string(i));
  }
  return text;
}

std::string motionText(const Motion& motion) {
  if (motion.keys.empty()) return "";
  std::string text;
  for (const auto& [time, scale, degrees, translate] : motion.keys) {
    text += (text.empty() ? R"({"time": )" : R"(, {"time": )") + number(time) + R"(, "scale": )" +
            list(scale) + R"(, "rotate": [)" + number(motion.axis.x) + ", " +
            number(motion.axis.y) + ", " + number(motion.axis.z) + ", " + number(degrees) +
            R"(], "translate": )" + list(translate) + "}";
  }

  const std::string how = motion.inSteps ? R"(, "interpolation": "step"})" : "}";
  return R"(, "motion": {"keys": [)" + text + "]" + how;
}

std::string cameraText(const Camera& c) {
  std::string text = R"({"main": {"eye": )" + list(c.eye) + R"(, "at": )" + list(c.at) +
                     R"(, "up": )" + list(c.up);
  if (c.orthographicHeight > 0) {
    text += R"(, "orthographicHeight": )" + number(c.orthographicHeight);
  } else {
    text += R"(, "fov": )" + number(c.fov);
  }
  if (c.aperture > 0) {
    text += R"(, "aperture": )" + number(c.aperture) + R"(, "focus": )" + number(c.focus);
  }
  return text + motionText(c.motion) + "}}";
}

std::string lightText(const Light& light) {
  if (light.kind == Light::Kind::directional) {
    return R"({"type": "directional", "direction": )" + list(light.direction) +
           R"(, "irradiance": )" + list(light.intensity) + motionText(light.motion) + "}";
  }

  std::string text = R"({"position": )" + list(light.position) + R"(, "intensity": )" +
                     list(light.intensity) + R"(, "radius": )" + number(light.radius);
  if (light.kind == Light::Kind::spot) {
    text += R"(, "type": "spot", "direction": )" + list(light.direction) +
            R"(, "innerConeAngle": )" + number(light.innerConeAngle) + R"(, "outerConeAngle": )" +
            number(light.outerConeAngle);
  }
  return text + motionText(light.motion) + "}";
}

std::string skyText(const Sky& sky) {
  const std::string scale = R"(, "scale": )" + number(sky.scale) + "}";
  if (sky.kind == Sky::Kind::image) {
    return R"({"image": "sky.hdr", "rotation": )" + number(sky.rotation) + scale;
  }
  return R"({"zenith": )" + list(sky.zenith) + R"(, "horizon": )" + list(sky.horizon) +
         R"(, "ground": )" + list(sky.ground) + scale;
}

std::string ambientText(const Ambient& ambient) {
  const std::string end =
      ambient.occlusion > 0 ? R"(, "occlusion": )" + number(ambient.occlusion) + "}" : "}";
  if (ambient.fromSky > 0) return R"({"fromSky": )" + number(ambient.fromSky) + end;
  return R"({"up": )" + list(ambient.up) + R"(, "down": )" + list(ambient.down) + end;
}

std::string materialText(const Material& m) {
  std::string text = R"({"diffuse": )" + list(m.diffuse) + R"(, "specular": )" + list(m.specular) +
                     R"(, "roughness": )" + number(m.roughness) + R"(, "emission": )" +
                     list(m.emission) + R"(, "mirror": )" + list(m.mirror) +
                     R"(, "mirrorGrazing": )" + list(m.mirrorGrazing);

  const auto map = [&](const char* key, int number) {
    if (number != kNone) text += R"(, ")" + (key + (R"(": "map)" + std::to_string(number))) + '"';
  };

  map("diffuseMap", m.diffuseMap);
  map("specularMap", m.specularMap);
  map("emissionMap", m.emissionMap);
  map("normalMap", m.normalMap);
  map("alphaMap", m.alphaMap);
  if (m.alphaMap != kNone) text += R"(, "alphaCutoff": )" + number(m.alphaCutoff);
  if (m.coverage < 1) text += R"(, "coverage": )" + number(m.coverage);
  map("coverageMap", m.coverageMap);

  if (m.transmits()) {
    text += R"(, "transmission": )" + list(m.transmission) + R"(, "ior": )" + number(m.ior) +
            R"(, "absorption": )" + list(m.absorption) + R"(, "priority": )" +
            std::to_string(m.priority);
  }

  if (!m.diffuseReflection) text += R"(, "diffuseReflection": false)";
  if (m.thin) text += R"(, "thin": true)";
  if (m.frosted) text += R"(, "frosted": true)";
  if (m.glossyReflection != Choice::unsaid) {
    const bool reflects = m.glossyReflection == Choice::yes;
    text += std::string(R"(, "glossyReflection": )") + (reflects ? "true" : "false");
  }

  // Said only where it is not what the rest makes of it.
  const bool casts = !m.transmits() && m.coverage >= 0.5;
  if (m.castsShadow != casts) {
    text += std::string(R"(, "castsShadow": )") + (m.castsShadow ? "true" : "false");
  }

  return text + "}";
}

std::string transformText(const Transform& t) {
  return R"({"scale": )" + list(t.scale) + R"(, "rotate": [)" + number(t.axis.x) + ", " +
         number(t.axis.y) + ", " + number(t.axis.z) + ", " + number(t.degrees) +
         R"(], "translate": )" + list(t.translate) + "}";
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
    for (const double channel : {c.x, c.y, c.z}) {
      file += static_cast<char>(static_cast<unsigned char>(channel * 256));
    }
    file += static_cast<char>(128);
  }
  return file;
}

// Uncompressed, rows from the top, blue first.
std::string tga(const Texture& texture) {
  std::string file(18, '\0');
  file[2] = 2;
  file[12] = static_cast<char>(texture.width);
  file[14] = static_cast<char>(texture.height);
  file[16] = 24;
  file[17] = 0x20;
  for (const auto& [r, g, b] : texture.texels) {
    for (const int channel : {b, g, r}) file += static_cast<char>(channel);
  }
  return file;
}

std::string shapeText(const Scene& scene, const Object& object) {
  if (object.radius > 0) {
    return R"({"shape": "sphere", "radius": )" + number(object.radius) +
           R"(, "material": "material)" + std::to_string(object.material) + R"("})";
  }
  return R"({"model": "mesh)" + std::to_string(object.mesh) + R"(.ply", "materials": {"*": )" +
         materialText(scene.materials[static_cast<std::size_t>(object.material)]) + "}}";
}

// Shapes name their materials.
std::string materialsOfShapes(const Scene& scene) {
  std::vector<std::string> members;
  for (const Object& object : scene.objects) {
    if (!(object.radius > 0)) continue;
    members.push_back(R"("material)" + std::to_string(object.material) + R"(": )" +
                      materialText(scene.materials[static_cast<std::size_t>(object.material)]));
  }
  return joined(members, [](const std::string& member, const std::string&) { return member; });
}

std::string itemText(const Scene& scene, const Body& body);

// The items of an object's list.
std::string contentText(const Scene& scene, const Object& object) {
  std::string text;
  for (const Body& body : object.before) text += itemText(scene, body) + ", ";
  text += shapeText(scene, object);
  for (const Body& body : object.after) text += ", " + itemText(scene, body);
  return text;
}

std::string itemText(const Scene& scene, const Body& body) {
  const Object& object = scene.objects[static_cast<std::size_t>(body.object)];
  const std::string what = body.inPlace ? R"({"group": [)" + contentText(scene, object) + "]"
                                        : R"({"use": "object)" + std::to_string(body.object) + '"';
  return what + R"(, "transform": )" + transformText(body.transform) + motionText(body.motion) +
         "}";
}

std::string sceneText(const Scene& scene) {
  std::ostringstream out;
  out << "{\n  \"whit\": 1,\n  \"size\": [" << scene.width << ", " << scene.height << "],\n"
      << "  \"cameras\": " << cameraText(scene.camera) << ",\n  \"lights\": ["
      << joined(scene.lights,
                [](const Light& light, const std::string&) { return lightText(light); })
      << "],\n  \"sky\": " << skyText(scene.sky)
      << ",\n  \"ambient\": " << ambientText(scene.ambient) << ",\n  \"textures\": {"
      << joined(scene.textures,
                [](const Texture&, const std::string& i) {
                  return "\"map" + i + "\": {\"image\": \"map" + i + ".tga\"}";
                })
      << "},\n  \"materials\": {" << materialsOfShapes(scene) << "},\n  \"objects\": {"
      << joined(scene.objects,
                [&](const Object& object, const std::string& i) {
                  return "\"object" + i + "\": [" + contentText(scene, object) + "]";
                })
      << "},\n  \"scene\": ["
      << joined(scene.bodies,
                [&](const Body& body, const std::string&) { return itemText(scene, body); })
      << "]\n}\n";
  return out.str();
}

}  // namespace

std::string writeScene(const Scene& scene, const std::string& folder) {
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    save(folder + "/mesh" + std::to_string(i) + ".ply", ply(scene.meshes[i]));
  }
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    save(folder + "/map" + std::to_string(i) + ".tga", tga(scene.textures[i]));
  }
  if (scene.sky.kind == Sky::Kind::image) save(folder + "/sky.hdr", hdr(scene.sky));
  save(folder + "/scene.json", sceneText(scene));
  return folder + "/scene.json";
}

}  // namespace oracle
