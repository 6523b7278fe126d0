// whit as a library: real-time Whitted ray tracing on CPUs.
//
//   whit::api::Renderer renderer(whit::api::loadScene("atrium"));
//   renderer.set("size", "1280x720").set("depth", "4");
//   renderer.render().write("atrium.png");
//
// A scene can be made in memory as well (SceneBuilder), and change between frames: setTime() and
// setTransform() move things, setMember() sets what a scene file says, a light's intensity say.
//
// In CMake: find_package(whit) and target_link_libraries(... whit::whit). Every function throws
// whit::api::Error and nothing else, besides what a callback of the caller's throws.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Where the scenes that came with the library are; find_package(whit) knows.
#ifndef WHIT_SHIPPED_SCENES
#define WHIT_SHIPPED_SCENES ""
#endif

namespace whit::api {

// `status` is the exit status of the whit program: 1 other, 2 wrong usage, 3 a bad scene or image,
// 4 cannot read or write, 5 a limit or memory ran out, 130 a callback ended the work. what() names
// file and line or JSON pointer.
class Error : public std::runtime_error {
 public:
  // Where the error is; members that are not known are empty.
  struct Place {
    std::string file;      // the file, or the name of a scene made in memory
    std::string place;     // line ("12", "12:5") or JSON pointer ("/lights/0") in it
    std::string expected;  // what should be there
  };
  Error(int status, const std::string& what, Place place = {})
      : std::runtime_error(what), status_(status), place_(std::move(place)) {}
  int status() const { return status_; }
  const std::string& file() const { return place_.file; }
  const std::string& place() const { return place_.place; }
  const std::string& expected() const { return place_.expected; }

 private:
  int status_;
  Place place_;
};

// Told how far long work has come: `phase` is what is going on ("building the BVH", "tracing"),
// `fraction` goes from 0 to 1 in each. False ends the work with an Error of status 130; scene and
// renderer are then what they were before it. May be called from any thread, by one at a time. What
// it throws ends the work as well and reaches the caller.
using Progress = std::function<bool(const std::string& phase, double fraction)>;

struct LoadOptions {
  bool allowOutside = false;  // a scene may name files outside its own folder and $WHIT_DATA
  bool strict = false;        // what would be repaired is an error
  double maxMemoryGb = 16;    // 10^9 bytes that geometry and images may take
  int threads = 0;            // 0: what affinity and cgroup quota allow
  // In place of the scene's own sky: none, studio or the file of an image. Empty: the scene's own;
  // of a model the studio.
  std::string sky = {};
  // Triangles in place of the scene's exact spheres, so many around each, 4 or more; 0: none.
  int sphereSegments = 0;
  // Renderers will bring it to other times than its start (Renderer::setTime). What moves is then
  // traced as instances, which takes a little longer.
  bool moves = false;
  // JSON pointers to what will be moved by hand (Renderer::setTransform): items, cameras and lights
  // of scene files ("/scene/3", "/cameras/front", "/lights/0"), nodes of glTF models ("/nodes/7").
  std::vector<std::string> movable = {};
  // Which animation moves it, by its name; empty: the first of each model. What a scene file moves
  // by itself ("scene") does so always.
  std::string animation = {};
  // Members of the scene's description, as --set of the program: "/lights/0/intensity=40".
  std::vector<std::string> settings = {};
  Progress progress = {};
};

// An animation from 0 to `seconds`; before and after, everything stands still.
struct Animation {
  std::string name;
  double seconds = 0;
};

// A scene that is ready to be rendered. A handle: copies share the scene, which never changes but
// by a renderer that has the only one.
class Scene {
 public:
  const std::string& name() const;
  int width() const, height() const;  // the scene's own image size, in pixels
  std::vector<std::string> cameras() const;
  double pathSeconds() const;                 // when its camera path ends; 0 without a path
  std::vector<Animation> animations() const;  // those to choose from
  std::uint64_t triangles() const;            // as seen, instances multiplied out
  std::vector<std::string> warnings() const;  // what was repaired while loading
  // Names by the numbers in the channels "object" (of the first 65,536) and "material".
  std::vector<std::string> objects() const, materials() const;

