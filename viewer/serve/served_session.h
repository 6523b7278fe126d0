// The viewer whose face is a page in a browser. All pages show the same view, and each may change
// it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "viewer/session/session.h"

namespace whit::serve {

using view::Message;

// A picture as pages show it, and what they write beside it, as JSON.
struct Shot {
  std::uint64_t number = 0;
  // The options, cameras and views of the scene; of no scene, those that can be chosen.
  std::shared_ptr<const std::string> tables;
  DisplayImage picture;
  bool exact = false;   // nothing moves and it gets no finer
  std::string live;     // changes from picture to picture: times, status, lines of rays
  std::string settled;  // changes when the user does something: options, effects, the ray tree
  std::uint64_t settledNumber = 0;
};

struct Download {
  std::string scene, bytes;
};

class ServedSession {
 public:
  // Wakes the loop; the tracing thread may outlive the rest of this object.
  struct Alarm {
    std::mutex mutex;
    std::condition_variable wake;
    bool rung = false;
    void ring();
    void wait(double seconds);
  };
  // Without `scene` pages choose among the shipped ones.
  ServedSession(const view::ViewOptions& options, const std::shared_ptr<OpenScene>& scene,
                std::shared_ptr<Alarm> alarm = std::make_shared<Alarm>());
  ~ServedSession();
  ServedSession(const ServedSession&) = delete;
  ServedSession& operator=(const ServedSession&) = delete;

  // The functions below may be called from any thread.

  // Takes what a user has done. Returns false if too much waits already.
  bool post(std::vector<Message> messages);
  // Returns the newest shot, or null; waits some time for one that is newer than `number`.
  std::shared_ptr<const Shot> wait(std::uint64_t number);
  // Changes the number of pages. Without any, pictures are traced for downloads only.
  void watch(int more);
  // Limits the pixels of pictures in motion to what the best link can carry.
  void limitPixels(double pixels) { mostPixels_ = pixels; }
  // Returns the file of the view at full resolution, an EXR or a PNG; no bytes if that takes too
  // long.
  Download download(bool exr);
  // Nobody waits any longer, and nothing more is traced.
  void quit();

 private:
  void loop();
  double waitSeconds() const;
  void step(double seconds);
  void serve(const Message& message);
  void resize(double width, double height, double pixelsForCss);
  void fitUpright();
  bool rests() const;
  void publish();
  Json tablesJson() const;
  Json liveJson() const;
  Json settledJson() const;

  const std::shared_ptr<Alarm> alarm_;
  view::Session session_;
  std::shared_ptr<const OpenScene> tabled_;   // the scene of tables_
  std::shared_ptr<const OpenScene> settled_;  // the scene whose settings were last written
  std::shared_ptr<const std::string> tables_;
  ImageSize size_;
  std::optional<Camera> upright_;  // the view that fits a narrow page
  std::size_t uprightFrom_ = 0;    // the scene's camera that was shown before
  bool isCameraChosen_ = false;    // a user has asked for a camera of the scene
  std::atomic<double> mostPixels_ = 1e9;
  bool changed_ = true;  // there is something to show
  bool said_ = false;    // the user has asked for something since the last shot
  bool wasSharp_ = false;
  std::string told_;     // the notice of the last shot
  std::string command_;  // makes the picture at rest

  std::mutex mutex_;  // guards the members below
  std::condition_variable fresh_;
  std::vector<Message> messages_;
  int downloads_ = 0;                               // number of downloads that wait for frame_
  std::shared_ptr<const view::TracedFrame> frame_;  // the view at full resolution
  std::shared_ptr<const Shot> shot_;
  int pages_ = 0;
  bool quit_ = false;
  std::thread loop_;
};

}  // namespace whit::serve
