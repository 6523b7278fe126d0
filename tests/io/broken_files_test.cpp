// Broken files of every format: the error has the status of its kind and names the file and the
// place in it, whatever the file contains. Each is short, which errorOf() sees to. Whole messages
// are tested beside each reader.
#include "scene_files.h"

namespace whit {
namespace {

using namespace std::string_literals;
using BrokenFiles = SceneFileTest;

const std::string kLong(5000, 'x');

TEST_F(BrokenFiles, Scenes) {
  const auto texture = [](const std::string& path) {
    return "'textures': {'t': {'image': '" + path + "'}}";
  };

  expectErrorsOfMembers({
      {"'" + kLong + "': 1", "3 s.json#/xxx*"},
      {"'sky': " + std::string(100, '['), "3 s.json#/sky/0*"},
      {"'sky': {'image': 'none.hdr'}", "4 s.json#/sky/image*"},
      {texture("none.png"), "4 s.json#/textures/t/image: cannot open none.png*"},
      {texture("../../none.png"), "3 s.json#/textures/t/image*"},
      {texture("http://" + kLong), "3 s.json#/textures/t/image*"},
      {texture(kLong), "4 s.json#/textures/t/image*"},
      {texture("$WHIT_DATA" + kLong), "3 s.json#/textures/t/image*"},
      {"'scene': [{'shape': '" + kLong + "'}]", "3 s.json#/scene/0/shape*"},
  });
}

TEST_F(BrokenFiles, Gltf) {
  const auto gltf = [](const std::string& members) {
    return "{'asset': {'version': '2.0'}, " + members + "}";
  };
  const auto buffer = [&](const std::string& uri) {
    return gltf("'buffers': [{'byteLength': 12, 'uri': '" + uri + "'}]");
  };

  expectErrorsOf("m.gltf", {
                               {"{'asset':", "3 m.gltf:1:10*"},
                               {gltf("'extensionsRequired': ['" + kLong + "']"),
                                "3 m.gltf#/extensionsRequired/0*"},
                               {buffer("none.bin"), "4 m.gltf#/buffers/0/uri*"},
                               {buffer(kLong), "4 m.gltf#/buffers/0/uri*"},
                               {buffer("data:,0"), "3 m.gltf#/buffers/0/byteLength*"},
                               {buffer("data:" + kLong), "3 m.gltf#/buffers/0/uri*"},
                               {gltf("'images': [{}]"), "3 m.gltf#/images/0*"},
                           });

  const std::string start = "glTF\2\0\0\0"s;
  expectErrorsOf("m.glb", {
                              {start + "\77\0\0\0"s, "3 m.glb: byte 8*"},
                              {start + "\14\0\0\0"s, "3 m.glb: byte 12*"},
                              {start + "\24\0\0\0\77\0\0\0JSON"s, "3 m.glb: byte 12*"},
                          });
}

TEST_F(BrokenFiles, OtherModels) {
  expectErrorsOf("m.obj", {{"vt " + kLong, "3 m.obj:1*"}});

  const std::string ply = "ply\nformat ascii 1.0\n";
  expectErrorsOf("m.ply",
                 {
                     {kLong + "\n", "3 m.ply:1*"},
                     {"ply\nformat " + kLong + " 1.0\n", "3 m.ply:2*"},
                     {ply + "element vertex 1\nproperty " + kLong + " x\n", "3 m.ply:4*"},
                     {ply + "element " + kLong + " 99\nproperty int i\nend_header\n", "3 m.ply:3*"},
                     {ply + "element vertex 1\nproperty float x\nend_header\n1\n", "3 m.ply:3*"},
                     {ply +
                          "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                          "end_header\n0 0 " +
                          kLong,
                      "3 m.ply:8*"},
                     {"ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
                      "property float y\nproperty float z\nelement face 1\n"
                      "property list uchar int vertex_index\nend_header\n0123456789ab\3",
                      "3 m.ply: byte *"},
                 });
}

// Images, each of which a texture of the scene names. BrokenImage.EveryPrefix* has the short ones.
TEST_F(BrokenFiles, Images) {
  const std::string png = "\x89PNG\r\n\x1a\n"s;
  const std::tuple<std::string, std::string, std::string> images[] = {
      {"t.png", png + "\0\0\0\15IHDR"s, ": byte 16*"},
      {"t.jpg", "\xff\xd8\xff\xe0" + std::string(40, 'x'), ": byte *"},
      {"t.tga", std::string(18, '\7'), ": byte *"},
      {"t.hdr", "#?RADIANCE\nFORMAT=" + std::string(900, 'x') + "\n\n", ": byte *"},
      {"t.hdr", "#?RADIANCE\n\n+X 1\n", ": byte 17*"},
      {"t.exr", "\x76\x2f\x31\x01" + kLong, ": header*"},
      {"t.gif", "GIF89a", ": expected a PNG, JPEG*"},
      {"t.png", "", ": expected a PNG, JPEG*"},
  };
  for (const auto& [name, text, error] : images) {
    save(name, text);
    expectErrorsOfMembers({{"'textures': {'t': {'image': '" + name + "'}}", "3 " + name + error}});
  }
}

}  // namespace
}  // namespace whit
