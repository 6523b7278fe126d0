// whit as a library: real-time Whitted ray tracing on CPUs.
//
//   whit::api::Renderer renderer(whit::api::loadScene("atrium"));
//   renderer.set("size", "1280x720").set("depth", "4");
//   renderer.render().write("atrium.png");
//
// SceneBuilder makes scenes in memory. Scenes can change between frames: Renderer::setTime(),
// setTransform(), setMember() and updateMesh().
//
// In CMake: find_package(whit) and target_link_libraries(... whit::whit); elsewhere pkg-config's
// package whit. Every function throws whit::api::Error and nothing else, except the exceptions of
// the caller's own callbacks.
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

#define WHIT_VERSION "0.2.0"
#define WHIT_VERSION_MAJOR 0
#define WHIT_VERSION_MINOR 2
#define WHIT_VERSION_PATCH 0

// The folder of the shipped scenes: find_package(whit) defines it; else it is found from the place
// of this header, as in /usr/include/whit and /usr/share/whit.
#ifndef WHIT_SHIPPED_SCENES
#define WHIT_SHIPPED_SCENES __FILE__ "/../../../share/whit/scenes"
#endif

#pragma GCC visibility push(default)  // for a shared library

namespace whit::api {

// `status` is the exit status of the program whit: 1 other, 2 wrong usage, 3 a bad scene or image,
// 4 cannot read or write, 5 a limit or memory ran out, 130 a callback ended the work.
class Error : public std::runtime_error {
 public:
  struct Place {           // unknown members are empty
    std::string file;      // the file, or the name of a scene made in memory
    std::string place;     // line ("12", "12:5") or JSON pointer ("/lights/0") in it
    std::string expected;  // the content that was expected there
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

// A handle's pointer to its data. A handle that was moved from throws an Error of status 2.
template <typename Pointer>
class DataPointer : public Pointer {
 public:
  DataPointer(Pointer pointer) : Pointer(std::move(pointer)) {}
  auto* operator->() const {
    if (!*this) throw Error(2, "a Scene, SceneBuilder or Renderer was used after a move from it");
    return this->get();
  }
  auto& operator*() const { return *operator->(); }
};

// Receives the progress of long work: the current phase ("building the BVH", "tracing") and the
// fraction of it that is done, 0 to 1. Returning false ends the work with an Error of status 130;
// an exception ends it as well and reaches the caller. Scene and renderer are then unchanged. Any
// thread may call it, but only one at a time.
using Progress = std::function<bool(const std::string& phase, double fraction)>;

struct LoadOptions {
  bool allowOutside = false;  // a scene may name files outside its own folder and $WHIT_DATA
  bool strict = false;        // repairs are errors
  // Limit for geometry and images, in 10^9 bytes; 0: what the machine and its control group have
  // left, at most 16.
  double maxMemoryGb = 0;
  int threads = 0;  // 0: as many as CPU affinity and cgroup quota allow
  // Replaces the scene's sky: none, studio or an image file. Empty: the scene's own, or the studio
  // for a model.
  std::string sky = {};
  int sphereSegments = 0;  // triangles around each sphere, 4 or more; 0: exact spheres
  bool moves = false;      // loads animations, for Renderer::setTime()
  // JSON pointers to the things that Renderer::setTransform() will move: items, cameras and lights
  // of scene files ("/scene/3", "/cameras/front", "/lights/0"), nodes of glTF models ("/nodes/7").
  std::vector<std::string> movable = {};
  std::string animation = {};  // name of the animation that each model plays; empty: its first
  // As with --set of the program: "/lights/0/intensity=40", and of glTF files "/variant=\"red\"".
  std::vector<std::string> settings = {};
  Progress progress = {};
};

// Everything rests before 0 and after `seconds`.
struct Animation {
  std::string name;
  double seconds = 0;
};

// A handle of a scene that is ready to be rendered. Copies share the scene.
class Scene {
 public:
  const std::string& name() const;
  int width() const, height() const;  // the scene's own image size, in pixels
  std::vector<std::string> cameras() const;
  // The camera of this name as JSON, as in a scene file; empty: the first one.
  std::string camera(const std::string& name = {}) const;
  double pathSeconds() const;  // end of the camera path; 0 without a path
  std::vector<Animation> animations() const;
  std::uint64_t triangles() const;  // counted once for each instance
  // Repairs that were made while loading, and whether the scene has nothing that gives light.
  std::vector<std::string> warnings() const;
  // The channels "object" (names of the first 65,536) and "material" hold indices into these.
  std::vector<std::string> objects() const, materials() const;
  // LoadOptions::settings and those of Renderer::setMember(): a scene that is read with them equals
  // this one.
  const std::vector<std::string>& settings() const;

