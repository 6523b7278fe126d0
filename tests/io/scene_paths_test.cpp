// Which files a scene may name, and where shipped scenes are found.
#include <optional>
#include <utility>

#include "scene_files.h"

namespace whit {
namespace {

class ScenePaths : public SceneFileTest {
 protected:
  const ErrorOf errorOfModel = [this](const std::string& path) {
    return errorOfMembers("'scene': [{'model': '" + path + "'}]");
  };

  // Restores the variables for the other tests of the program.
  ~ScenePaths() override {
    for (const auto& [name, value] : given_) {
      if (value) {
        setenv(name, value->c_str(), 1);
      } else {
        unsetenv(name);
      }
    }
  }

 private:
  using Variable = std::pair<const char*, std::optional<std::string>>;
  static Variable variable(const char* name) {
    const char* value = std::getenv(name);
    return {name, value ? std::optional<std::string>(value) : std::nullopt};
  }
  const Variable given_[2] = {variable("WHIT_DATA"), variable("WHIT_SCENES")};
};

TEST_F(ScenePaths, FilesBelowTheSceneOnly) {
  save("sub/in.obj", kTriangleObj);
  save("../out.obj", kTriangleObj);
  save("../inside2/out.obj", kTriangleObj);  // a folder whose name begins alike
  std::filesystem::create_symlink(folder_ + "/out.obj", root_ + "link.obj");

  const std::string leaves =
      " leaves the scene's folder and $WHIT_DATA (--allow-outside permits that)";
  expectErrors(errorOfModel,
               {
                   {"sub/in.obj", "no error"},
                   {"sub/../sub/in.obj", "no error"},
                   {"../out.obj", "3 s.json#/scene/0/model: \"../out.obj\"" + leaves},
                   {"/etc/passwd", "3 s.json#/scene/0/model: \"/etc/passwd\"" + leaves},
                   {"link.obj", "3 s.json#/scene/0/model: \"link.obj\"" + leaves},
                   {"../inside2/out.obj", "3 *"},
               });

  options_.allowOutside = true;
  expectErrors(errorOfModel, {{"../out.obj", "no error"}, {"link.obj", "no error"}});
}

TEST_F(ScenePaths, ScenesInTheCurrentFolder) {
  save("in.obj", kTriangleObj);
  save("s.json", "{'whit': 1, 'scene': [{'model': 'in.obj'}]}");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(root_);

  EXPECT_EQ(errorOfFile("s.json"), "no error");
  EXPECT_EQ(errorOfFile("in.obj"), "no error");
  std::filesystem::current_path(before);
}

TEST_F(ScenePaths, TheDataFolderIsAllowed) {
  save("../data/in.obj", kTriangleObj);
  setenv("WHIT_DATA", (folder_ + "/data").c_str(), 1);

  expectErrors(errorOfModel, {
                                 {"$WHIT_DATA/in.obj", "no error"},
                                 {"$WHIT_DATA/../out.obj", "3 *"},
                                 {"$WHIT_DATABASE/in.obj", "3 *"},
                             });

  // Without the variable the scene is as valid as before, but the file cannot be found.
  unsetenv("WHIT_DATA");
  EXPECT_EQ(errorOfModel("$WHIT_DATA/in.obj"),
            "4 s.json#/scene/0/model: cannot open \"$WHIT_DATA/in.obj\": WHIT_DATA is not set, set "
            "it to the folder that has this file");
}

TEST_F(ScenePaths, NoAddressesAndNoEmptyPaths) {
  expectErrors(
      errorOfModel,
      {
          {"http://host/in.obj",
           "3 s.json#/scene/0/model: expected the path of a file on this machine, found "
           "http://host/in.obj"},
          {"a\\u0000.obj",
           "3 s.json#/scene/0/model: expected the path of a file on this machine, found a NUL "
           "byte"},
          {"", "3 s.json#/scene/0/model: expected the path of a file, found an empty string"},
      });
}

TEST_F(ScenePaths, FilesThatCannotBeRead) {
  EXPECT_EQ(errorOfFile(root_ + "none.json"), "4 cannot open none.json: no such file");
  EXPECT_EQ(errorOfFile(root_ + "none.obj"), "4 cannot open none.obj: no such file");
  expectErrors(errorOfModel,
               {
                   {"sub.obj", "4 s.json#/scene/0/model: cannot open sub.obj: no such file"},
                   {"sub",
                    "3 s.json#/scene/0/model: expected a model (.3ds, .dae, .fbx, .glb, .gltf, "
                    ".obj, .off, .ply, .stl, .vrm), found \"sub\""},
               });

  std::filesystem::create_directory(root_ + "folder.json");
  EXPECT_EQ(errorOfFile(root_ + "folder.json"), "4 cannot read folder.json: not a file");
  expectErrorsOf("a.txt", {{"", "2 *"}});
}

TEST_F(ScenePaths, ShippedScenesByName) {
  save("hall.json", "{'whit': 1, 'parameters': {'w': 5}, 'size': ['$w', 1]}");
  setenv("WHIT_SCENES", root_.c_str(), 1);
  EXPECT_EQ(load("hall").name, "hall");
  EXPECT_EQ(load("hall?w=9").width, 9);

  // The variable counts more than what is shipped.
  options_.shippedScenes = sourceFile("scenes");
  save("whitted.json", "{'whit': 1, 'size': [3, 1]}");
  EXPECT_EQ(load("whitted").width, 3);
  options_.shippedScenes.clear();
  EXPECT_EQ(errorOfFile("hal"), "2 no scene is called 'hal'; did you mean 'hall'?");
}

}  // namespace
}  // namespace whit
