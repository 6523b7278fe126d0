// Files that contain something other than what their names promise, or text in another encoding.
#include "gltf_files.h"
#include "scene/description.h"

namespace whit {
namespace {

class ReadFile : public GltfTest {
 protected:
  std::string errorOfFile(const std::string& name, const std::string& text) {
    return SceneFileTest::errorOfFile(save(name, text));
  }
};

constexpr char kPointer[] =
    "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a214614ab2935c943f9e0ff69d22e\n"
    "size 12345\n";
const std::string kSaid =
    ": expected the file itself, found a Git LFS pointer to it (git lfs pull fetches it)";

TEST_F(ReadFile, PointersOfGitLfsAreNoModels) {
  for (const char* name : {"m.obj", "m.ply", "m.gltf", "m.glb", "s.json"}) {
    EXPECT_EQ(errorOfFile(name, kPointer), "3 " + std::string(name) + kSaid);
  }

  save("p.bin", kPointer);
  EXPECT_EQ(errorOfText("{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":1,"
                        "\"uri\":\"p.bin\"}]}"),
            "3 p.bin" + kSaid);
}

TEST_F(ReadFile, PointersOfGitLfsAreNoImages) {
  for (const char* name : {"p.png", "p.tga"}) {
    save(name, kPointer);
    EXPECT_EQ(errorOfMembers("\"textures\": {\"t\": {\"image\": \"" + std::string(name) +
                             "\"}}, \"materials\": {\"m\": {\"diffuseMap\": \"t\"}}"),
              "3 " + std::string(name) + kSaid);
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
      for (const char* name : {"m.obj", "m.ply", "m.gltf", "s.json"}) {
        EXPECT_EQ(
            errorOfFile(name, inUtf16("v 1 2 3\n", little, marked)),
            "3 " + std::string(name) + ": expected text in UTF-8, found UTF-16: save it as UTF-8");
      }
    }
  }
}

// Some editors write a byte order mark before the first line.
TEST_F(ReadFile, TheMarkOfUtf8IsNoPartOfTheText) {
  EXPECT_EQ(triangleCount(load(save("m.obj", "\xef\xbb\xbf" + std::string(kTriangleObj)))), 1u);
  EXPECT_TRUE(warnings_.entries().empty());
  EXPECT_EQ(errorOfFile("m.ply", "\xef\xbb\xbfobj\n"), "3 m.ply:1: expected a line \"ply\"");
}

}  // namespace
}  // namespace whit
