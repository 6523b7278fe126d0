// Private data of the library's scenes and images, and guards around its calls, which turn
// exceptions into api::Error, except those of the caller's own callbacks.
#pragma once

#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "accel/ray_queries.h"
#include "bake/scene.h"
#include "core/error.h"
#include "core/progress.h"
#include "engine/engine.h"
#include "io/image/image_file.h"
#include "library/whit.h"
#include "render/frame.h"

namespace whit::api {

// Ends the work of the threads that report progress.
struct Stopped : std::exception {
  const char* what() const noexcept override { return "ended by the progress callback"; }
};

// Reports progress to a callback, one thread at a time. After the callback has ended the work, it
// is not called again, and every report throws Stopped.
class CallbackProgress : public whit::Progress {
 public:
  explicit CallbackProgress(const api::Progress& callback) : callback_(callback) {}

  void report(const std::string& phase, double fraction) override {
    const std::lock_guard lock(mutex_);
    if (!stopped_) stopped_ = !goesOn(phase, fraction);
    if (stopped_) throw Stopped();
  }

  // Throws the callback's own exception, or else an Error of status 130.
  [[noreturn]] void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
    constexpr int kInterrupted = 130;
    throw Error(kInterrupted, Stopped().what());
  }

 private:
  bool goesOn(const std::string& phase, double fraction) {
    try {
      return callback_(phase, fraction);
    } catch (...) {
      thrown_ = std::current_exception();
      return false;
    }
  }

  const api::Progress& callback_;
  std::mutex mutex_;
  bool stopped_ = false;
  std::exception_ptr thrown_;
};

[[noreturn]] inline void throwAsOwn(const std::exception& error) {
  const Failure failure = failureOf(error);
  const ErrorPlace& at = failure.place;
  throw Error(static_cast<int>(failure.status), failure.what, {at.file, at.place, at.expected});
}

// Calls `body`, which reports no progress.
template <typename Body>
decltype(auto) guarded(Body&& body) {
  try {
    return body();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throwAsOwn(error);
  }
}

// Calls `body` with the progress to report to, or null.
template <typename Body>
decltype(auto) guarded(const Progress& callback, Body&& body) {
  CallbackProgress progress(callback);
  try {
    return body(callback ? &progress : nullptr);
  } catch (const Stopped&) {
    progress.rethrow();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throwAsOwn(error);
  }
}

struct Scene::Data {
  std::shared_ptr<OpenScene> open;

  static std::shared_ptr<Data> read(const SceneSource& source, const LoadOptions& options,
                                    const char* shippedScenes, whit::Progress* progress);
};

struct Image::Data {
  Film film;
  ImageMetadata metadata, aboutChannels;
};

GivenMesh givenMesh(MeshArrays arrays);

// Copies the scene of a renderer at its present time, for the views of the Python module.
struct [[gnu::visibility("default")]] SceneCopy {
  static std::shared_ptr<OpenScene> of(Renderer & renderer);
};

// The queries of whit.h (rays.cpp): rays come as the program's numbers, are answered on all
// threads, and go back in columns.
struct Queried {
  const whit::Scene& scene;
  const RayQueries& queries;
  int threads;
  whit::Progress* progress;
};

RayHits closest(const Queried& at, const Rays& rays);
RayHits allHits(const Queried& at, const Rays& rays, std::size_t limit);
RayAnswers occluded(const Queried& at, const Rays& rays);
RayAnswers visible(const Queried& at, const Numbers& from, const Numbers& to,
                   const Numbers& fromNormals, const Numbers& toNormals);
std::vector<float> ambientOcclusion(const Queried& at, const Numbers& points,
                                    const Numbers& normals, double radius, int samples);

}  // namespace whit::api
