// An engine makes pictures of one scene. It holds the scene, options, edits, time, transforms and
// camera of the next picture. It keeps its renderer as long as the renderer suits them, and builds
// another one when it does not. An engine belongs to one thread.
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

// Returns options.threads, or the number of usable threads if that is 0.
int threadsOf(const RenderOptions& options);

struct PictureRequest {
  std::optional<Camera> camera = {};  // none: the engine's
  Budget budget = {};  // if set, options that the caller did not choose are chosen for it
  Progress* progress = nullptr;
};

struct Picture {
  FrameStats stats;
  ImageMetadata about;             // everything that is needed to make the picture again
  std::optional<Receipt> receipt;  // set if the request has a budget
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
  RenderOptions requestedOptions() const;
  // Returns the options of the renderer, in which an automatic exposure is replaced by its value.
  const RenderOptions& options() const { return options_; }

  // Sets a member of the scene: `setting` is "POINTER=VALUE", as for --set. The scene is read again
  // only if the member cannot be changed in place (editScene). Throws as the reader does; the scene
  // is then unchanged.
  void edit(const std::string& setting, Progress* progress = nullptr);
  // Replaces all settings (--set) by those of `load`. The scene becomes the one that would be read
  // with `load`. If load.sky changes, a setting of the sky has to change as well; otherwise the new
  // sky may be ignored.
  void setSettings(const LoadOptions& load, Progress* progress = nullptr);
  // Replaces the arrays of a mesh that a program made, and reads the scene again. Throws
  // Error(usage) for an unknown name, and as the reader does; the scene is then unchanged.
  void setMesh(const std::string& name, GivenMesh mesh, Progress* progress = nullptr);
  // Sets the time of everything that moves. Takes effect with the next picture, or update().
  void setTime(double seconds);
  double seconds() const { return seconds_; }
  // Sets the transform of the item at a JSON pointer (Instant::movable). Takes effect with the next
  // picture, or update().
  void setTransform(const std::string& pointer, const Affine& transform);

  // Replaces the scene's camera. Without a camera, the scene's own counts again.
  void lookThrough(const std::optional<Camera>& camera);
  // Returns the camera of the next picture, changed by the options. Call it after prepare().
  Camera camera() const;

  // Keeps what a picture would show now. The channel "motion" of the next picture counts from it;
  // otherwise it counts from the last picture that had the channel.
  void remember(const std::optional<Camera>& camera = {});

  // Moves the scene to the time and the transforms that were set.
  void update();
  // Brings scene and renderer up to date, and returns the renderer. An automatic exposure is chosen
  // again after changes of options, settings or camera, but not if only time or transforms changed.
  Renderer& prepare(Progress* progress = nullptr);
  // Returns the renderer of the last prepare(), which must have been called.
  Renderer& renderer() { return *renderer_; }
  // Returns the object that answers ray queries about the scene at its present time.
  const RayQueries& rayQueries(Progress* progress = nullptr);

  // Returns the metadata of a picture that the renderer of the last prepare() makes.
  ImageMetadata describe(const Camera& camera, const Film& film) const;
  // Prepares, and renders all samples of a picture into `film`, whose size is that of the picture.
  // Throws Error(badScene) if the options are strict and a pixel is not finite.
  Picture render(const PictureRequest& request, Film& film);

  // Returns the memory of the scene and of the renderer with its tables, queues and acceleration
  // structure. The memory of rayQueries() is not included.
  std::uint64_t memoryBytes() const;

 private:
  void readAgain(const SceneSource& source, const LoadOptions& load, Progress* progress);
  JsonDocument readSceneDocument() const;
  // Makes the renderer follow an edit of the scene. If that fails, the scene is read again with the
  // settings `loaded` that it had before, and the error is thrown.
  void updateRenderer(bool camerasChanged, const LoadOptions& loaded, Progress* progress);
  void forgetRenderer();

  std::shared_ptr<OpenScene> opened_;
  // The document that the scene is read from, with its settings. Empty until the first edit, and
  // after the scene was read again or an edit failed.
  std::optional<JsonDocument> document_;

  RenderOptions requested_;
  // Names of the options in requested_ that the caller chose. Without this set, requested_ is
  // complete.
  std::optional<std::set<std::string>> given_ = std::set<std::string>();
  RenderOptions options_;
  bool optionsChanged_ = true;

  double seconds_ = 0;
  std::map<std::string, Affine> transforms_;  // indexed by JSON pointer of the item
  bool moved_ = false;                        // time or transforms have changed
  std::optional<Camera> lookedThrough_;
  std::optional<EarlierView> earlier_;

  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<RayQueries> queries_;
};

}  // namespace whit
