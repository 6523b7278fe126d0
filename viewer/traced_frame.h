// Requests to the tracing thread, and the frames that come back.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/app/explained_rays.h"
#include "inspect/debug_view.h"
#include "inspect/metrics.h"
#include "inspect/ray_lines.h"
#include "io/image/image_file.h"
#include "viewer/shading_edit.h"

namespace whit::view {

// A scene by its name and settings on the command line.
struct SceneChoice {
  std::string name;
  std::vector<std::string> settings;
  std::string animation;  // empty: the first one
};

struct FrameRequest {
  Camera camera;
  RenderOptions options;    // the user's options; the size must be set
  ImageSize window;         // the window that the picture is to fill
  int spp = 1;              // samples that are traced: the options', or more at rest
  int depth = kDepthLimit;  // upper limit of the depth in motion
  bool coarse = false;      // finer pixels will follow at rest
  DebugView view = DebugView::none;
  bool withReference = false;     // the reference's picture is traced and compared as well
  int reloads = 0, edits = 0;     // number of reloads and edits of the scene so far
  std::optional<double> seconds;  // the instant of a scene that moves
  int serial = 0;                 // the number of the request
  bool interruptible = false;     // given up when another one is asked for
};

// Returns whether both ask for the same picture.
inline bool samePicture(const FrameRequest& a, const FrameRequest& b) {
  return sameView(a.camera, b.camera) && a.options == b.options && a.window == b.window &&
         a.spp == b.spp && a.depth == b.depth && a.view == b.view &&
         a.withReference == b.withReference && a.reloads == b.reloads && a.edits == b.edits &&
         a.seconds == b.seconds;
}

// Returns whether both show the same, at any resolution.
inline bool sameSubject(const FrameRequest& a, FrameRequest b) {
  b.options.size = a.options.size;
  b.spp = a.spp;
  b.depth = a.depth;
  b.withReference = a.withReference;
  return samePicture(a, b);
}

inline double samplesOf(const FrameRequest& request) {
  const ImageSize size = request.options.size.value();
  return static_cast<double>(size.width) * size.height * request.spp;
}

// How the frame is compared with the reference.
enum class CompareMode { off, split, heatMap };

// Grows row by row from the top while the reference is traced.
struct Comparison {
  Film reference;  // rows [0, rows) are done
  int rows = 0;
  double referenceMs = 0;
  // These two are set when all rows are done:
  std::optional<ImageDifference> difference;
  DisplayImage heatMap;  // as large as the frame

  bool complete() const { return difference.has_value(); }
  double progress() const {
    return reference.image.height > 0 ? static_cast<double>(rows) / reference.image.height : 0;
  }
};

struct TracedFrame {
  std::shared_ptr<const cli::OpenScene> scene;  // null: nothing traced yet
  FrameRequest request;
  RenderOptions options;  // the options of the picture
  std::string surfaces;   // the number of triangles and spheres, in words
  std::string animation;  // the animation that was asked for
  Film film;
  FrameStats stats;
  ImageMetadata metadata;
  EffectSet effects;                               // the effects that were traced
  bool sampled = false;                            // rays were drawn at random
  double sampleError = 0;                          // SampleSums::relativeError(), 0: not known
  std::array<EffectReason, kEffectCount> reasons;  // a copy, as edits change the scene's own
  std::vector<std::string> settings;               // settings of the scene, then those of an edit
  std::string sky;  // the scene's --sky, unless another sky was chosen
  Machine machine;
  // These three belong to a debug view:
  std::string legend;
  AmountScale scale;
  std::shared_ptr<const std::vector<WatchedPixel>> watched;
  std::optional<Comparison> comparison;  // if the request is with the reference
};

// Returns the frame left of column `split` and the rows of the reference that are done right of it.
DisplayImage splitPicture(const DisplayImage& frame, const Comparison& comparison, int split);

// The visible part of a frame that is being traced.
struct UnfinishedFrame {
  FrameRequest request;
  DisplayImage display;  // transparent where nothing was traced yet; empty: nothing new to show
  double done = 0;       // share of the frame
  // For a picture that gains samples: the samples shown, and SampleSums::relativeError().
  int samples = 0;
  double sampleError = 0;
};

// A query for the rays of a pixel that the user picked; RayPick is the answer.
struct RayQuery {
  Camera camera;
  RenderOptions options;  // the options of the whole picture; the size must be set
  int x = 0, y = 0;       // from the top left
  int reloads = 0, edits = 0;
  std::optional<double> seconds;  // the instant of the picture on screen
};

// Returns whether both queries have the same answer.
inline bool sameRays(const RayQuery& a, const RayQuery& b) {
  return sameView(a.camera, b.camera) && a.options == b.options && a.x == b.x && a.y == b.y &&
         a.reloads == b.reloads && a.edits == b.edits && a.seconds == b.seconds;
}

// The description of a node. The scene may be edited before it is shown.
struct RayWords {
  std::string met, medium;
  std::string parting;              // where the reference takes another path; empty: it does not
  std::vector<std::string> lights;  // names of the node's lights
};

struct RayPick {
  std::shared_ptr<const cli::OpenScene> scene;  // null: nothing was picked
  RayQuery query;
  cli::ExplainedRays rays;
  std::vector<RayWords> words;  // one for each node of the packets
  std::vector<RayLine> lines;   // the rays of the packets
};

}  // namespace whit::view
