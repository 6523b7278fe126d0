// The viewer's pictures: requests, frames, and their tracer.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/timing.h"
#include "command_line/parse_options.h"
#include "engine/engine.h"
#include "inspect/debug_view.h"
#include "inspect/ray_tree.h"
#include "io/image/image_file.h"
#include "io/json_reader.h"
#include "output/explained_rays.h"
#include "viewer/session/scene_edit.h"

namespace whit::view {

// knob_costs.cpp: the cost of each option and each effect at the present view. Frames with it and
// without it are timed in turns as `whit accuracy` does.

struct KnobCost {
  std::string name;         // of the option, or of the effect
  std::string other;        // the setting that is compared with, "off" for an effect
  FrameStats now, then;     // with the present setting and with the other
  accuracy::Timing timing;  // of frames with the other setting; the present one is the baseline
  double presentMs = 0;     // of a frame of the whole window

  // The time that the present setting adds to a frame of the whole window.
  double ms() const { return presentMs * (1 - timing.ratio); }
  // True if the difference is larger than the noise of the machine.
  bool significant() const { return timing.ratioLow > 1 || timing.ratioHigh < 1; }
};

// Returns the costs that exceed the noise of the machine, the largest first.
std::vector<KnobCost> toldFromNoise(std::vector<KnobCost> costs);
// "off would be 35 ms faster".
std::string costText(const KnobCost& cost);

// The size of the frames that are measured for a window of that size: smaller where a frame of it
// would take longer than kMeasuredMs.
ImageSize measuredSize(const ImageSize& window, double msPerPixel);
inline constexpr double kMeasuredMs = 50;

// Called between frames and at the end with the costs so far and the share of the knobs; returns
// false to end the measurement.
using MeasureCall = std::function<bool(const std::vector<KnobCost>& sofar, double measured)>;

// Leaves out options that are at their cheapest setting already, and those that need another
// acceleration structure. `film` is overwritten; a pixel of it stands for `scale` pixels of the
// window. The renderer has `options` before and after. Returns false if `goesOn` ended it.
bool measureKnobs(Renderer& renderer, const RenderOptions& options, const Camera& camera,
                  Film& film, double scale, const MeasureCall& goesOn);

struct SceneChoice {
  std::string name;
  std::vector<std::string> settings;
  std::string animation;  // empty: the first one
};

struct FrameRequest {
  Camera camera;
  RenderOptions options;  // the user's options; the size must be set
  ImageSize window;       // the window that the picture is to fill
  int spp = 1;            // samples that are traced: the options', or more at rest
  bool plain = false;     // without sampled rays, which follow at rest
  DebugView view = DebugView::none;
  bool measureKnobs = false;      // the cost of each knob is measured as well
  int reloads = 0, edits = 0;     // number of reloads and edits of the scene so far
  std::optional<double> seconds;  // the instant of a scene that moves
  bool interruptible = false;     // given up when another one is asked for
};

// Returns whether both ask for the same picture.
inline bool samePicture(const FrameRequest& a, const FrameRequest& b) {
  return sameView(a.camera, b.camera) && a.options == b.options && a.window == b.window &&
         a.spp == b.spp && a.plain == b.plain && a.view == b.view &&
         a.measureKnobs == b.measureKnobs && a.reloads == b.reloads && a.edits == b.edits &&
         a.seconds == b.seconds;
}

// Returns whether both show the same, at any resolution.
inline bool sameSubject(const FrameRequest& a, FrameRequest b) {
  b.options.size = a.options.size;
  b.spp = a.spp;
  b.plain = a.plain;
  b.measureKnobs = a.measureKnobs;
  return samePicture(a, b);
}

// Copies the numbers of rays that are sampled for each hit; by default there are none.
void copySampledRays(const RenderOptions& from, RenderOptions& to);
bool hasSampledRays(const RenderOptions& options);

inline double samplesOf(const FrameRequest& request) {
  const ImageSize size = request.options.size.value();
  return static_cast<double>(size.width) * size.height * request.spp;
}

struct TracedFrame {
  std::shared_ptr<const OpenScene> scene;  // null: nothing traced yet
  FrameRequest request;
  RenderOptions options;  // the options of the picture, with the sampled rays that it leaves out
  std::string surfaces;   // the number of triangles and spheres, in words
  std::string animation;  // the animation that was asked for
  Film film;
  FrameStats stats;
  ImageMetadata metadata;
  EffectSet effects;                               // the effects that were traced
  bool sampled = false;                            // rays were drawn at random
  double sampleError = 0;                          // SampleSums::relativeError(), 0: not known
  std::array<EffectReason, kEffectCount> reasons;  // a copy, as edits change the scene's own
  std::shared_ptr<const EditedScene> edited;       // a copy, as well
  Machine machine;
  std::shared_ptr<const DebugPicture> debug;  // null: the request is without a debug view
  // If the request measures knobs: the costs measured so far, and the share of the knobs.
  std::vector<KnobCost> costs;
  double measured = 0;
};

// A picture that gains samples, with those traced so far.
struct UnfinishedFrame {
  FrameRequest request;
  DisplayImage display;
  int samples = 0;
  double sampleError = 0;  // SampleSums::relativeError()
};

// A query for the rays of a pixel that the user picked; RayPick is the answer.
struct RayQuery {
  FrameRequest picture;
  int x = 0, y = 0;  // from the top left
};

// Returns whether both queries have the same answer.
inline bool sameRays(const RayQuery& a, const RayQuery& b) {
  return samePicture(a.picture, b.picture) && a.x == b.x && a.y == b.y;
}

struct RayPick {
  std::shared_ptr<const OpenScene> scene;  // null: nothing was picked
  RayQuery query;
  ExplainedRays rays;
  // One for each node of the packets: the scene may be edited before they are shown.
  std::vector<RayText> words;
  std::vector<RayLine> lines;  // the rays of the packets
  Camera aside;                // sees them
};

// Each pass of a picture that gains samples takes about this long, with at least one sample a
// pixel.
inline constexpr double kPassMs = 100;
inline constexpr double kLeastPasses = 8;  // where there are as many samples

struct TraceCalls {
  // The workers call these two between tiles and samples. Once true they stay true.
  std::function<bool()> superseded;  // another picture is wanted
  std::function<bool()> stopped;     // the picture is to be given up for anything else
  // Answers a query for the rays of a pixel; called between passes and measured frames.
  std::function<void()> answer;
  // Called with frames whose knobs are being measured.
  std::function<void(const TracedFrame&)> publish;
  // Called when a picture has more samples than the one before.
  std::function<void(UnfinishedFrame)> showUnfinished;
};

// Makes the pictures that requests ask for. It belongs to one thread.
class FrameTracer {
 public:
  // Builds the renderer; throws as Renderer does.
  FrameTracer(std::shared_ptr<OpenScene> scene, const cli::CommonOptions& common);

