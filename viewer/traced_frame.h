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
#include "inspect/ray_lines.h"
#include "io/image/image_file.h"
#include "viewer/comparison.h"
#include "viewer/knob_costs.h"
#include "viewer/shading_edit.h"

namespace whit::view {

// A scene as it is called on the command line, and its settings there.
struct SceneChoice {
  std::string name;
  std::vector<std::string> settings;
  std::string animation;  // empty: the first
};

struct FrameRequest {
  Camera camera;
  RenderOptions options;    // as the user set them; the size must be there
  ImageSize window;         // that the picture is to fill
  int spp = 1;              // that are traced: of the options, or more at rest
  int depth = kDepthLimit;  // that is traced at most, in motion
  bool coarse = false;      // at rest finer pixels will follow
  DebugView view = DebugView::none;
  bool withReference = false;     // the reference's picture as well, and how far apart they are
  bool measureKnobs = false;      // also what each knob costs
  int reloads = 0, edits = 0;     // of the scene before it
  std::optional<double> seconds;  // of a scene that moves: when it is looked at
  int serial = 0;                 // tells requests apart
  bool interruptible = false;     // given up when another one is asked for
};

// Whether both ask for the same picture.
inline bool samePicture(const FrameRequest& a, const FrameRequest& b) {
  return sameView(a.camera, b.camera) && a.options == b.options && a.window == b.window &&
         a.spp == b.spp && a.depth == b.depth && a.view == b.view &&
         a.withReference == b.withReference && a.measureKnobs == b.measureKnobs &&
         a.reloads == b.reloads && a.edits == b.edits && a.seconds == b.seconds;
}

// Whether both show the same, however finely.
inline bool sameSubject(const FrameRequest& a, FrameRequest b) {
  b.options.size = a.options.size;
  b.spp = a.spp;
  b.depth = a.depth;
  b.withReference = a.withReference;
  b.measureKnobs = a.measureKnobs;
  return samePicture(a, b);
}

inline double samplesOf(const FrameRequest& request) {
  const ImageSize size = request.options.size.value();
  return static_cast<double>(size.width) * size.height * request.spp;
}

struct TracedFrame {
  std::shared_ptr<const cli::OpenScene> scene;  // null: nothing traced yet
  FrameRequest request;
  RenderOptions options;  // the picture's
  std::string surfaces;   // how many there are, in words
  std::string animation;  // that was asked for
  Film film;
  FrameStats stats;
  ImageMetadata metadata;
  EffectSet effects;                               // that were traced
  bool sampled = false;                            // rays were drawn at random
  double sampleError = 0;                          // SampleSums::relativeError(), 0: not known
  std::array<EffectReason, kEffectCount> reasons;  // the scene's own change with an edit
  std::vector<std::string> settings;  // with which the scene was read, then those of an edit
  std::string sky;                    // its --sky, unless another was chosen since
  Machine machine;
  // Of a debug view:
  std::string legend;
  AmountScale scale;
  std::shared_ptr<const std::vector<WatchedPixel>> watched;
  std::optional<Comparison> comparison;  // where the request is with the reference
  std::vector<KnobCost> costs;           // where the request is to measure them
};

// What there is to be seen of a frame that is being traced.
struct UnfinishedFrame {
  FrameRequest request;
  DisplayImage display;  // transparent where nothing was traced yet; empty: options are measured
  double done = 0;       // share of it
  std::vector<KnobCost> costs;  // measured so far
  // Of a picture that gets more and more samples: that are shown, and SampleSums::relativeError().
  int samples = 0;
  double sampleError = 0;
};

// The rays of a pixel that the user points at: the question to the tracing thread, and its answer.
struct RayQuery {
  Camera camera;
  RenderOptions options;  // as for a whole picture; the size must be there
  int x = 0, y = 0;       // from the top left
  int reloads = 0, edits = 0;
  std::optional<double> seconds;  // of the picture on screen; the answer is that of the scene's
};

// Whether the answer to one is that to the other.
inline bool sameRays(const RayQuery& a, const RayQuery& b) {
  return sameView(a.camera, b.camera) && a.options == b.options && a.x == b.x && a.y == b.y &&
         a.reloads == b.reloads && a.edits == b.edits && a.seconds == b.seconds;
}

// Of a node. The scene itself may be edited by the time that they are read.
struct RayWords {
  std::string met, medium;
  std::string parting;              // empty: here the reference does not part
  std::vector<std::string> lights;  // by name, as the node has them
};

struct RayPick {
  std::shared_ptr<const cli::OpenScene> scene;  // null: nothing was picked
  RayQuery query;
  cli::ExplainedRays rays;
  std::vector<RayWords> words;  // of the packets' nodes
  std::vector<RayLine> lines;   // of the packets
};

}  // namespace whit::view
