// The tracer of the viewer's pictures, which makes what a FrameRequest asks for. It belongs to one
// thread.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "viewer/traced_frame.h"

namespace whit::view {

// A picture under way is shown again after this time.
inline constexpr double kUnfinishedMs = 25;
// Each pass of a picture that gains samples takes about this long, with at least one sample a
// pixel.
inline constexpr double kPassMs = 100;
inline constexpr double kLeastPasses = 8;  // where there are as many samples

struct TraceCalls {
  // These three are asked by the workers, between tiles and samples.
  std::function<bool()> superseded;  // something else is wanted: pictures at rest are given up
  std::function<bool()> queried;     // the rays of a pixel are asked for
  std::function<bool()> leaving;     // the viewer ends: all pictures are given up
  // Answers a query for the rays of a pixel; called between passes and bands.
  std::function<void()> answer;
  // Called with frames whose reference is under way.
  std::function<void(const TracedFrame&)> publish;
  // Called every kUnfinishedMs while a picture is traced, by a worker.
  std::function<void(UnfinishedFrame)> showUnfinished;
};

class FrameTracer {
 public:
  // Builds the renderer; throws as Renderer does.
  FrameTracer(std::shared_ptr<cli::OpenScene> scene, const cli::CommonOptions& common);

  // Reads a scene; the old one stays when that fails.
  void load(const SceneChoice& choice);
  // Changes materials, lights and surroundings; does nothing when the scene is another one by now.
  void edit(ShadingEdit edit);

  // Follows the rays of a pixel; leaves the renderer's options as they were.
  RayPick explain(const RayQuery& query);

  // Computes some of the parts of the shadow cache that the last pictures requested, which takes
  // about 10 ms. Returns false if nothing is left.
  bool proveSome();

  // Returns false when the picture was given up; `frame` is not to be shown then. Throws when the
  // options ask for what the machine does not have; the old ones then stay.
  bool trace(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);

 private:
  void use(std::unique_ptr<Renderer> renderer);
  void editSurroundings(const ShadingEdit& edit, Sky opened);
  void moveTo(double seconds);
  void applyOptions(const FrameRequest& request);
  bool tracePicture(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  // Traces the picture as one frame, whose finished tiles are shown while it is under way.
  bool traceAtOnce(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  // At rest, where rays are sampled: pass by pass, each with some of the samples of all pixels.
  bool accumulates(const FrameRequest& request) const;
  bool traceInPasses(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  // Paints pixels of a tile of a debug view into the film's display.
  void paintTile(DebugView view, const std::vector<WatchedPixel>& watched,
                 std::span<const std::uint32_t> pixels, Film& film);
  bool traceReference(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);

  const cli::CommonOptions common_;
  std::shared_ptr<cli::OpenScene> scene_;
  RenderOptions options_;
  std::unique_ptr<Renderer> renderer_;
  std::vector<std::string> editSettings_;  // of the scene as it is now
  SkyChoice sky_;                          // the sky that the scene has now
  Sky ownSky_;                             // the scene's own sky, while it has another one
  double seconds_ = 0;                     // the instant that a moving scene is at
  std::string animation_;                  // the animation that the scene was read with
  Film band_;                              // rows of the reference
  std::optional<FrameRequest> finished_;   // the last picture
  AmountScale scale_;  // scale of the last debug view, with which the next begins
  DebugView scaleOf_ = DebugView::none;
  double msPerSample_ = 0;  // 0: nothing traced yet
};

}  // namespace whit::view