  // Reads a scene; the old one stays when that fails.
  void load(const SceneChoice& choice);
  // Edits the scene; does nothing when it is another one by now. Throws with nothing changed.
  void edit(const SceneEdit& edit);

  // Follows the rays of a pixel; leaves the renderer's options as they were.
  RayPick explain(const RayQuery& query);

  // Returns false when the picture was given up; `frame` is not to be shown then. Throws when the
  // options ask for what the machine does not have; the old ones then stay.
  bool trace(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);

 private:
  // Tells what the picture shows and how it was made.
  void describe(const FrameRequest& request, TracedFrame& frame);
  bool tracePicture(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  // Traces the picture as one frame.
  bool traceAtOnce(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  // At rest, where rays are sampled: pass by pass, each with some of the samples of all pixels.
  bool accumulates(const FrameRequest& request) const;
  bool traceInPasses(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  bool measure(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);

  const cli::CommonOptions common_;
  std::unique_ptr<Engine> engine_;
  std::shared_ptr<const EditedScene> edited_;  // the scene as it is now; null: to be copied
  std::string animation_;                      // the animation that the scene was read with
  Film band_;                                  // frames that are measured
  std::optional<FrameRequest> finished_;       // the last picture
  double msPerSample_ = 0;                     // 0: nothing traced yet
};

}  // namespace whit::view