 private:
  friend class Renderer;
  friend class SceneBuilder;
  friend Scene loadScene(const std::string&, const LoadOptions&, const char*);
  struct Data;
  explicit Scene(std::shared_ptr<Data> data);
  std::shared_ptr<Data> data_;
};

// `name`: a scene file (.json), a model, or the name of a shipped scene ("atrium",
// "landscape?triangles=20000000"), which is looked for in $WHIT_SCENES, beside the program and in
// `shippedScenes`.
Scene loadScene(const std::string& name, const LoadOptions& options = {},
                const char* shippedScenes = WHIT_SHIPPED_SCENES);

// Arrays of a mesh, read in place when a scene is built or read again (Renderer::setMember). Their
// memory must be there for as long as builder, scene and its renderers are: `keep`, if given, is
// held by those.
struct MeshArrays {
  std::span<const float> positions;  // x, y, z of each vertex, y up in most scenes
  // Three vertices a triangle, counter-clockwise seen from outside. Empty: the vertices in threes.
  std::span<const std::uint32_t> triangles = {};
  std::span<const float> normals = {};  // empty (flat shading), or x, y, z of each vertex
  std::span<const float> uvs = {};      // empty (0, 0), or u, v of each vertex; v points up
  std::span<const float> colors = {};   // empty (white), or linear r, g, b of each, 0 to 1
  std::shared_ptr<const void> keep = {};
};

// Arrays of an image: 1 to 4 interleaved channels, row by row from the top; one channel is gray,
// the second or fourth alpha. Either codes of 8 bits (of colors in sRGB) or linear values.
struct ImageArrays {
  int width = 0, height = 0, channels = 3;
  std::span<const std::uint8_t> codes = {};
  std::span<const float> values = {};
  std::shared_ptr<const void> keep = {};
};

using Vector = std::array<double, 3>;  // x, y, z, or linear r, g, b (Rec. 709 primaries)
// Three rows and four columns, row by row; the last column is the translation.
using Matrix = std::array<double, 12>;
inline constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

struct Camera {
  Vector eye{0, 0, 5}, at{0, 0, 0}, up{0, 1, 0};
  double fov = 45;                // vertical, degrees
  double orthographicHeight = 0;  // above 0: parallel rays, and what they show of the eye's plane
  double aperture = 0;            // radius of the lens; 0: everything is sharp
  double focus = 0;               // distance of the plane in focus; 0: it contains `at`
};

struct Light {
  enum class Type { point, spot, directional } type = Type::point;
  Vector position{0, 0, 0};                        // of no meaning for a directional light
  Vector direction{0, -1, 0};                      // where spot and directional lights shine
  Vector intensity{1, 1, 1};                       // W/sr; of a directional light irradiance, W/m^2
  double radius = 0.01;                            // of the sphere that shines, for soft shadows
  double innerConeAngle = 0, outerConeAngle = 45;  // of spot lights, degrees from the direction
};

// Members that are not given have the defaults of scene files (share/doc/whit/scenes/README.md).
// Maps are names of textures.
struct Material {
  Vector diffuse{0.8, 0.8, 0.8}, specular{0, 0, 0}, emission{0, 0, 0};
  double roughness = 0.5, coverage = 1, ior = 1.5;
  std::optional<Vector> mirror, mirrorGrazing, transmission, absorption;
  std::optional<bool> thin, glossyReflection, castsShadow;
  std::string diffuseMap, specularMap, roughnessMap, emissionMap, normalMap, alphaMap, coverageMap;
};

// A scene made in memory: validated as files are, with the same errors, and with all that scene
// files can say. What is added says where it is, a JSON pointer, for setMember(), setTransform()
// and LoadOptions::movable. build() reports errors.
class SceneBuilder {
 public:
  // `description`: what a scene file says, in JSON, to begin with. `name` stands for its file.
  explicit SceneBuilder(const std::string& name = "scene", const std::string& description = "{}");
  SceneBuilder(const SceneBuilder& other);
  SceneBuilder(SceneBuilder&& other) noexcept;
  SceneBuilder& operator=(SceneBuilder other) noexcept;
  ~SceneBuilder();

  // Meshes and textures are found by their names.
  SceneBuilder& addMesh(const std::string& name, MeshArrays arrays);
  SceneBuilder& addTexture(const std::string& name, ImageArrays arrays);
  std::string addMaterial(const std::string& name, const Material& material);
  std::string addLight(const Light& light);
  std::string addCamera(const std::string& name, const Camera& camera);  // the first is seen from
  // A mesh at a place; several of one mesh share its triangles. Empty: the material "default".
  std::string addInstance(const std::string& mesh, const std::string& material = "",
                          const Matrix& transform = kIdentity);
  // Any member that scene files have, in JSON: set("/sky", R"({"color": [0.4, 0.5, 0.7]})"). There
  // are items {"mesh": NAME} besides, and textures {"array": NAME}, as addTexture() makes one where
  // there is none of that name. Paths are relative to the working directory.
  SceneBuilder& set(const std::string& pointer, const std::string& json);

  Scene build(const LoadOptions& options = {}) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

// A rendered picture, or a crop of one.
class Image {
 public:
  Image();
  Image(const Image& other);
  Image(Image&& other);  // NOLINT(performance-noexcept-move-constructor): leaves an image
  Image& operator=(Image other) noexcept;
  ~Image();

