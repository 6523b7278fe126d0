// The viewer without its face: what the user looks at and has chosen, and the pictures that are
// asked for. The window of whit-view (../app.h) and the page of `whit serve` (../serve/) are its
// faces.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/stopwatch.h"
#include "viewer/session/camera_control.h"
#include "viewer/session/history.h"
#include "viewer/session/render_thread.h"
#include "viewer/session/resolution_control.h"
#include "viewer/session/scene_reader.h"
#include "viewer/session/verbs.h"
#include "viewer/session/view_files.h"
#include "viewer/session/view_options.h"
#include "viewer/session/view_state.h"

namespace whit::view {

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

// Returns the size that a scene has by itself.
inline ImageSize sizeOf(const Scene& scene) { return {scene.width, scene.height}; }

// Returns the names of the shipped scenes, which are chosen from where no scene is named.
std::vector<std::string> shippedNames();

// Returns whether nothing but options differs from the view that was measured.
bool isMeasuredView(FrameRequest measured, const FrameRequest& request);

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
  // True if the destructor would wait for a scene that is being read.
  bool waitsForReader() const { return reader_.holds(); }
  // Closes the error, or else gives up what is read; the scene stays as it is. Returns false if
  // there is neither.
  bool close();

  // Sets the size of the picture in pixels, the height of the window in units of drags, and the
  // number of those units in a point.
  void setWindow(const ImageSize& pixels, double height, double scale);
  // Ends that pictures at rest get more samples than asked for, because scripts compare pictures.
  void endSupersampling() { supersample_ = false; }
  // Limits the pixels of pictures in motion to what a link can carry.
  void limitPixels(double pixels) { resolution_.setMostPixels(pixels); }

  bool fetchFrame();  // returns whether there is something new to show
  // Moves on by the seconds that have passed, and asks for the picture and the rays that are to be
  // shown next.
  void advance(double elapsed);
  bool isActive() const;  // something moves, or the picture is about to sharpen
  bool isBusy() const { return thread_.busy(); }
  bool isCommitted() const { return thread_.committed(); }  // no request is taken now
  double rate() const { return resolution_.rate(); }
  // Returns whether the present view is shown at full resolution with the samples asked for.
  bool isComplete() const;
  const Camera& camera() const { return control_.camera(); }
  bool orbits() const { return control_.orbits(); }
  void holdStill();  // pauses the animation and the flight, so that the picture sharpens

  bool hasPick() const { return picked_.has_value(); }  // the rays of a pixel are shown, or will be

  // Returns the command that makes the view shown, as it will be when it is sharp.
  std::string command() const;

  // True until a scene is open, in a session that began without one.
  bool choosesScene() const { return !hasScene_; }
  // Returns whether there is a picture of an open scene.
  bool showsScene() const { return hasScene_ && state_.shown.scene; }
  // Opens a shipped scene if none is open. This is the only file that users of the page can read.
  void openShipped(const std::string& name);

  // The functions below are for users who may read and write files of this machine.

  // Opens a scene; the first one gets all options of the command line.
  void open(const std::string& name);
  // Adds settings; `edited` is the scene with them.
  void edit(const std::vector<std::string>& settings, const EditedScene& edited);
  SavedScene saveScene();
  bool hasUnsavedEdits() const { return state_.edited.settings != savedSettings_; }

  static constexpr double kMessageSeconds = 4;

 private:
  Session(const ViewOptions& options, bool hasScene, const std::shared_ptr<OpenScene>& scene,
          std::function<void()> onChange);

  // The camera, and the time of a scene that moves.
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
  bool moveCamera(const CameraMotion& motion, double seconds);
  bool play(double seconds);
  void flyPath(double seconds);

  // Options and views.
  void expose(float step);
  void showNextView();
  void chooseView(const std::string& name);
  void changeOptions(const RenderOptions& options);
  void chooseOption(const std::string& name, const std::string& value);
  void chooseEffect(const std::string& name, bool on);
  void choosePreset(const std::string& name);
  void measure();
  RenderOptions viewOptions() const;

  // The rays of a pixel.
  void pick(double x, double y);  // a pixel of the window
  void lookFromAside();
  void forgetRays();
  void followRays();

  // Edits of the scene.
  void undo();
  UserState present() const {
    return {state_.edited.settings, state_.edited.givenSky, state_.options};
  }
  void postEdit();

  // Pictures that are requested and fetched.
  void learnTimes();
  void rememberCosts();
  void askForFrame();
  bool supersamples() const;
  DebugView viewToTrace(bool still) const;
  FrameRequest movingRequest(const ImageSize& window);
  FrameRequest stillRequest(const ImageSize& window);
  FrameRequest requestFor(const Sharpness& sharpness, bool still) const;
  void takeTracingError();
  bool takeAnswers();

  // Scenes that are read and shown.
  const Scene& scene() const { return state_.scene->scene; }
  void watch(const std::string& scene);
  void load(const SceneChoice& choice);
  void reload();
  void watchSceneFile();
  void readAgain(const std::string& animation);
  void showReadScene();
  void takeOptions(const Scene& last, bool elsewhere);
  bool followScene();
  void takeScene(bool elsewhere);
  void followSize();
  void enterScene(const std::string& name, bool isFirst);

  const ViewOptions& options_;
  bool hasScene_;         // false: the empty scene is shown
  bool isFirst_ = false;  // the scene that is shown is the one of the command line
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
  double heldSeconds_ = kHeldSeconds;  // time since the last `hold`
  double restSeconds_ = 0;             // time since something changed
  std::optional<double> pathTime_;     // the time on the camera path that is flown
  double messageSeconds_ = 0;          // time for which the message is still shown

  FrameRequest measuredFor_;              // the view whose costs are shown
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
  std::vector<std::string> readSettings_;   // settings with which the scene was read first
  std::vector<std::string> savedSettings_;  // settings that a file or the command line holds
  History history_{UserState()};
  Box subject_;  // subjectOf() the scene
  std::filesystem::path sceneFile_;
  std::filesystem::file_time_type sceneFileTime_;

  // A key counts as let go if this time passes without a message that it is held.
  static constexpr double kHeldSeconds = 1;
};

}  // namespace whit::view
