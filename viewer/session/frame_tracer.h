// Makes the viewer's pictures: what is requested, what is traced, and the tracer, which also
// answers queries for the rays of a pixel.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line/parse_options.h"
#include "engine/engine.h"
#include "inspect/ray_tree.h"
#include "inspect/reference_view.h"
#include "io/image/image_file.h"
#include "io/json_reader.h"
#include "output/explained_rays.h"
#include "viewer/session/knob_costs.h"
#include "viewer/session/scene_edit.h"
#include "viewer/session/scene_reader.h"

namespace whit::view {

struct FrameRequest {
  Camera camera;
  RenderOptions options;  // the user's options; the size must be set
  ImageSize window;       // the size of the window that the picture fills
  int spp = 1;            // samples per pixel to trace, in place of options.spp: fewer or more
  bool plain = false;     // without sampled rays; a later picture has them
  DebugView view = DebugView::none;
  bool measureKnobs = false;      // the cost of each knob is measured as well
  int reloads = 0, edits = 0;     // number of reloads and edits of the scene so far
  std::optional<double> seconds;  // the time of a scene that moves
  bool interruptible = false;     // may be given up for another request
};

// Returns whether both ask for the same picture.
inline bool samePicture(const FrameRequest& a, const FrameRequest& b) {
  return sameView(a.camera, b.camera) && a.options == b.options && a.window == b.window &&
         a.spp == b.spp && a.plain == b.plain && a.view == b.view &&
         a.measureKnobs == b.measureKnobs && a.reloads == b.reloads && a.edits == b.edits &&
         a.seconds == b.seconds;
}

// Returns whether both show the same thing, at any resolution and number of samples, and with or
// without sampled rays.
inline bool sameSubject(const FrameRequest& a, FrameRequest b) {
  b.options.size = a.options.size;
  b.spp = a.spp;
  b.plain = a.plain;
  b.measureKnobs = a.measureKnobs;
  return samePicture(a, b);
}

// Resets the options that choose a camera. They belong to the first scene; pictures are requested
// with cameras of their own.
void clearCamera(RenderOptions& options);
// Copies the options that say how many rays are sampled for each hit. The default options sample
// none.
void copySampledRays(const RenderOptions& from, RenderOptions& to);
bool hasSampledRays(const RenderOptions& options);

// Returns the number of samples of all pixels.
inline double samplesOf(const FrameRequest& request) {
  const ImageSize size = request.options.size.value();
  return static_cast<double>(size.width) * size.height * request.spp;
}

struct TracedFrame {
  std::shared_ptr<const OpenScene> scene;  // null: nothing traced yet
  FrameRequest request;
  RenderOptions options;  // the renderer's, with the sampled rays that a plain picture leaves out
  std::string surfaces;   // the number of triangles and spheres, in words
  std::string animation;  // the animation that was asked for
  std::string warning;    // the warning of an edit; empty: none
  Film film;
  FrameStats stats;
  ImageMetadata metadata;
  EffectSet effects;                               // the effects that were traced
  bool sampled = false;                            // rays were drawn at random
  std::string dark;                                // noLightWarning()
  double sampleError = 0;                          // SampleSums::relativeError(), 0: not known
  std::array<EffectReason, kEffectCount> reasons;  // copied, because edits change the scene's own
  std::shared_ptr<const EditedScene> edited;       // copied as well: the scene after its edits
  Machine machine;
  std::shared_ptr<const DebugPicture> debug;  // null: the request has no debug view
  // If the request measures knobs: the costs so far, and the share of the knobs that is measured.
  std::vector<KnobCost> costs;
  double measured = 0;
};

// A picture that is traced in passes, with the samples that it has so far.
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

// Returns whether both are of one pixel of one view, at whatever time.
inline bool samePick(const RayQuery& a, const RayQuery& b) {
  return a.x == b.x && a.y == b.y && sameView(a.picture.camera, b.picture.camera);
}

struct RayPick {
  std::shared_ptr<const OpenScene> scene;  // null: nothing was picked
  RayQuery query;
  ExplainedRays rays;
  // The text of each node of the packets, written now because the scene may be edited before it is
  // shown.
  std::vector<RayText> words;
  std::vector<RayLine> lines;  // the rays of the packets
  Camera aside;                // sees the hits of the rays from the side
};

// Each pass of a picture takes about this long, but has at least one sample per pixel.
inline constexpr double kPassMs = 100;
inline constexpr double kLeastPasses = 8;  // or one for each sample if there are fewer

struct TraceCalls {
  // The workers call one of these two between tiles and samples. Once true it stays true while the
  // picture is traced. Only `superseded` ends a picture that is traced in passes, so that queries
  // for rays do not. Both are true as well when the viewer ends.
  std::function<bool()> superseded;  // another picture, scene or edit waits
  std::function<bool()> stopped;     // the picture is interruptible, and anything else waits
  // Answers a query for the rays of a pixel if one waits; called between passes and between frames
  // that are measured.
  std::function<void()> answer;
  // Called with frames whose knobs are being measured.
  std::function<void(const TracedFrame&)> publish;
  // Called between passes, once the picture has more samples than the finished one of the same
  // view.
  std::function<void(UnfinishedFrame)> showUnfinished;
  Progress* progress = nullptr;  // gets the progress of the scalar reference
};

// Makes the pictures that requests ask for. It belongs to one thread.
class FrameTracer {
 public:
  // Builds the renderer; throws as Renderer does.
  FrameTracer(std::shared_ptr<OpenScene> scene, const cli::CommonOptions& common);

  // Shows another scene from now on.
  void load(std::unique_ptr<Engine> scene);
  // Edits the scene; does nothing if another scene was loaded since. If it throws, the scene is
  // unchanged.
  void edit(const SceneEdit& edit);

  // Traces and explains the rays of a pixel; the renderer's options are then what they were.
  RayPick explain(const RayQuery& query);

  // Returns false if the picture was given up; `frame` is then not to be shown. Throws if the
  // options ask for what the machine does not have; the next request then has to bring others.
  bool trace(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);

 private:
  // Notes in the frame what the picture shows and how it was made.
  void describe(const FrameRequest& request, TracedFrame& frame);
  bool tracePicture(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  // Traces the picture as one frame.
  bool traceAtOnce(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  // Traces the picture and its reference, which stays for the other view of the same picture.
  void traceReference(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  // Returns whether the picture is traced in passes, each with some of the samples of every pixel:
  // at rest, if rays are sampled.
  bool accumulates(const FrameRequest& request) const;
  bool traceInPasses(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);
  bool measure(const FrameRequest& request, TracedFrame& frame, const TraceCalls& calls);

  const bool warns_;  // prints the warnings of edits on standard error
  std::unique_ptr<Engine> engine_;
  std::shared_ptr<const EditedScene> edited_;  // the scene with its edits; null: to be copied again
  std::string warning_;                        // warning of edits, until a picture shows it
  Film measured_;                              // frames of measure() are traced into it
  std::optional<Film> reference_;              // empty: not traced, or given up
  std::optional<FrameRequest> referenceFor_;   // the picture of reference_, without its view
  std::optional<FrameRequest> finished_;       // the last picture that was not given up
  double msPerSample_ = 0;  // in the last picture that was not plain; 0: there was none
};

}  // namespace whit::view