  // Pixels that are here, and where the first of them lies in the whole image, from the top left.
  int width() const, height() const, left() const, top() const;
  // Linear radiance, Rec. 709 primaries: r, g, b of each pixel, row by row from the top.
  std::span<const float> rgb() const;
  // 8-bit sRGB after exposure and tone curve: r, g, b, 255 of each pixel, in the same order.
  std::span<const std::uint8_t> srgb() const;
  // A channel that set("channels", "depth,object") has asked for: a property of the surface that
  // the sample nearest to a pixel's center hits first. scenes/README.md lists each channel, its
  // unit and its value where nothing is hit. Data is a view of the image's own memory: one value
  // after the other of each pixel, in the same order.
  struct Channel {
    std::string_view name;                     // "depth"
    std::vector<std::string_view> components;  // "Z", "distance"; so many values a pixel
    std::span<const float> values;             // empty of numbers
    std::span<const std::uint32_t> numbers;    // of object, material, triangle, rays
  };
  std::vector<Channel> channels() const;
  // Status 2 if it was not kept.
  Channel channel(std::string_view name) const;
  // .exr (linear, with the channels) or .png (sRGB), with the options that make the image again.
  // Replaces the file when complete.
  void write(const std::string& path) const;
  std::string png() const;  // the bytes of such a file

 private:
  friend class Renderer;
  struct Data;
  std::unique_ptr<Data> data_;
};

// Statistics of a frame. Times are milliseconds of wall-clock time. The stages add up to the frame
// without the time that no worker spends in a stage; they are empty for the scalar reference.
struct FrameStatistics {
  struct Stage {
    std::string_view name;  // "generateRays" to "updateImage"
    double ms = 0;
  };
  struct Rays {
    std::string_view name;  // "primary", "shadow", "reflection", ...: each kind that there is
    std::uint64_t count = 0;
  };
  double frameMs = 0;
  double embreeMs = 0;  // the part of it spent inside Embree
  std::vector<Stage> stages;
  std::vector<Rays> rays;
  std::uint64_t nonFinitePixels = 0;
};

// An option of a render, as the command line has it.
struct OptionInfo {
  std::string_view name;   // "light-samples"
  std::string_view words;  // what it takes: "N", "on|off", "x,y,z"; empty: a flag
  std::string_view help;
  std::string preset;  // its value where nothing is said; empty where the scene decides
};
std::vector<OptionInfo> options();

// Renders frames of a scene. Use one from one thread at a time; it brings its own workers. Several
// may share a scene. The kernel target ("simd") belongs to the process: the renderer that was made
// last has chosen it for all.
class Renderer {
 public:
  explicit Renderer(Scene scene);
  Renderer(Renderer&& other) noexcept;
  Renderer& operator=(Renderer&& other) noexcept;
  ~Renderer();

  // The scene as it is now. A copy of the handle keeps it as it is: what the renderer changes from
  // then on is a scene of its own, of which the acceleration structure is built anew.
  const Scene& scene() const;

  // An option by its name and value on the command line of whit render, without the dashes:
  // set("depth", "8"). For frames to come; the acceleration structure is built anew only if the
  // option is about it.
  Renderer& set(const std::string& name, const std::string& value);
  // Its value as text; empty where the scene decides.
  std::string get(const std::string& name) const;
  // All options are again what they were before any was set.
  Renderer& reset();

  // A member of the scene of this renderer alone, for frames to come, as --set of the program has
  // it: setMember("/lights/0/intensity", "40"). The picture is that of a scene which was loaded so.
  // Nothing is built anew for lights, cameras, colors of the sky, ambient light, the image size,
  // and numbers of the materials of a scene file or a SceneBuilder, but for what moves; for
  // everything else the scene is read again, with the arrays of its builder. After an error the
  // scene is what it was.
  Renderer& setMember(const std::string& pointer, const std::string& json);

  // For acceleration structures, frames and scenes read again; none: {}.
  Renderer& setProgress(Progress progress);

  // Brings the scene of this renderer alone to a time in seconds, for frames to come: what moves,
  // its cameras and lights. The bits of a frame follow from the time, not from the times before.
  // Status 2 for a scene that was not loaded to move, or in which nothing does.
  Renderer& setTime(double seconds);

  // Moves a thing of the scene of this renderer alone, for frames to come, whatever the time:
  // `rows` is a matrix of three rows and four columns, row by row, whose last column is the
  // translation. It stands in place of the item's, camera's or light's "motion", or of what the
  // node says of itself. What it flattens is left out. Status 2 for what was not among
  // LoadOptions::movable, and for numbers that are not finite or beyond 1.844e18.
  Renderer& setTransform(const std::string& pointer, std::span<const double, 12> rows);

  // A frame from the camera that the options name. The second form reuses the image's memory.
  Image render();
  // Views of the image stay valid while its size does: rgb() is where the frame is traced to.
  void render(Image& image);
  // From the scene's camera path, `seconds` after its begin.
  void renderOnPath(double seconds, Image& image);

  // Statistics of the last frame.
  const FrameStatistics& statistics() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

std::string version();  // "0.1.0"

}  // namespace whit::api
