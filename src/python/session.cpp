#include "python/session.h"

#include <chrono>

namespace whit::python {

Session::Turn::Turn(Session& session) : session_(session) {
  constexpr int kUsage = 2;
  if (session.owner_ == std::this_thread::get_id()) {
    raise(api::Error(kUsage, "the scene is in use: a progress function cannot ask it anything"));
  }
  while (!wait()) {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  session_.owner_ = std::this_thread::get_id();
}

Session::Turn::~Turn() {
  session_.owner_ = std::thread::id();
  session_.turn_.unlock();
}

bool Session::Turn::wait() {
  constexpr std::chrono::milliseconds kPatience{50};
  if (session_.turn_.try_lock()) return true;
  const py::gil_scoped_release noGil;
  return session_.turn_.try_lock_for(kPatience);
}

void Session::takeOptions(const OptionTexts& options) {
  if (options == options_) return;
  options_.reset();
  renderer_.reset();
  for (const auto& [name, value] : options) renderer_.set(name, value);
  options_ = options;
}

Picture Session::render(const OptionTexts& options, std::optional<double> pathSeconds,
                        const py::object& progress) {
  const Turn turn(*this);
  return call(progress, [&](const api::Progress& told) {
    takeOptions(options);
    renderer_.setProgress(told);
    Picture picture;
    if (pathSeconds) {
      renderer_.renderOnPath(*pathSeconds, picture.image);
    } else {
      renderer_.render(picture.image);
    }
    picture.statistics = renderer_.statistics();
    return picture;
  });
}

void Session::setMember(const std::string& pointer, const std::string& json,
                        const py::object& progress) {
  const Turn turn(*this);
  call(progress, [&](const api::Progress& told) {
    renderer_.setProgress(told);
    renderer_.setMember(pointer, json);
  });
}

void Session::setTime(double seconds) {
  const Turn turn(*this);
  call([&] { renderer_.setTime(seconds); });
}

void Session::setTransform(const std::string& pointer, const std::array<double, 12>& rows) {
  const Turn turn(*this);
  call([&] { renderer_.setTransform(pointer, rows); });
}

}  // namespace whit::python
