// Reads scenes on a thread of its own, so that the one that is shown stays alive meanwhile.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line/parse_options.h"
#include "engine/engine.h"
#include "viewer/session/latest_progress.h"

namespace whit::view {

struct SceneChoice {
  std::string name;
  std::vector<std::string> settings = {};
  std::string animation = {};           // empty: the first one
  std::optional<std::string> sky = {};  // sky of a scene that is read again with its edits
  // All options of the renderer; without them it has those of the command line and of the scene.
  std::optional<RenderOptions> options = {};
  bool isFirst = true;  // the camera and the time of the command line belong to it
};

// Reads the scene and builds its renderer. Throws as the reader and the renderer.
std::unique_ptr<Engine> readScene(const SceneChoice& choice, cli::CommonOptions common,
                                  Progress* progress = nullptr);

// It belongs to one thread, which never waits before the end.
class SceneReader {
 public:
  // `common` must outlive the reader.
  explicit SceneReader(const cli::CommonOptions& common) : common_(common) {}
  ~SceneReader() { giveUp(); }

  // Begins to read in place of what was being read.
  void read(const SceneChoice& choice);
  void giveUp();
  // Hands over the scene once it is read, or throws what has kept it from being read. Frees a
  // scene that was given up.
  std::unique_ptr<Engine> take();

  bool busy() const { return holds() && !progress_->givenUp; }
  // A scene is being read or was read, and take() has neither handed it over nor freed it.
  bool holds() const { return reading_.valid(); }
  // "reading NAME" and its progress; empty: nothing is being read.
  std::string text() const { return busy() ? text_ + " " + progress_->text() : ""; }

 private:
  const cli::CommonOptions& common_;
  std::string text_;
  std::shared_ptr<LatestProgress> progress_;
  // Its end is waited for, also where it was given up.
  std::future<std::unique_ptr<Engine>> reading_;
};

}  // namespace whit::view
