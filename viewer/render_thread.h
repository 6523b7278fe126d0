// Tracing apart from the window's thread: the newest request wins, and a finished frame is handed
// over by exchanging buffers, so that neither thread waits for the other.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

#include "viewer/traced_frame.h"

namespace whit::view {

class RenderThread {
 public:
  // Builds the renderer on the calling thread; throws as Renderer does. `onChange` is called on the
  // tracing thread whenever a frame, a scene or an error is there to be fetched.
  RenderThread(std::shared_ptr<const cli::OpenScene> scene, const cli::CommonOptions& common,
               std::function<void()> onChange);
  ~RenderThread();
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  void ask(const FrameRequest& request);
  // Reads the scene again, between frames; the old one stays when that fails.
  void reload(const std::string& name);
  // Exchanges `frame` for the newest one finished since the last call; false: there is none.
  bool take(TracedFrame& frame);
  std::string takeError();  // empty: none
  bool busy() const;        // tracing, or about to

 private:
  void loop();
  void serve(std::unique_lock<std::mutex>& lock);
  void loadScene(const std::string& name);
  bool trace(const FrameRequest& request);
  void applyOptions(const FrameRequest& request);
  bool traceInBands(const Camera& camera, FrameStats& sum);
  bool superseded() const;

  const cli::CommonOptions common_;
  const std::function<void()> onChange_;

  // The tracing thread's own.
  std::shared_ptr<const cli::OpenScene> scene_;
  RenderOptions options_;
  std::unique_ptr<Renderer> renderer_;
  TracedFrame back_;
  Film band_;
  double msPerSample_ = 0;

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable wake_;
  std::optional<FrameRequest> asked_;
  std::optional<std::string> sceneToLoad_;
  TracedFrame ready_;
  bool fresh_ = false, busy_ = false, quit_ = false;
  std::string error_;
  std::thread thread_;
};

}  // namespace whit::view