 private:
  friend class Renderer;
  friend class SceneBuilder;
  friend Scene loadScene(const std::string&, const LoadOptions&, const char*);
  struct Data;
  explicit Scene(std::shared_ptr<Data> data);
  DataPointer<std::shared_ptr<Data>> data_;
};

// Loads a scene file (.json), a model, or a shipped scene ("landscape?triangles=20000000",
// "chess.glb") from $WHIT_SCENES, from beside the program or from `shippedScenes`.
Scene loadScene(const std::string& name, const LoadOptions& options = {},
                const char* shippedScenes = WHIT_SHIPPED_SCENES);

// Arrays of a mesh. They are read in place when a scene is built or read again, so their memory
// must live as long as builder, scene and renderers, which hold `keep`.
struct MeshArrays {
  std::span<const float> positions;  // x, y, z of each vertex, y up in most scenes
  // Three vertices a triangle, counter-clockwise seen from outside. Empty: vertices come in threes.
  std::span<const std::uint32_t> triangles = {};
  std::span<const float> normals = {};  // empty (flat shading), or x, y, z of each vertex
  std::span<const float> uvs = {};      // empty (0, 0), or u, v of each vertex; v points up
  std::span<const float> colors = {};   // empty (white), or linear r, g, b of each, 0 to 1
  std::shared_ptr<const void> keep = {};
};

// An image of 1 to 4 interleaved channels, row by row from the top; one channel is gray, the second
// or fourth is alpha. It has either 8-bit codes (sRGB for colors) or linear values.
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
  double orthographicHeight = 0;  // above 0: parallel rays, and the height of the view
  double aspect = 0;              // narrower pictures keep the width of the view
  double aperture = 0;            // radius of the lens; 0: a pinhole
  double focus = 0;               // distance of the plane of focus; 0: it contains `at`
  // As in scene files (share/doc/whit/scenes/README.md).
  std::string projection = "perspective", stereo = "none";
  std::vector<double> k = {}, kSize = {}, distortion = {}, azimuths = {}, elevations = {};
  double angle = 180, eyeDistance = 0.065;
};

struct Light {
  enum class Type { point, spot, directional } type = Type::point;
  Vector position{0, 0, 0};                        // unused by directional lights
  Vector direction{0, -1, 0};                      // unused by point lights
  Vector intensity{1, 1, 1};                       // W/sr; W/m^2 for directional lights
  double radius = 0.01;                            // for soft shadows
  double innerConeAngle = 0, outerConeAngle = 45;  // for spot lights, degrees from the direction
};

// Members without a value have the defaults of scene files (share/doc/whit/scenes/README.md). Maps
// are names of textures.
struct Material {
  Vector diffuse{0.8, 0.8, 0.8}, specular{0, 0, 0}, emission{0, 0, 0};
  double roughness = 0.5, coverage = 1, ior = 1.5;
  std::optional<Vector> mirror, mirrorGrazing, transmission, absorption;
  std::optional<bool> thin, frosted, glossyReflection, castsShadow;
  std::string diffuseMap, specularMap, roughnessMap, emissionMap, normalMap, alphaMap, coverageMap,
      occlusionMap, mirrorMap, transmissionMap;
};

// Makes a scene in memory. build() validates it like a scene file and reports the same errors. The
// functions that return a string return the JSON pointer to the new thing, for setMember(),
// setTransform() and LoadOptions::movable.
class SceneBuilder {
 public:
  // Starts from the JSON of a scene file. Errors give `name` as the file.
  explicit SceneBuilder(const std::string& name = "scene", const std::string& description = "{}");
  SceneBuilder(const SceneBuilder& other);
  SceneBuilder(SceneBuilder&& other) noexcept;
  SceneBuilder& operator=(SceneBuilder other) noexcept;
  ~SceneBuilder();

