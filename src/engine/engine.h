// The life of a picture. An engine knows the scene, options, edits, time, transforms and camera of
// the next picture; it keeps the renderer while it suits them and builds another one where it does
// not. An engine belongs to one thread.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "accel/ray_queries.h"
#include "core/affine.h"
#include "core/options.h"
#include "core/progress.h"
#include "engine/open_scene.h"
#include "inspect/budget.h"
#include "io/image/image_file.h"
#include "io/json_reader.h"
#include "render/renderer.h"

namespace whit {

// Returns the number of threads that the option `threads` stands for.
int threadsOf(const RenderOptions& options);

struct PictureRequest {
  std::optional<Camera> camera = {};  // none: the engine's
  Budget budget = {};                 // if it is set, options that were not given are chosen for it
  Progress* progress = nullptr;
};

struct Picture {
  FrameStats stats;
  ImageMetadata about;             // everything that is needed to make the picture again
  std::optional<Receipt> receipt;  // of a request with a budget
};

class Engine {
 public:
  explicit Engine(std::shared_ptr<OpenScene> scene);
  Engine(Engine&&) = default;

  const std::shared_ptr<OpenScene>& opened() const { return opened_; }
  const Scene& scene() const { return opened_->scene; }

  // Replaces the scene by a copy, because others share the present one.
  void ownScene();
  // Returns a copy of the scene at its present time, for others to use.
  std::shared_ptr<OpenScene> copyScene();

  // Sets the options of the next pictures. `given` names those that the caller chose; presets
  // (--quality) and the options that the scene states fill in the others.
  void setOptions(const RenderOptions& options, const std::set<std::string>& given);
  // Sets all options, without presets and without those that the scene states.
  void setOptions(const RenderOptions& options);
  // Returns the options that are requested for the next picture; the exposure may be automatic.
  RenderOptions wantedOptions() const;
  // Returns the options of the renderer, in which an automatic exposure is replaced by its value.
  const RenderOptions& options() const { return options_; }

  // Sets a member of the scene, as --set POINTER=VALUE. The scene is read again where that is
  // needed. Throws as the reader does, with nothing changed.
  void edit(const std::string& setting, Progress* progress = nullptr);
  // Replaces all settings by those of `load`, which is what the scene is read with then; another
  // sky in it needs another setting of the sky.
  void setSettings(const LoadOptions& load, Progress* progress = nullptr);
  // Replaces the arrays of a mesh that a program made, and reads the scene again. Throws as the
  // reader does, with nothing changed.
  void setMesh(const std::string& name, GivenMesh mesh, Progress* progress = nullptr);
  // Moves everything that follows the time. Takes effect with the next picture, or update().
  void setTime(double seconds);
  double seconds() const { return seconds_; }
  // Sets the transform of a named item (Instant::movable). Takes effect with the next picture, or
  // update().
  void setTransform(const std::string& pointer, const Affine& place);

  // Replaces the scene's camera; none restores it.
  void lookThrough(const std::optional<Camera>& camera);
  // The camera of the next picture, changed by the options. To be called after prepare().
  Camera camera() const;

  // Brings the scene to its time and the transforms.
  void update();
  // Brings scene, renderer and exposure up to date, and returns the renderer.
  Renderer& prepare(Progress* progress = nullptr);
  // The renderer of the last prepare().
  Renderer& renderer() { return *renderer_; }
  // Returns the object that answers ray queries about the scene at its present time.
  const RayQueries& rayQueries(Progress* progress = nullptr);

  // Returns the metadata of a picture by the prepared renderer.
  ImageMetadata describe(const Camera& camera, const Film& film) const;
  // Renders all samples of a picture. `film` has the size of the picture. Throws
  // Error(badScene) for pixels that are not finite where the options are strict.
  Picture render(const PictureRequest& request, Film& film);

  // Returns the memory of scene, tables, queues and acceleration structure.
  std::uint64_t memoryBytes() const;

 private:
  void readAgain(const SceneSource& source, const LoadOptions& load, Progress* progress);
  JsonDocument readSceneDocument() const;
  void forgetRenderer();

  std::shared_ptr<OpenScene> opened_;
  // The document that the scene is read from, with its settings; none before the first edit.
  std::optional<JsonDocument> document_;

  RenderOptions asked_;
  // Names of the options in asked_ that the caller chose; none: asked_ is complete.
  std::optional<std::set<std::string>> given_ = std::set<std::string>();
  RenderOptions options_;
  bool optionsChanged_ = true;

  double seconds_ = 0;
  std::map<std::string, Affine> places_;  // by pointer
  bool moved_ = false;                    // time or transforms have changed
  std::optional<Camera> lookedThrough_;

  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<RayQueries> queries_;
};

}  // namespace whit
