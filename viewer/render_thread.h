// The tracing thread, apart from the window's: frames are handed over by exchanging buffers, so
// that neither thread waits for the other.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "viewer/frame_exchange.h"
#include "viewer/frame_tracer.h"

namespace whit::view {

class RenderThread {
 public:
  // Builds the renderer on the calling thread; throws as Renderer does. `onChange` is called on the
  // tracing thread whenever a frame, a scene or an error is there to be fetched.
  RenderThread(std::shared_ptr<cli::OpenScene> scene, const cli::CommonOptions& common,
               std::function<void()> onChange);
  ~RenderThread();
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  // False: not now, as FrameExchange has it; `onChange` tells when to ask again.
  bool ask(const FrameRequest& request);
  // Reads a scene, between frames; the old one stays when that fails.
  void load(const SceneChoice& scene);
  // Changes materials and lights, between frames; nothing when the scene is another one by then.
  void edit(ShadingEdit edit);
  // Follows the rays of a pixel, before the next frame or between two bands of this one.
  void query(const RayQuery& query);
  std::optional<RayPick> takePick();
  // Exchanges `frame` for the newest one since the last call; false: there is none.
  bool take(TracedFrame& frame);
  // What there is of the one that is being traced; null: nothing new.
  std::optional<UnfinishedFrame> takeUnfinished();
  std::string takeError();  // empty: none
  bool busy() const;        // tracing, or about to
  bool committed() const;   // tracing a picture that nothing stops

 private:
  bool post(const std::function<bool()>& change);
  void loop();
  void serve(std::unique_lock<std::mutex>& lock);
  void trace(const FrameRequest& request);
  TraceCalls calls();
  void publish(const TracedFrame& frame);
  void publish(UnfinishedFrame frame);
  void answerQuery();
  void waitForWork(std::unique_lock<std::mutex>& lock);
  bool superseded() const;
  bool leaving() const;

  const std::function<void()> onChange_;
  FrameTracer tracer_;  // the tracing thread's own, as is the next
  TracedFrame back_;

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable wake_;
  FrameExchange exchange_;
  bool busy_ = false, quit_ = false;
  std::string error_;
  std::thread thread_;
};

}  // namespace whit::view