  SceneBuilder& addMesh(const std::string& name, MeshArrays arrays);
  SceneBuilder& addTexture(const std::string& name, ImageArrays arrays);
  std::string addMaterial(const std::string& name, const Material& material);
  std::string addLight(const Light& light);
  std::string addCamera(const std::string& name, const Camera& camera);  // the first is the default
  // Instances of one mesh share its triangles. An empty name stands for the material "default".
  std::string addInstance(const std::string& mesh, const std::string& material = "",
                          const Matrix& transform = kIdentity);
  // Sets any member of scene files: set("/sky", R"({"color": [0.4, 0.5, 0.7]})"). Items may also be
  // {"mesh": NAME}, and textures {"array": NAME}; addTexture() adds such a texture unless there is
  // one of that name. Paths are relative to the working directory.
  SceneBuilder& set(const std::string& pointer, const std::string& json);

  Scene build(const LoadOptions& options = {}) const;

 private:
  struct Data;
  DataPointer<std::unique_ptr<Data>> data_;
};

// A rendered picture, or a crop of one.
class Image {
 public:
  Image();
  Image(const Image& other);
  Image(Image&& other);  // NOLINT(performance-noexcept-move-constructor): allocates
  Image& operator=(Image other) noexcept;
  ~Image();

  // Size of the crop, and place of its first pixel in the whole image, from the top left.
  int width() const, height() const, left() const, top() const;
  // Linear radiance, Rec. 709 primaries: r, g, b of each pixel, row by row from the top. The span
  // is valid until the image has another size; frames are traced into its memory.
  std::span<const float> rgb() const;
  // 8-bit sRGB after exposure and tone curve: r, g, b, alpha of each pixel, in the same order.
  // Alpha is 255 unless set("background", "transparent") was called.
  std::span<const std::uint8_t> srgb() const;
  // A channel that set("channels", "depth,object") asked for. scenes/README.md lists the channels,
  // their units and their values where nothing is hit. The spans are views of the image's memory,
  // the components of a pixel one after the other.
  struct Channel {
    std::string_view name;                     // "depth"
    std::vector<std::string_view> components;  // "Z", "distance"
    std::span<const float> values;             // empty if the channel has numbers
    std::span<const std::uint32_t> numbers;    // for object, material, triangle and rays
  };
  std::vector<Channel> channels() const;
  Channel channel(std::string_view name) const;  // status 2 if the image does not have it
  // Writes .exr (linear, with the channels), .png or .jpg (sRGB), with the options as metadata
  // except in .jpg; "x.depth.png" and "x.depth.exr" hold that channel alone. The file is replaced
  // when it is complete. Throws status 2 where the image lacks the channel.
  void write(const std::string& path) const;
  std::string png() const;  // the bytes of a PNG file
  // Returns all of the image as bytes, which the same version of the library reads. fromBytes()
  // throws status 3 for other bytes.
  std::string bytes() const;
  static Image fromBytes(std::string_view bytes);

 private:
  friend class Renderer;
  struct Data;
  std::unique_ptr<Data> data_;
};

// Numbers of a program, in single or in double precision. They are read in place.
struct Numbers {
  std::span<const float> floats = {};
  std::span<const double> doubles = {};  // read where there are no floats

