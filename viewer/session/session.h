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

#include "core/error.h"
#include "core/machine_limits.h"
#include "core/stopwatch.h"
#include "scene/motion.h"
#include "viewer/session/camera_control.h"
#include "viewer/session/frame_tracer.h"
#include "viewer/session/render_thread.h"
#include "viewer/session/resolution_control.h"
#include "viewer/session/scene_reader.h"
#include "viewer/session/verbs.h"
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

// What a click on the picture selects in the scene; kNoCounterpart: nothing.
struct Selection {
  std::size_t material = kNoCounterpart, light = kNoCounterpart;
};

// The instant of a scene that moves: it plays by the clock, or the user sets it.
struct Timeline {
  bool there = false;  // the scene moves
  double seconds = 0, length = 0;
  bool playing = false;
  std::vector<std::string> animations;  // to choose from; empty where there is one only
  std::string animation;                // the animation that plays

  // Goes on by that many seconds. Returns whether it was playing.
  bool step(double later);
  std::optional<double> time() const { return there ? std::optional(seconds) : std::nullopt; }
};

// Returns the size that a scene has by itself.
inline ImageSize sizeOf(const Scene& scene) { return {scene.width, scene.height}; }

// Returns the names of the shipped scenes, which are chosen from where no scene is named.
std::vector<std::string> shippedNames();

// Returns the timeline of a scene that was just read: at the instant's seconds if it has any,
// otherwise playing from 0.
Timeline timelineOf(const Scene& scene, const Instant& instant);

// Returns whether nothing but options differs from the view that was measured.
bool isMeasuredView(FrameRequest measured, const FrameRequest& request);

// ", within about 0.8 %": the standard error of a pixel, as SampleSums::relativeError() has it;
// empty where that is not known.
std::string errorText(double sampleError);
// "1/4, 16 samples": the share of the window's pixels a side, and the samples.
std::string sharpnessText(const FrameRequest& request);

// Cuts the line to the window, because huge coordinates are drawn wrongly. Returns whether any of
// it is left.
bool clip(ScreenLine& line, double width, double height);
// Returns the material that was hit and the light that adds most.
Selection select(const RayPick& pick);

// What the window and the page show, and what the user has chosen.
struct ViewState {
  std::shared_ptr<const OpenScene> scene;  // the scene of the frame shown
  std::string sceneName;                   // as on the command line
  RenderOptions options;
  DebugView view = DebugView::none;
  bool measures = false;  // the costs of options are being measured
  Timeline timeline;
  std::optional<std::size_t> followed;  // the scene's camera whose view is shown
  EditedScene edited;                   // with edits that are not traced yet
  Sky ownSky;                           // of the scene as it was read

  TracedFrame shown;
  std::optional<UnfinishedFrame> unfinished;  // is shown in place of the frame
  std::vector<KnobCost> costs;                // measured so far at the view of the last frame
  double pictureMs = 0;  // mean time between pictures in motion; 0: nothing moves
  bool sharp = false;    // the frame shown gets no finer
  RayPick rays;          // of the pixel that was clicked
  Selection selected;
  int selections = 0;  // number of clicks that have selected something

  std::string message;                          // empty when its time is over
  std::string error;                            // stays until it is dismissed or a scene is read
  int errors = 0;                               // number of errors so far
  ExitStatus status = ExitStatus::checkFailed;  // of a program that ends with the last error
};

// "1/4, 16 samples, 30 frames/s": what the picture has, and how often it changes.
std::string statusText(const ViewState& state);
// "whitted, 2 triangles ...; avx2, packets of 8, 4 threads".
std::string aboutText(const TracedFrame& frame);

class Session {
 public:
  // `onChange` is called on another thread whenever a frame, a scene or an error is to be fetched.
  // Without `scene` the session shows an empty one until another is opened.
  Session(const ViewOptions& options, const std::shared_ptr<OpenScene>& scene,
          std::function<void()> onChange);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  const ViewState& state() const { return state_; }
  static std::span<const Verb> verbs();

  // Does what the user asks for, as a message or in lines. Errors are shown.
  void act(const Message& message);
  void act(const std::string& lines);
  void fail(const std::string& error, ExitStatus status = ExitStatus::checkFailed);
  void say(const std::string& message, double seconds = kMessageSeconds);
  // The message, what is being read or traced, and why the picture is black; empty: nothing.
  std::string notice() const;
  // A scene is being read, or was read and no frame shows it yet.
  bool isReading() const { return reader_.busy() || coming_; }
  bool waitsForReader() const { return reader_.holds(); }  // at its end
  // Closes the error, or else gives up what is read; the scene stays as it is. Returns false if
  // there is neither.
  bool close();

  // The picture is shown in so many pixels, and in a window that is so high in the units of drags.
  // So many units of a drag make one point.
  void setWindow(const ImageSize& pixels, double height, double scale);
  // At rest no more samples than asked for: scripts compare pictures.
  void endSupersampling() { supersample_ = false; }
  // Sets the most pixels of pictures in motion that a link is good for.
  void limitPixels(double pixels) { resolution_.setMostPixels(pixels); }

