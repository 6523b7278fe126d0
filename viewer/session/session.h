// The viewer without its face: what the user looks at and has chosen, and the pictures that are
// asked for. The window of whit-view (../app.h) and the page of `whit serve` (../serve/) are its
// faces.
#pragma once

#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/machine_limits.h"
#include "core/stopwatch.h"
#include "scene/motion.h"
#include "viewer/session/camera_control.h"
#include "viewer/session/frame_tracer.h"
#include "viewer/session/render_thread.h"
#include "viewer/session/resolution_control.h"
#include "viewer/session/scene_reader.h"
#include "viewer/session/view_files.h"

namespace whit::view {

// The options that the command lines of both faces have in common.
struct ViewOptions {
  cli::CommonOptions common;
  std::string scene;  // as on the command line
  DebugView view = DebugView::none;
  double rate = defaultRate(usableThreads());  // frames a second to hold in motion
};
void listViewOptions(cli::OptionList& list, ViewOptions& options);
inline constexpr OptionSpec kViewOption{.name = "view",
                                        .words =
                                            "none|depth|normals|albedo|rays|cost|occupancy|"
                                            "reference|difference"};
// Throws Error(usage) for options that a viewer cannot follow; the scene plays if it moves.
void settleViewOptions(ViewOptions& options);

// A length that the pointer was dragged, in pixels; y grows downwards.
struct Drag {
  double x = 0, y = 0;
  bool any() const { return x != 0 || y != 0; }
};
// Drags by button; with Shift the left one counts as the middle one. The wheel is in notches.
struct Drags {
  Drag left, right, middle;
  double wheel = 0;
};

// The view of the rays.
struct RayView {
  bool lines = true;                       // over the picture
  std::size_t pointedAt = kNoCounterpart;  // the node under the pointer, whose line stands out
  // The material that was hit and the light that adds most to it, which the scene's tab unfolds
  // once; kNoCounterpart: none.
  std::size_t material = kNoCounterpart, light = kNoCounterpart;
  bool fromAside = false;  // the camera is to see all rays
  bool forget = false;     // the rays are to go
};

// The instant of a scene that moves: it plays by the clock, or the user sets it.
struct Timeline {
  bool there = false;  // the scene moves
  double seconds = 0, length = 0;
  bool playing = false;
  std::vector<std::string> animations;  // to choose from; empty where there is one only
  std::string animation;                // the animation that plays
  bool another = false;                 // the animation was just chosen and is to be read

  // Goes on by that many seconds. Returns whether it was playing.
  bool step(double later);
  std::optional<double> time() const { return there ? std::optional(seconds) : std::nullopt; }
};

// Returns the timeline of a scene that was just read: at the instant's seconds if it has any,
// otherwise playing from 0.
Timeline timelineOf(const Scene& scene, const Instant& instant);

// The settings that the panel and the keys change.
struct PanelSettings : KeptSettings {
  bool words = true;               // anything is written or drawn over the picture
  bool supersample = true;         // at rest; scripts compare pictures without
  std::optional<float> keepClear;  // a place across the window that the panel must not cover
  std::string open;                // a scene to open
  std::string tab;                 // the tab of kPanelTabs to turn to; empty: it stays
  RenderOptions options;
  DebugView view = DebugView::none;
  bool measureKnobs = false;  // true until the measurement is done
  RayView rays;
  Timeline timeline;
  bool saveScene = false;  // the scene is to be saved
};

// Returns whether nothing but options differs from the view that was measured.
bool isMeasuredView(FrameRequest measured, const FrameRequest& request);

// ", within about 0.8 %": the standard error of a pixel, as SampleSums::relativeError() has it;
// empty where that is not known.
std::string errorText(double sampleError);
// "100 of 256 samples, within about 0.8 %": of a picture that gains samples.
std::string samplesText(const UnfinishedFrame& frame);
// "1/4, 16 samples": the share of the window's pixels a side, and the samples.
std::string sharpnessText(const FrameRequest& request);

// Cuts the line to the window, because huge coordinates are drawn wrongly. Returns whether any of
// it is left.
bool clip(ScreenLine& line, double width, double height);
// Lets the scene's tab unfold the material that was hit and the light that adds most.
void select(const RayPick& pick, RayView& view);

class Session {
 public:
  // `onChange` is called on another thread whenever a frame, a scene or an error is to be fetched.
  Session(const ViewOptions& options, const std::shared_ptr<OpenScene>& scene,
          std::function<void()> onChange);
  virtual ~Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