  std::size_t size() const { return floats.empty() ? doubles.size() : floats.size(); }
  double operator[](std::size_t i) const { return floats.empty() ? doubles[i] : double{floats[i]}; }
};

// Rays that ask what they hit. Origins and directions are x, y, z of each ray, in the world; a
// direction has a length from 1e-100 to 1e100, in which distances count. Rays of other directions
// hit nothing and are not certain.
struct Rays {
  Numbers origins, directions;
  // Hits count from `near` to `far`, both included: a number for each ray or one for all; empty: 0
  // and infinity.
  Numbers near = {}, far = {};
};

// What rays hit, in columns. A ray that hits nothing has an infinite t, 0xffffffff as its triangle,
// object and material, and zeros. The spans are valid as long as `memory` is held.
struct RayHits {
  std::span<double> t, tError;  // tError bounds the error of t
  std::span<double> points;     // x, y, z of each
  // x, y, z of each, of unit length, on the front (where corners are counter-clockwise).
  std::span<float> geometricNormals, shadingNormals;
  std::span<float> weights;  // weights of corners 1 and 2 of the triangle; meaningless on a sphere
  std::span<float> uvs;      // texture coordinates
  // Numbers as those of the channels. An instance is 0xffffffff for what is used once.
  std::span<std::uint32_t> triangles, objects, materials, instances;
  std::span<std::int8_t> sides;  // 1: the front is hit, -1: the back, 0: nothing
  // 0: something else lies within rounding errors of the ray, so that another surface or none may
  // be hit; 1: all is as stated. Borders of surfaces that are seen at less than a sixteenth of
  // their area are not watched: one that is met within the rounding of single precision may be
  // passed.
  std::span<std::uint8_t> certain;
  // For allHits(): the hits of ray i are [offsets[i], offsets[i + 1]).
  std::vector<std::uint64_t> offsets;
  std::shared_ptr<void> memory;
};

// One element a ray: 1 for yes.
struct RayAnswers {
  std::vector<std::uint8_t> yes;
  std::vector<std::uint8_t> certain;  // as in RayHits
};

// Statistics of a frame. Times are milliseconds of wall-clock time. The stages add up to the frame
// except for the time that no worker spends in a stage; the scalar reference has none.
struct FrameStatistics {
  struct Stage {
    std::string_view name;  // "generateRays" to "updateImage"
    double ms = 0;
  };
  struct Rays {
    std::string_view name;  // "primary", "shadow", "reflection", ...
    std::uint64_t count = 0;
  };
  double frameMs = 0;
  double embreeMs = 0;  // the part of frameMs inside Embree
  std::vector<Stage> stages;
  std::vector<Rays> rays;
  std::uint64_t nonFinitePixels = 0;
  std::uint64_t limitedPixels = 0;  // number of pixels whose rays "max-rays" has bounded
};

// An option of `whit render`.
struct OptionInfo {
  std::string_view name;   // "light-samples"
  std::string_view words;  // possible values: "N", "on|off", "x,y,z"; empty: a flag
  std::string_view help;
  std::string preset;  // its default; empty where the scene decides
};
std::vector<OptionInfo> options();

// Tells what Renderer::renderWithin() has chosen.
struct Receipt {
  std::vector<std::pair<std::string, std::string>> chosen;  // options and their values
  double chooseMs = 0, expectedMs = 0, pictureMs = 0;       // expected is the time of the picture
  // Mean FLIP, or codes if the target is in codes. Nothing bounds an error that is not known:
  // errorHigh is infinite then.
  double error = 0, errorLow = 0, errorHigh = 0;
  std::string note;  // why budget or target are not met or the error is not known; else empty
  std::string text;  // all of it for people
};

// Renders frames of a scene with its own worker threads. Only one thread may use a renderer at a
// time; several renderers may share a scene. A forked child may go on with the renderers that no
// thread was using, and their worker threads start anew there. The kernel target ("simd") belongs
// to the process: the renderer that was made last has chosen it for all.
class Renderer {
 public:
  explicit Renderer(Scene scene);
  Renderer(Renderer&& other) noexcept;
  Renderer& operator=(Renderer&& other) noexcept;
  ~Renderer();

  // The current scene, at the time and with the transforms that were set. A renderer never changes
  // a scene that others hold: it copies it first, and builds a new acceleration structure.
  const Scene& scene() const;

  // Sets an option of `whit render` for the following frames: set("depth", "8"). It wins over the
  // options that the scene states. The acceleration structure is rebuilt only if that is needed.
  Renderer& set(const std::string& name, const std::string& value);
  std::string get(const std::string& name) const;  // empty where the scene decides
  Renderer& reset();                               // all options to those of the scene

