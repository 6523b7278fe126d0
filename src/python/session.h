// A scene in Python with its renderer. Threads take turns at it.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "library/whit.h"
#include "python/call.h"

namespace whit::python {

// Names of options and their values, as on the command line.
using OptionTexts = std::vector<std::pair<std::string, std::string>>;

// A picture, and what its frame cost.
struct Picture {
  api::Image image;
  api::FrameStatistics statistics;
};

class Session {
 public:
  explicit Session(api::Scene scene) : renderer_(std::move(scene)) {}

  // Returns the answer of a question about the scene.
  template <typename Question>
  auto ask(const Question& question) {
    const Turn turn(*this);
    return question(renderer_.scene());
  }

  // The options hold for this frame alone. With `pathSeconds` it is seen from the camera's path.
  Picture render(const OptionTexts& options, std::optional<double> pathSeconds,
                 const py::object& progress);
  void setMember(const std::string& pointer, const std::string& json, const py::object& progress);
  void setTime(double seconds);
  void setTransform(const std::string& pointer, const std::array<double, 12>& rows);

 private:
  // Waits for other threads without the GIL, and for signals as well.
  class Turn {
   public:
    explicit Turn(Session& session);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    bool wait();
    Calls::Entry entry_;
    Session& session_;
  };
  void takeOptions(const OptionTexts& options);

  api::Renderer renderer_;
  std::optional<OptionTexts> options_ = OptionTexts();  // that the renderer has, if that is known
  std::timed_mutex turn_;
  std::atomic<std::thread::id> owner_;  // whose turn it is
};

}  // namespace whit::python
