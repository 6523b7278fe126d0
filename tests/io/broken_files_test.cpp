// Broken files of every format: the error has the status of its kind, names the file and the place
// in it, and is short whatever the file contains. Messages are tested beside each reader.
#include "bake/scene.h"
#include "has_text.h"
#include "scene_files.h"

namespace whit {
namespace {

using namespace std::string_literals;

struct Broken {
  std::string file, text;  // beside the scene that names it, or the scene or model itself
  ExitStatus status;
  std::string place;  // behind the file's name
};

constexpr ExitStatus kBad = ExitStatus::badScene, kIo = ExitStatus::io;
const std::string kLong(5000, 'x');

std::vector<Broken> scenes() {
  const auto scene = [](const std::string& members) { return "{\"whit\": 1, " + members + "}"; };
  const auto texture = [&](const std::string& path) {
    return scene("\"textures\": {\"t\": {\"image\": \"" + path + "\"}}");
  };

  return {
      {"s.json", scene("\"" + kLong + "\": 1"), kBad, "#/xxx"},
      {"s.json", scene("\"sky\": " + std::string(100, '[')), kBad, "#/sky/0"},
      {"s.json", scene("\"sky\": {\"image\": \"none.hdr\"}"), kIo, "#/sky/image"},
      {"s.json", texture("none.png"), kIo, "#/textures/t/image"},
      {"s.json", texture("../../none.png"), kBad, "#/textures/t/image"},
      {"s.json", texture("http://" + kLong), kBad, "#/textures/t/image"},
      {"s.json", texture(kLong), kIo, "#/textures/t/image"},
      {"s.json", texture("$WHIT_DATA" + kLong), kBad, "#/textures/t/image"},
      {"s.json", scene("\"scene\": [{\"model\": \"none.ply\"}]"), kIo, "#/scene/0/model"},
      {"s.json", scene("\"scene\": [{\"model\": \"none.txt\"}]"), kBad, "#/scene/0/model"},
      {"s.json", scene("\"scene\": [{\"shape\": \"" + kLong + "\"}]"), kBad, "#/scene/0/shape"},
  };
}

std::vector<Broken> gltfFiles() {
  const auto gltf = [](const std::string& members) {
    return "{\"asset\": {\"version\": \"2.0\"}, " + members + "}";
  };

  const auto buffer = [&](const std::string& uri) {
    return gltf("\"buffers\": [{\"byteLength\": 12, \"uri\": \"" + uri + "\"}]");
  };

  const auto accessor = [&](const std::string& members) {
    return gltf(
        "\"buffers\": [{\"byteLength\": 12, \"uri\": \"data:,012345678901\"}], "
        "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 12}], \"accessors\": "
        "[{\"bufferView\": 0, \"type\": \"VEC3\", " +
        members +
        "}], \"meshes\": "
        "[{\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}], "
        "\"nodes\": [{\"mesh\": 0}]");
  };

  const auto glb = [](const std::string& rest) { return "glTF\2\0\0\0"s + rest; };

  return {
      {"m.gltf", "{\"asset\":", kBad, ":1:10"},
      {"m.gltf", gltf("\"extensionsRequired\": [\"" + kLong + "\"]"), kBad,
       "#/extensionsRequired/0"},
      {"m.gltf", buffer("none.bin"), kIo, "#/buffers/0/uri"},
      {"m.gltf", buffer(kLong), kIo, "#/buffers/0/uri"},
      {"m.gltf", buffer("data:,0"), kBad, "#/buffers/0/byteLength"},
      {"m.gltf", buffer("data:;base64,!"), kBad, "#/buffers/0/uri"},
      {"m.gltf", buffer("data:" + kLong), kBad, "#/buffers/0/uri"},
      {"m.gltf", accessor("\"componentType\": 5126, \"count\": 2"), kBad, "#/accessors/0"},
      {"m.gltf", accessor("\"componentType\": 1, \"count\": 1"), kBad,
       "#/accessors/0/componentType"},
      {"m.gltf", gltf("\"images\": [{}]"), kBad, "#/images/0"},
      {"m.glb", "glTF", kBad, ": byte 0"},
      {"m.glb", "glTF\1\0\0\0\14\0\0\0"s, kBad, ": byte 4"},
      {"m.glb", glb("\77\0\0\0"s), kBad, ": byte 8"},
      {"m.glb", glb("\14\0\0\0"s), kBad, ": byte 12"},
      {"m.glb", glb("\24\0\0\0\77\0\0\0JSON"s), kBad, ": byte 12"},
      {"m.glb", glb("\24\0\0\0\0\0\0\0TEXT"s), kBad, ": byte 16"},
  };
}

std::vector<Broken> otherModels() {
  const std::string ply = "ply\nformat ascii 1.0\n";
  const std::string vertex =
      "element vertex 1\nproperty float x\nproperty float y\n"
      "property float z\n";

  return {
      {"m.obj", "vt " + kLong, kBad, ":1"},
      {"m.ply", kLong + "\n", kBad, ":1"},
      {"m.ply", "ply\nformat " + kLong + " 1.0\n", kBad, ":2"},
      {"m.ply", ply + "element vertex 1\nproperty " + kLong + " x\n", kBad, ":4"},
      {"m.ply", ply + "element " + kLong + " 99\nproperty int i\nend_header\n", kBad, ":3"},
      {"m.ply", ply + "element vertex 1\nproperty float x\nend_header\n1\n", kBad, ":3"},
      {"m.ply", ply + vertex + "end_header\n0 0 " + kLong, kBad, ":8"},
      {"m.ply",
       ply + "element face 1\nproperty list int int vertex_index\n" + vertex +
           "end_header\n3 0 0 0\n0 0 0\n",
       kBad, ":3"},
      {"m.ply",
       "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
       "property float y\nproperty float z\nelement face 1\n"
       "property list uchar int vertex_index\nend_header\n0123456789ab\3",
       kBad, ": byte "},
  };
}

// Lists images, each of which a texture of the scene names.
std::vector<Broken> images() {
  const std::string png = "\x89PNG\r\n\x1a\n"s;
  return {
      {"t.png", png, kBad, ": byte 8"},
      {"t.png", png + "\0\0\0\15IHDR"s, kBad, ": byte 16"},
      {"t.jpg", "\xff\xd8\xff", kBad, ": byte "},
      {"t.jpg", "\xff\xd8\xff\xe0" + std::string(40, 'x'), kBad, ": byte "},
      {"t.bmp", "BM", kBad, ": byte 0"},
      {"t.tga", std::string(18, '\7'), kBad, ": byte "},
      {"t.hdr", "#?RADIANCE\nFORMAT=" + std::string(900, 'x') + "\n\n", kBad, ": byte "},
      {"t.hdr", "#?RADIANCE\n\n+X 1\n", kBad, ": byte 17"},
      {"t.exr", "\x76\x2f\x31\x01" + kLong, kBad, ": header"},
      {"t.exr", "\x76\x2f\x31\x01", kBad, ": header"},
      {"t.gif", "GIF89a", kBad, ": expected a PNG, JPEG"},
      {"t.png", "", kBad, ": expected a PNG, JPEG"},
  };
}

class BrokenFiles : public SceneFileTest {
 protected:
  // Loads `name`, which is broken or names the file that is.
  void expectRefusal(const std::string& name, const Broken& broken) {
    SCOPED_TRACE(broken.file + broken.place + " of " + broken.text.substr(0, 300));
    try {
      Scene::finalize(load(name), warnings_);
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      const std::string what = error.what();
      EXPECT_EQ(error.status(), broken.status) << what;
      EXPECT_TRUE(hasText(what, broken.file + broken.place));
      EXPECT_LT(what.size(), 400u) << what;
      EXPECT_NE(error.place().file, "") << what;
    }
  }
};

TEST_F(BrokenFiles, ScenesAndModels) {
  for (const auto& all : {scenes(), gltfFiles(), otherModels()}) {
    for (const Broken& broken : all) expectRefusal(save(broken.file, broken.text), broken);
  }
}

TEST_F(BrokenFiles, Images) {
  for (const Broken& broken : images()) {
    save(broken.file, broken.text);
    expectRefusal(save("s.json", "{\"whit\": 1, \"textures\": {\"t\": {\"image\": \"" +
                                     broken.file + "\"}}}"),
                  broken);
  }
}

}  // namespace
}  // namespace whit
