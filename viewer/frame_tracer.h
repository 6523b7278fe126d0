// The tracer of the viewer's pictures, which makes what a FrameRequest asks for. Belongs to one
// thread.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "viewer/traced_frame.h"

namespace whit::view {

// Bands of interruptible frames are meant to take so long: what a new request waits at most.
inline constexpr double kBandMs = 5;
// Of frames in motion, which are shown whatever is wanted next, those that take longer are traced
// in bands as well, of so long: what closing the window waits at most.
inline constexpr double kLongBandMs = 500;

class FrameTracer {
 public:
  // Builds the renderer; throws as Renderer does.
  FrameTracer(std::shared_ptr<cli::OpenScene> scene, const cli::CommonOptions& common);

  // Reads a scene; the old one stays when that fails.
  void load(const SceneChoice& choice);
  // Changes materials and lights; nothing when the scene is another one by now.
  void edit(ShadingEdit edit);

  // Asked between bands of rows of interruptible frames: something else is wanted.
  using Superseded = std::function<bool()>;
  // Asked between bands of the others: nobody will look any more.
  using Leaving = std::function<bool()>;
  // Called with frames whose reference is under way.
  using Publish = std::function<void(const TracedFrame&)>;
  // False: given up, and `frame` is not to be shown. Throws when the options ask for what the
  // machine does not have; the old ones then stay.
  bool trace(const FrameRequest& request, TracedFrame& frame, const Superseded& superseded,
             const Leaving& leaving, const Publish& publish);

 private:
  void applyOptions(const FrameRequest& request);
  bool tracePicture(const FrameRequest& request, TracedFrame& frame, const Superseded& superseded,
                    const Leaving& leaving);
  // Bands are meant to take `bandMs`; false when `givenUp` said so between two of them.
  bool traceInBands(const Camera& camera, TracedFrame& frame, double bandMs,
                    const std::function<bool()>& givenUp);
  bool traceReference(const FrameRequest& request, TracedFrame& frame, const Superseded& superseded,
                      const Publish& publish);

  const cli::CommonOptions common_;
  std::shared_ptr<cli::OpenScene> scene_;
  RenderOptions options_;
  std::unique_ptr<Renderer> renderer_;
  std::vector<std::string> editSettings_;  // of the scene as it is now
  Film band_;
  double msPerSample_ = 0;  // 0: nothing traced yet
};

}  // namespace whit::view
