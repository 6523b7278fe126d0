// Files that contain something other than what their names promise, or text in another encoding.
#include "scene_files.h"

namespace whit {
namespace {

using ReadFile = SceneFileTest;

constexpr char kPointer[] =
    "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a214614ab2935c943f9e0ff69d22e\n"
    "size 12345\n";
const std::string kSaid =
    ": expected the file itself, found a Git LFS pointer to it (git lfs pull fetches it)";

TEST_F(ReadFile, PointersOfGitLfsAreNoModelsAndImages) {
  for (const std::string name : {"m.obj", "m.ply", "m.gltf", "m.glb", "s.json"}) {
    expectErrorsOf(name, {{kPointer, "3 " + name + kSaid}});
  }

  save("p.bin", kPointer);
  expectErrorsOf("m.gltf", {{"{'asset':{'version':'2.0'},"
                             "'buffers':[{'byteLength':1,'uri':'p.bin'}]}",
                             "3 p.bin" + kSaid}});

  for (const std::string name : {"p.png", "p.tga"}) {
    save(name, kPointer);
    expectErrorsOfMembers(
        {{"'textures': {'t': {'image': '" + name + "'}}, 'materials': {'m': {'diffuseMap': 't'}}",
          "3 " + name + kSaid}});
  }
}

std::string inUtf16(const std::string& text, bool little, bool marked) {
  std::string wide;
  if (marked) wide = little ? "\xff\xfe" : "\xfe\xff";
  for (const char c : text) {
    if (!little) wide += '\0';
    wide += c;
    if (little) wide += '\0';
  }

  return wide;
}

TEST_F(ReadFile, Utf16IsRefused) {
  for (const bool little : {false, true}) {
    for (const bool marked : {false, true}) {
      for (const std::string name : {"m.obj", "m.ply", "m.gltf", "s.json"}) {
        expectErrorsOf(
            name, {{inUtf16("v 1 2 3\n", little, marked),
                    "3 " + name + ": expected text in UTF-8, found UTF-16: save it as UTF-8"}});
      }
    }
  }
}

// Some editors write a byte order mark before the first line.
TEST_F(ReadFile, TheMarkOfUtf8IsNoPartOfTheText) {
  expectRead("m.obj", {{"\xef\xbb\xbf" + kTriangleObj, "1"}});
  expectErrorsOf("m.ply", {{"\xef\xbb\xbfobj\n", "3 m.ply:1: expected a line \"ply\""}});
}

}  // namespace
}  // namespace whit
