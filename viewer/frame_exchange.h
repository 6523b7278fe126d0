// The exchange between the window's thread and the tracing thread: which picture is begun when.
// Pure: knows neither threads nor clock; RenderThread locks it.
//
// Pictures in motion are not queued. One is asked for when the one before is finished and taken, so
// that what the user has done by then is in it; thus at most two pictures are finished after a key
// up to its own, that one included: the one that was being traced, and the key's. A picture at
// rest, in contrast, is given up for anything else, or dropped if it has just been finished.
#pragma once

#include <optional>
#include <utility>

#include "viewer/ray_pick.h"
#include "viewer/traced_frame.h"

namespace whit::view {

class FrameExchange {
 public:
  // From the window. `ask` replaces what was asked for and not yet begun. False: not now, a picture
  // is being traced to its end, or waits to be taken.
  bool ask(const FrameRequest& request);
  void load(const SceneChoice& scene) { scene_ = scene; }
  void edit(ShadingEdit edit) { edit_ = std::move(edit); }
  // Pictures are not given up for it.
  void query(const RayQuery& query) { query_ = query; }
  // The newest answer since the last call; null: there is none.
  std::optional<RayPick> takePick() { return std::exchange(pick_, std::nullopt); }
  // Exchanges `frame` for the newest one since the last call; false: there is none.
  bool take(TracedFrame& frame);
  // A picture is being traced that nothing stops.
  bool committed() const { return tracing_ && !tracing_->interruptible; }

  // From the tracing thread: what is to be done next, in this order; each is handed out once.
  std::optional<SceneChoice> nextScene() { return std::exchange(scene_, std::nullopt); }
  std::optional<ShadingEdit> nextEdit() { return std::exchange(edit_, std::nullopt); }
  std::optional<FrameRequest> begin();
  // This one also between two parts of a picture.
  std::optional<RayQuery> nextQuery() { return std::exchange(query_, std::nullopt); }
  void answer(RayPick pick) { pick_ = std::move(pick); }
  // Something of the above is there; a picture at rest is to be given up.
  bool waiting() const { return scene_ || edit_ || asked_; }
  // That, or a question.
  bool hasWork() const { return waiting() || query_; }
  // The picture begun last is finished, and exchanged for one that may be overwritten.
  void finish(TracedFrame& frame);
  void giveUp() {
    tracing_.reset();
    unfinished_.reset();
  }
  // A picture whose reference is under way, to be taken as well.
  void show(TracedFrame& frame);
  // What there is of a picture under way; dropped when it is finished or given up.
  void showUnfinished(UnfinishedFrame frame) { unfinished_ = std::move(frame); }
  std::optional<UnfinishedFrame> takeUnfinished() {
    return std::exchange(unfinished_, std::nullopt);
  }

 private:
  std::optional<SceneChoice> scene_;
  std::optional<ShadingEdit> edit_;
  std::optional<FrameRequest> asked_, tracing_;
  std::optional<RayQuery> query_;
  std::optional<RayPick> pick_;
  std::optional<UnfinishedFrame> unfinished_;
  TracedFrame ready_;
  bool fresh_ = false;  // ready_ is still to be taken
};

}  // namespace whit::view
