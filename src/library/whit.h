// whit as a library: real-time Whitted ray tracing on CPUs.
//
//   whit::api::Renderer renderer(whit::api::loadScene("atrium"));
//   renderer.set("size", "1280x720").set("depth", "4");
//   renderer.render().write("atrium.png");
//
// In CMake: find_package(whit) and target_link_libraries(... whit::whit). Every function throws
// whit::api::Error and nothing else.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

// Where the scenes that came with the library are; find_package(whit) knows.
#ifndef WHIT_SHIPPED_SCENES
#define WHIT_SHIPPED_SCENES ""
#endif

namespace whit::api {

// `status` is the exit status of the whit program: 1 other, 2 wrong usage, 3 a bad scene or image,
// 4 cannot read or write, 5 a limit or memory ran out. what() names file and line or JSON pointer.
class Error : public std::runtime_error {
 public:
  Error(int status, const std::string& what) : std::runtime_error(what), status_(status) {}
  int status() const { return status_; }

 private:
  int status_;
};

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
};

// What moves a scene from 0 to `seconds`; before and after it stands still.
struct Animation {
  std::string name;
  double seconds = 0;
};

// A scene that is ready to be rendered. A handle: copies share the scene, which never changes.
class Scene {
 public:
  const std::string& name() const;
  int width() const, height() const;  // the scene's own image size, in pixels
  std::vector<std::string> cameras() const;
  double pathSeconds() const;                 // when its camera path ends; 0 without a path
  std::vector<Animation> animations() const;  // those to choose from
  std::uint64_t triangles() const;            // as seen, instances multiplied out
  std::vector<std::string> warnings() const;  // what was repaired while loading

 private:
  friend class Renderer;
  friend Scene loadScene(const std::string&, const LoadOptions&, const char*);
  struct Data;
  explicit Scene(std::shared_ptr<const Data> data);
  std::shared_ptr<const Data> data_;
};

// `name`: a scene file (.json), a model, or the name of a shipped scene ("atrium",
// "landscape?triangles=20000000"), which is looked for in $WHIT_SCENES, beside the program and in
// `shippedScenes`.
Scene loadScene(const std::string& name, const LoadOptions& options = {},
                const char* shippedScenes = WHIT_SHIPPED_SCENES);

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
  // .exr (linear) or .png (sRGB), with the options that make the image again. Replaces the file
  // when complete.
  void write(const std::string& path) const;

 private:
  friend class Renderer;
  struct Data;
  std::unique_ptr<Data> data_;
};

// What a frame cost. Milliseconds of wall-clock time; the stages add up to the frame but for what
// no worker spends in a stage, and are empty for the scalar reference.
struct FrameStatistics {
  struct Stage {
    std::string_view name;  // "generateRays" to "updateImage"
    double ms = 0;
  };
  struct Rays {
    // "primary", "shadow", "reflection", "refraction", "indirect", "occlusion"
    std::string_view name;
    std::uint64_t count = 0;
  };
  double frameMs = 0;
  double embreeMs = 0;  // the part of it spent inside Embree
  std::vector<Stage> stages;
  std::vector<Rays> rays;
  std::uint64_t nonFinitePixels = 0;
};

// Renders frames of a scene. Use one from one thread at a time; it brings its own workers. Several
// may share a scene. The kernel target ("simd") belongs to the process: the renderer that was made
// last has chosen it for all.
class Renderer {
 public:
  explicit Renderer(Scene scene);
  Renderer(Renderer&& other) noexcept;
  Renderer& operator=(Renderer&& other) noexcept;
  ~Renderer();

  // An option by its name and value on the command line of whit render, without the dashes:
  // set("depth", "8"). For frames to come; the acceleration structure is built anew only if the
  // option is about it.
  Renderer& set(const std::string& name, const std::string& value);
  // Its value as text; empty where the scene decides.
  std::string get(const std::string& name) const;

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
  void render(Image& image);
  // From the scene's camera path, `seconds` after its begin.
  void renderOnPath(double seconds, Image& image);

  // Of the last frame.
  const FrameStatistics& statistics() const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

std::string version();  // "0.1.0"

}  // namespace whit::api
