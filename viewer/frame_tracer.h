// The tracer of the viewer's pictures, which makes what a FrameRequest asks for. Belongs to one
// thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "viewer/cost_map.h"
#include "viewer/ray_pick.h"
#include "viewer/traced_frame.h"

namespace whit::view {

// Blocks of interruptible frames are meant to take so long: what a new request waits at most.
inline constexpr double kBlockMs = 10;
// Of frames in motion, which are shown whatever is wanted next, those that take longer are traced
// in blocks as well, of so long: what closing the window waits at most.
inline constexpr double kLongBlockMs = 50;
// Between two sights of a picture under way.
inline constexpr double kUnfinishedMs = 25;
// Of a picture that gets more and more samples, each pass over it is meant to take so long; it has
// one sample a pixel at least.
inline constexpr double kPassMs = 100;
inline constexpr double kLeastPasses = 8;  // where there are as many samples

struct TraceCalls {
  // Asked between blocks of interruptible frames: something else is wanted.
  std::function<bool()> superseded;
  // Asked between blocks of the others: nobody will look any more.
  std::function<bool()> leaving;
  // Called with frames whose reference is under way.
  std::function<void(const TracedFrame&)> publish;
  // Called every kUnfinishedMs while a frame is traced in blocks, and after each option measured.
  std::function<void(UnfinishedFrame)> showUnfinished;
};

class FrameTracer {
 public:
  // Builds the renderer; throws as Renderer does.
  FrameTracer(std::shared_ptr<cli::OpenScene> scene, const cli::CommonOptions& common);

  // Reads a scene; the old one stays when that fails.
  void load(const SceneChoice& choice);
  // Changes materials, lights and surroundings; nothing when the scene is another one by now.
  void edit(ShadingEdit edit);

  // The rays of a pixel. Also called from what trace() calls, between blocks; leaves the renderer's
  // options what they were.
  RayPick explain(const RayQuery& query);

  // Computes some of the parts of the shadow cache that the last pictures requested, for about
  // kBlockMs. False if nothing is left.
  bool proveSome();

  // False: given up, and `frame` is not to be shown. Throws when the options ask for what the
  // machine does not have; the old ones then stay.
  bool trace(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);

 private:
  void use(std::unique_ptr<Renderer> renderer);
  void editSurroundings(const ShadingEdit& edit, Sky opened);
  void moveTo(double seconds);
  void applyOptions(const FrameRequest& request);
  bool tracePicture(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  // What there is to trace in a part of the picture.
  FrameStats traceBlock(const FrameRequest& request, const Crop& block, TracedFrame& frame);
  FrameStats watchBlock(const FrameRequest& request, TracedFrame& frame);
  void finishView(const FrameRequest& request, TracedFrame& frame);
  // Blocks are meant to take `blockMs`; false when `givenUp` said so between two of them.
  bool traceInBlocks(const FrameRequest& request, TracedFrame& frame, double blockMs,
                     const std::function<bool()>& givenUp, const TraceCalls& calls);
  // At rest, where rays are sampled: pass by pass, each with some of the samples of all pixels.
  bool accumulates(const FrameRequest& request) const;
  bool traceInPasses(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  // The samples `part_` of all pixels; afterBlock(last block).
  bool traceBlocks(const FrameRequest& request, TracedFrame& frame, double blockMs,
                   const std::function<bool()>& givenUp,
                   const std::function<void(const Crop&)>& afterBlock);
  // The one after `last`, which is empty before the first.
  Crop nextBlock(const ImageSize& size, const Crop& last, double blockMs, DebugView view);
  Crop nextTiles(const ImageSize& size, const Crop& last, double blockMs);
  bool fits(double blockMs, const ImageSize& size, const Crop& part);
  double probe(const Camera& camera, const ImageSize& whole);
  bool measure(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  bool traceReference(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);

  const cli::CommonOptions common_;
  std::shared_ptr<cli::OpenScene> scene_;
  RenderOptions options_;
  std::unique_ptr<Renderer> renderer_;
  std::vector<std::string> editSettings_;  // of the scene as it is now
  SkyChoice sky_;                          // that the scene has now
  Sky ownSky_;                             // its own, while it has another one
  double seconds_ = 0;                     // when it is, where it moves
  std::string animation_;                  // that it was read with
  Film band_;
  SampleRange part_;                      // of the samples, that is traced at once
  std::optional<SampleSums> sums_;        // of a picture that is traced in passes
  std::optional<FrameRequest> finished_;  // the last picture
  std::vector<WatchedPixel> watched_;     // of the view that is being traced
  AmountScale scale_;                     // of its last picture, by which the next one begins
  DebugView scaleOf_ = DebugView::none;
  double msPerSample_ = 0;                  // 0: nothing traced yet
  CostMap costs_;                           // of samples, ms
  std::optional<FrameRequest> learnedFor_;  // that both were last learned from
};

}  // namespace whit::view