  // Sets a member of the scene's description for the following frames, like --set of the program:
  // setMember("/lights/0/intensity", "40"). The picture equals that of a scene which was loaded
  // with this value. Lights, the sky, ambient light, the image size, numbers of materials,
  // and cameras that stand still need no rebuild, of models only lights and materials; for other
  // members the scene is read again. After an error the scene is unchanged.
  Renderer& setMember(const std::string& pointer, const std::string& json);

  // Replaces the arrays of a mesh of SceneBuilder::addMesh(), as a simulation moves its vertices;
  // also their number and the triangles may change. The picture equals that of a scene which was
  // built with these arrays, and takes as long: the scene is read again, textures included, and the
  // acceleration structure is built anew. setTransform() moves a rigid mesh in far less time.
  // Throws status 2 for a mesh that the scene does not have, 3 for arrays that are no mesh; after
  // an error the scene is unchanged.
  Renderer& updateMesh(const std::string& name, MeshArrays arrays);

  // Looks through this camera, in JSON as in a scene file, in place of the scene's; empty: through
  // those again. "eye" and the other options that replace a camera's members still do so.
  Renderer& lookThrough(const std::string& camera);

  // Sets the callback for builds, frames and scenes that are read again; {}: none.
  Renderer& setProgress(Progress progress);

  // Moves animated items, cameras and lights to a time in seconds. The bits of a frame depend on
  // this time only, not on earlier ones. Status 2 without LoadOptions::moves, or if nothing moves.
  Renderer& setTime(double seconds);

  // Replaces the "motion" of an item, camera or light, or the transform of a node, by a matrix of
  // three rows and four columns, row by row, whose last column is the translation. Degenerate
  // instances are left out. Status 2 for pointers that are not in LoadOptions::movable and for
  // numbers beyond 1.844e18.
  Renderer& setTransform(const std::string& pointer, std::span<const double, 12> rows);

  // Renders a frame from the camera that the options name. The second form reuses the image's
  // memory.
  Image render();
  void render(Image& image);
  // Chooses the options that set() has not set, for the least visible error within a time ("50ms",
  // "10s") or for the least time within an error ("0.5codes", "flip=0.01"); one is empty. The same
  // options set by set() give the same picture.
  Receipt renderWithin(const std::string& budget, const std::string& target, Image& image);
  // Renders from the scene's camera path, `seconds` after its begin.
  void renderOnPath(double seconds, Image& image);

  const FrameStatistics& statistics() const;  // statistics of the last frame

  // Queries of the scene as it is at its present time, without a picture. Surfaces count as the eye
  // sees them: alpha masks cut them, single-sided ones are passed from behind, and of coplanar ones
  // that overlap one is hit, as in pictures. An answer depends on its ray alone: not on the other
  // rays, threads or processor. The first query builds an acceleration structure of its own.
  RayHits closest(const Rays& rays);
  RayAnswers occluded(const Rays& rays);  // whether closest() finds anything
  // All hits of each ray, ordered by t, at most `limit`; coplanar ones that overlap count once.
  RayHits allHits(const Rays& rays, std::size_t limit = static_cast<std::size_t>(-1));
  // Whether nothing lies between points of surfaces, x, y, z of each. With normals, one for each
  // point or none, the way starts off the surface by the bound on a point's rounding, as rays of
  // pictures do; without, what is within four times that bound of an end does not count.
  RayAnswers visible(const Numbers& from, const Numbers& to, const Numbers& fromNormals = {},
                     const Numbers& toNormals = {});
  // The share of the directions about each point's normal, weighted by their cosine, in which
  // nothing is nearer than `radius`: 1 is open. Which directions are drawn follows from the point.
  std::vector<float> ambientOcclusion(const Numbers& points, const Numbers& normals, double radius,
                                      int samples);

 private:
  friend struct SceneCopy;
  struct Data;
  DataPointer<std::unique_ptr<Data>> data_;
};

std::string version();  // "0.2.0"

}  // namespace whit::api

#pragma GCC visibility pop
