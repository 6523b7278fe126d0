// The textures of a scene that is being read. Each image is decoded once for each use, while other
// threads read the rest.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/progress.h"
#include "core/warnings.h"
#include "core/worker_pool.h"
#include "io/image/image_file.h"
#include "io/memory_budget.h"
#include "io/scene/scene_parts.h"
#include "scene/description.h"

namespace whit {

// Starts tasks at once on up to threads - 1 workers; the caller of finish() is the last worker. A
// task that throws Error(limit) is run once more, alone, after all others have ended and given
// their memory back. Tasks must allow to be run again.
class DecodeQueue {
 public:
  // With 0 threads, it uses as many as this process may use.
  DecodeQueue(int threads, Progress* progress, std::string phase);
  ~DecodeQueue();  // drops tasks that have not begun and waits for the others
  DecodeQueue(const DecodeQueue&) = delete;
  DecodeQueue& operator=(const DecodeQueue&) = delete;

  // Call before finish(). Throws as WorkerPool does.
  void add(std::function<void()> task);

  // Returns when every task has ended. Of several failed tasks, the one added first has its
  // exception rethrown, in whatever order they failed.
  void finish();

 private:
  struct Task {
    std::function<void()> work;  // empty after it has ended
    std::exception_ptr failure;
  };

  void work();
  void close();
  void run(Task& task, std::unique_lock<std::mutex>& lock);

  Progress* progress_;
  std::string phase_;
  int threads_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Task> tasks_;  // a deque: references stay valid while more are added
  std::size_t begun_ = 0, ended_ = 0;
  bool closing_ = false;  // no more tasks will be added
  const std::function<void(int)> job_ = [this](int) { work(); };
  std::optional<WorkerPool> pool_;  // created with the first task
  bool running_ = false;            // between begin() and finish() of the pool
};

struct TextureSource {
  std::string path;   // empty for an image that the calling program gives
  std::string where;  // the place that names it
  const GivenImage* given = nullptr;
  Wrap wrapU = Wrap::repeat, wrapV = Wrap::repeat;
  bool nearest = false;
  float bumpScale = 1;
  bool lenient = false;  // an image that cannot be read is a warning instead of an error
};

// Materials refer to slots until finish() numbers the textures.
class TextureLoader {
 public:
  TextureLoader(int threads, MemoryBudget& budget, Warnings& warnings, Progress* progress);

  // Returns a slot for each of `uses`; the image is decoded once for all of them. The same source
  // and use have the same slot again; emission is color if the file's format cannot exceed 1.
  std::vector<std::int32_t> add(const TextureSource& source, const std::vector<TextureUse>& uses);

  // Adds `count` textures that `make` computes on a worker; some of them may be empty.
  std::vector<std::int32_t> add(std::size_t count,
                                std::function<std::vector<std::optional<Texture>>()> make);

  // Decodes the equirectangular map at `path`, which `where` names, to `image`; it is ready after
  // finish().
  void addEnvironment(const std::string& path, const std::string& where, EnvironmentImage& image);

  // finish() calls `change` when all textures are decoded, before it numbers them.
  void whenDone(std::function<void(SceneDescription&)> change);

  // Returns the limits of images, with the budget that textures are charged to.
  ImageLimits limits() const;

  // Waits for all images, moves them to scene.textures and replaces the slots in the materials by
  // their indices. Throws what the decoding of an image threw.
  void finish(SceneDescription& scene);

 private:
  using Key = std::tuple<std::string, TextureUse, Wrap, Wrap, bool, float>;

  std::optional<Texture> make(const std::string& name, const RawImage& raw,
                              const TextureSource& source, TextureUse use);

  MemoryBudget& budget_;
  Warnings& warnings_;
  std::deque<std::optional<Texture>> slots_;  // a deque: tasks keep references
  std::map<Key, std::int32_t> known_;
  std::vector<std::function<void(SceneDescription&)>> changes_;
  DecodeQueue queue_;  // last, because its workers write to the other members
};

}  // namespace whit