 protected:
  // The face shows an error, and has a picture of this size.
  virtual void fail(const std::string& error) = 0;
  virtual ImageSize windowPixels() const = 0;
  virtual void opened() {}  // another scene is shown

  void say(const std::string& message);
  // The message, what is being read or traced, and why the picture is black; empty: nothing.
  std::string notice() const;
  bool fetchFrame();  // returns whether there is something new to show
  // Moves on by that many seconds, and asks for the picture and the rays that are to be shown next.
  void advance(const CameraMotion& motion, double seconds);
  bool isActive() const;  // something moves, or the picture is about to sharpen
  // Returns whether the present view is shown at full resolution with the samples asked for.
  bool isComplete() const;
  void holdStill();  // pauses the animation and the flight, so that the picture sharpens

  // Adds what these drags ask for in a window of this height; `scale` pixels make one point.
  CameraMotion motionOf(const Drags& drags, double height, double scale,
                        CameraMotion motion = {}) const;
  void show(const Camera& camera);
  void jump(const Camera& camera);
  void jumpToNumber(std::size_t number);
  void fitView(const ImageSize& window);
  void followCamera();
  void playOrPause();  // the animation, or else the flight along the camera path
  void expose(float step);
  void showNextView();
  void pick(int x, int y);  // a pixel of the window
  void forgetRays();
  std::string command(const RenderOptions& options) const;
  RenderOptions viewOptions() const;
  void edit(const std::vector<std::string>& settings);
  void undoEdit();
  void watch(const std::string& scene);
  void load(const SceneChoice& choice);
  void reload();
  void changeAnimation();
  void open(const std::string& name);
  const Scene& scene() const { return scene_->scene; }

  const ViewOptions& options_;
  std::shared_ptr<const OpenScene> scene_;  // the scene of the frame shown
  std::string sceneName_;                   // as on the command line
  std::string opening_;                     // name of another scene while it is read
  SceneReader reader_;
  RenderThread thread_;
  CameraControl control_;
  ResolutionControl resolution_;
  PanelSettings settings_;
  TracedFrame shown_;
  std::vector<KnobCost> costs_;                // measured so far at the view of the last frame
  std::optional<UnfinishedFrame> unfinished_;  // is shown in place of the frame
  double pictureMs_ = 0;  // mean time between pictures in motion; 0: nothing moves
  RayPick rays_;          // the last answer
  EditedScene edited_;    // with edits that are not traced yet
  std::vector<std::string> savedSettings_;  // that a file or the command line holds
  std::optional<std::size_t> followed_;     // the scene's camera whose view is shown
  Sky ownSky_;                              // of the scene as it was read
  double restSeconds_ = 0;                  // time since something changed
  bool sharp_ = false;                      // the frame shown gets no finer
  std::optional<double> pathTime_;          // the time on the camera path that is flown
  std::string message_, error_;
  double messageSeconds_ = 0;  // time for which the message is still shown

 private:
  void postEdit();
  bool moveCamera(const CameraMotion& motion, double seconds);
  bool play(double seconds);
  void flyPath(double seconds);
  void rememberCosts();
  void askForFrame();
  bool supersamples() const;
  DebugView viewToTrace(bool still) const;
  FrameRequest movingRequest(const ImageSize& window);
  FrameRequest stillRequest(const ImageSize& window);
  FrameRequest requestFor(const Sharpness& sharpness, bool still) const;
  void followRays();
  void watchSceneFile();
  void showReadScene();
  void takeOptions(const Scene& last, bool elsewhere);
  void takeScene(bool elsewhere);

  FrameRequest measuredFor_;              // of costs_
  std::optional<FrameRequest> stillFor_;  // the view that is being sharpened
  ImageSize windowSize_;
  Stopwatch sincePicture_;
  std::optional<FrameRequest> asked_;
  std::optional<RayQuery> picked_, queried_;  // the user's pick, and the last query for it
  std::shared_ptr<const OpenScene> coming_;   // was read, and no frame shows it yet; or null
  int reloads_ = 0, edits_ = 0;
  std::vector<std::string> readSettings_;  // with which the scene was read
  bool selects_ = false;                   // the next answer selects a material and a light
  std::vector<EditedScene> undo_;          // the settings before each edit
  double sinceEdit_ = 0;                   // seconds
  Box subject_;                            // of the scene
  std::filesystem::path sceneFile_;
  std::filesystem::file_time_type sceneFileTime_;
};

}  // namespace whit::view