  bool fetchFrame();  // returns whether there is something new to show
  // Moves on by that many seconds, and asks for the picture and the rays that are to be shown next.
  void advance(double seconds);
  bool isActive() const;  // something moves, or the picture is about to sharpen
  bool isBusy() const { return thread_.busy(); }
  bool isCommitted() const { return thread_.committed(); }  // no request is taken now
  double rate() const { return resolution_.rate(); }
  // Returns whether the present view is shown at full resolution with the samples asked for.
  bool isComplete() const;
  const Camera& camera() const { return control_.camera(); }
  bool orbits() const { return control_.orbits(); }
  void holdStill();  // pauses the animation and the flight, so that the picture sharpens

  // Returns the command that makes the view shown; of one that is not sharp yet, as it will be.
  std::string command() const;

  // True until a scene is open, in a session that began without one.
  bool choosesScene() const { return !hasScene_; }
  // Returns whether there is a picture of an open scene.
  bool showsScene() const { return hasScene_ && state_.shown.scene; }
  // Opens a shipped scene if none is open. This is the only file that users of the page can read.
  void openShipped(const std::string& name);
  // These are for users who may read and write files here.
  // The first scene is opened with all options of the command line.
  void open(const std::string& name);
  // Adds settings; `edited` is the scene with them.
  void edit(const std::vector<std::string>& settings, const EditedScene& edited);
  SavedScene saveScene();
  bool hasUnsavedEdits() const { return state_.edited.settings != savedSettings_; }

  static constexpr double kMessageSeconds = 4;

 private:
  // A state that undoing returns to.
  struct Past {
    std::vector<std::string> settings;
    std::string givenSky;
    RenderOptions options;
    bool operator==(const Past&) const = default;
  };

  Session(const ViewOptions& options, bool hasScene, const std::shared_ptr<OpenScene>& scene,
          std::function<void()> onChange);
  void drag(Drag& sum, const Message& message);
  void hold(const Message& message);
  CameraMotion takeMotion();
  void show(const Camera& camera);
  void jump(const Camera& camera);
  void jumpToNumber(std::size_t number);
  void fitView();
  void followCamera();
  void playOrPause();  // the animation, or else the flight along the camera path
  void setTime(double seconds);
  void chooseAnimation(const std::string& name);
  void expose(float step);
  void showNextView();
  void chooseView(const std::string& name);
  void changeOptions(const RenderOptions& options);
  void chooseOption(const std::string& name, const std::string& value);
  void chooseEffect(const std::string& name, bool on);
  void choosePreset(const std::string& name);
  void measure();
  void pick(double x, double y);  // a pixel of the window
  void lookFromAside();
  void forgetRays();
  void undo();
  void remember();
  Past present() const { return {state_.edited.settings, state_.edited.givenSky, state_.options}; }
  void takeBack();
  void watch(const std::string& scene);
  void load(const SceneChoice& choice);
  void reload();
  const Scene& scene() const { return state_.scene->scene; }
  RenderOptions viewOptions() const;
  void postEdit();
  bool moveCamera(const CameraMotion& motion, double seconds);
  bool play(double seconds);
  void flyPath(double seconds);
  void learnTimes();
  void rememberCosts();
  void askForFrame();
  bool supersamples() const;
  DebugView viewToTrace(bool still) const;
  FrameRequest movingRequest(const ImageSize& window);
  FrameRequest stillRequest(const ImageSize& window);
  FrameRequest requestFor(const Sharpness& sharpness, bool still) const;
  void followRays();
  void watchSceneFile();
  void readAgain(const std::string& animation);
  void showReadScene();
  void takeOptions(const Scene& last, bool elsewhere);
  bool followScene();
  void takeScene(bool elsewhere);
  void enterScene(const std::string& name, bool isFirst);

  const ViewOptions& options_;
  bool hasScene_;  // false: the empty scene is shown
  ViewState state_;
  SceneReader reader_;
  RenderThread thread_;
  CameraControl control_;
  ResolutionControl resolution_;
  bool supersample_ = true;
  ImageSize windowSize_;
  double windowHeight_ = 1, dragScale_ = 1;
  Drags drags_;
  CameraMotion held_;
  double heldSeconds_ = kHeldSeconds;  // time since `hold` was said
  double restSeconds_ = 0;             // time since something changed
  std::optional<double> pathTime_;     // the time on the camera path that is flown
  double messageSeconds_ = 0;          // time for which the message is still shown

  FrameRequest measuredFor_;              // of the costs
  std::optional<FrameRequest> stillFor_;  // the view that is being sharpened
  Stopwatch sincePicture_;
  std::optional<FrameRequest> asked_;
  std::optional<RayQuery> picked_, queried_;  // the user's pick, and the last query for it
  bool selects_ = false;                      // the next answer selects a material and a light

  std::string readAnimation_;                // animation of the scene that was read last
  std::string opening_;                      // name of another scene while it is read
  std::shared_ptr<const OpenScene> coming_;  // was read, and no frame shows it yet; or null
  std::string comingName_;                   // its name; empty: the scene shown was read again
  int reloads_ = 0, edits_ = 0;
  int readEdits_ = 0;                       // edits_ when the last reading began
  std::vector<std::string> readSettings_;   // with which the scene was read first
  std::vector<std::string> savedSettings_;  // that a file or the command line holds
  std::vector<Past> past_;                  // the present state is the last one
  double sinceEdit_ = 0;                    // seconds
  Box subject_;                             // of the scene
  std::filesystem::path sceneFile_;
  std::filesystem::file_time_type sceneFileTime_;

  // Keys are let go if it is not repeated that they are held.
  static constexpr double kHeldSeconds = 1;
};

}  // namespace whit::view
