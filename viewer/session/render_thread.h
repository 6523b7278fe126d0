// The tracing thread, apart from the window's: frames are handed over by exchanging buffers, so
// that neither thread waits for the other.
//
// Pictures in motion are not queued. A new one is requested only when the one before has been
// finished and taken, so that it shows all that the user has done by then: a key has its effect in
// the second picture after it at the latest. A picture at rest is given up for any other request,
// or dropped if it has just been finished.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "viewer/session/frame_tracer.h"

namespace whit::view {

class RenderThread {
 public:
  // Builds the renderer on the calling thread; throws as Renderer does. `onChange` is called on
  // another thread whenever a frame, a scene or an error is there to be fetched.
  RenderThread(std::shared_ptr<OpenScene> scene, const cli::CommonOptions& common,
               std::function<void()> onChange);
  ~RenderThread();
  RenderThread(const RenderThread&) = delete;
  RenderThread& operator=(const RenderThread&) = delete;

  // Replaces the request that was not begun yet. Returns false while a picture is traced that
  // nothing stops, or waits to be taken; `onChange` tells when to ask again.
  bool ask(const FrameRequest& request);
  // Shows another scene from the next frame on.
  void load(std::unique_ptr<Engine> scene);
  // Edits the scene before the next frame, after the edits that wait; does nothing when the scene
  // is another one by then.
  void edit(const SceneEdit& edit);
  // Follows the rays of a pixel. A picture at rest is interrupted for it and begun again; one that
  // gains samples goes on.
  void query(const RayQuery& query);
  // The newest answer since the last call; null: there is none.
  std::optional<RayPick> takePick() { return taken(pick_); }
  // Exchanges `frame` for the newest one since the last call; false: there is none.
  bool take(TracedFrame& frame);
  // The samples so far of the picture that is being traced; null if there are no new ones.
  std::optional<UnfinishedFrame> takeUnfinished() { return taken(unfinished_); }
  std::string takeError() { return taken(error_); }  // empty: none
  // The progress of a reference that is being traced; empty: none is.
  std::string progress() const { return progress_.text(); }
  bool busy() const;       // tracing, or about to
  bool committed() const;  // tracing a picture that nothing stops

 private:
  template <typename Result>
  Result taken(Result& result) {
    const std::lock_guard lock(mutex_);
    return std::exchange(result, Result());
  }
  template <typename Change>
  void post(const Change& change);
  template <typename Change>
  void report(const Change& change);
  void loop();
  void serve(std::unique_lock<std::mutex>& lock);
  void trace(const FrameRequest& request);
  TraceCalls calls();
  void answerQuery();
  // The mutex must be held for these three.
  bool isCommitted() const { return tracing_ && !tracing_->interruptible; }
  bool isWaiting() const { return scene_ || edit_ || asked_; }
  bool hasWork() const { return isWaiting() || query_; }

  const std::function<void()> onChange_;
  FrameTracer tracer_;  // only the tracing thread uses tracer_ and back_
  TracedFrame back_;    // the picture that is being traced
  LatestProgress progress_;

  mutable std::mutex mutex_;  // guards the members below
  std::condition_variable wake_;
  // Requests of the window; each is handed to the tracing thread once, in this order.
  std::unique_ptr<Engine> scene_;
  std::optional<SceneEdit> edit_;
  std::optional<RayQuery> query_;
  std::optional<FrameRequest> asked_;
  std::optional<FrameRequest> tracing_;
  // Results of the tracing thread.
  std::optional<RayPick> pick_;
  std::optional<UnfinishedFrame> unfinished_;
  TracedFrame ready_;
  std::string error_;
  bool fresh_ = false;  // ready_ is still to be taken
  bool busy_ = false, quit_ = false;
  std::thread thread_;
};

}  // namespace whit::view
