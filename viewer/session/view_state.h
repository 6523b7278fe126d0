// The state of the viewer: all that the window and the page show, and all that the user has chosen.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "viewer/session/frame_tracer.h"
#include "viewer/session/timeline.h"

namespace whit::view {

// A click on the picture selects these in the scene; kNoCounterpart means nothing.
struct Selection {
  std::size_t material = kNoCounterpart, light = kNoCounterpart;
};

// Returns the material that was hit and the light that adds most.
Selection select(const RayPick& pick);

struct ViewState {
  std::shared_ptr<const OpenScene> scene;  // the scene of the frame shown
  std::string sceneName;                   // as on the command line
  RenderOptions options;
  DebugView view = DebugView::none;
  bool measures = false;  // the costs of options are being measured
  Timeline timeline;
  std::optional<std::size_t> followed;  // the scene's camera whose view is shown
  EditedScene edited;                   // with edits that are not traced yet
  Sky ownSky;                           // the scene's sky as it was read

  TracedFrame shown;
  std::optional<UnfinishedFrame> unfinished;  // is shown in place of the frame
  std::vector<KnobCost> costs;                // measured so far at the view of the last frame
  double pictureMs = 0;  // mean time between pictures in motion; 0: nothing moves
  bool sharp = false;    // the frame shown gets no finer
  RayPick rays;          // the rays of the pixel that was clicked
  Selection selected;
  int selections = 0;  // number of clicks that have selected something

  std::string message;                          // empty when its time is over
  std::string error;                            // stays until it is dismissed or a scene is read
  int errors = 0;                               // number of errors so far
  ExitStatus status = ExitStatus::checkFailed;  // exit status if the last error ends the program
};

// "1/4, 16 samples, 30 frames/s": what the picture has, and how often it changes.
std::string statusText(const ViewState& state);
// "whitted, 2 triangles ...; avx2, packets of 8, 4 threads".
std::string aboutText(const TracedFrame& frame);

// ", within about 0.8 %": the standard error of a pixel, as SampleSums::relativeError() has it;
// empty where that is not known.
std::string errorText(double sampleError);
// "1/4, 16 samples": the share of the window's pixels a side, and the samples.
std::string sharpnessText(const FrameRequest& request);

}  // namespace whit::view
