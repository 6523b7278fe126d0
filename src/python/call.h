// Calls the library from Python without the GIL, with progress and Control-C, and raises errors as
// whit.Error.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <string>
#include <thread>
#include <utility>

#include "library/whit.h"

namespace whit::python {

namespace py = pybind11;

// Raises whit.Error, as Python's current exception.
[[noreturn]] inline void raise(const api::Error& error) {
  const auto orNone = [](const std::string& text) -> py::object {
    if (text.empty()) return py::none();
    return py::str(text);
  };
  const py::object type = py::module_::import("whit._error").attr("Error");
  const py::object raised = type(error.what(), error.status(), orNone(error.file()),
                                 orNone(error.place()), orNone(error.expected()));
  PyErr_SetObject(type.ptr(), raised.ptr());
  throw py::error_already_set();
}

// Counts running calls, so that the interpreter can wait for them before it exits. A thread that
// returns to Python later would be terminated inside C++ code, which aborts the process.
class Calls {
 public:
  // One running call. It must be constructed with the GIL held.
  class Entry {
   public:
    Entry() {
      if (depth++ > 0) return;
      if (areEnding()) waitForTheEnd();
      ++underWay;
    }
    // The call must not return or raise into an interpreter that is shutting down.
    ~Entry() {
      if (--depth > 0) return;
      --underWay;
      if (areEnding()) waitForTheEnd();
    }
    Entry(const Entry&) = delete;
    Entry& operator=(const Entry&) = delete;
  };

  // True if the work of this thread must end.
  static bool areEnding() { return ending && std::this_thread::get_id() != ender; }
  // Ends all calls that report progress. `atexit` calls it.
  static void end() {
    constexpr std::chrono::milliseconds kStep{1};
    constexpr int kSteps = 10000;
    ender = std::this_thread::get_id();
    ending = true;
    const py::gil_scoped_release noGil;
    for (int i = 0; i < kSteps && underWay > 0; ++i) std::this_thread::sleep_for(kStep);
  }

 private:
  // Only daemon threads get here.
  [[noreturn]] static void waitForTheEnd() {
    const py::gil_scoped_release noGil;
    for (;;) std::this_thread::sleep_for(std::chrono::hours(1));
  }

  static inline std::atomic<int> underWay{0};
  static inline std::atomic<bool> ending{false};
  static inline std::thread::id ender;  // written before `ending`
  static inline thread_local int depth = 0;
};

// Receives the progress of a call. On the calling thread it handles Python's signals and calls the
// caller's progress function now and then.
class Onlooker {
 public:
  explicit Onlooker(py::object function) : function_(std::move(function)) {}

  bool operator()(const std::string& phase, double fraction) {
    if (Calls::areEnding()) return false;
    if (std::this_thread::get_id() != thread_ || !isTime()) return true;
    const py::gil_scoped_acquire gil;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (function_.is_none()) return true;
      const py::object answer = function_(phase, fraction);
      return answer.is_none() || answer.cast<bool>();
    } catch (...) {
      thrown_ = std::current_exception();
      return false;
    }
  }
  // Rethrows an exception that Python's own code has raised meanwhile.
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  using Clock = std::chrono::steady_clock;

  // Limits the rate, because each call acquires the GIL.
  bool isTime() {
    constexpr std::chrono::milliseconds kBetween{20};
    const Clock::time_point now = Clock::now();
    if (now - last_ < kBetween) return false;
    last_ = now;
    return true;
  }

  py::object function_;
  std::thread::id thread_ = std::this_thread::get_id();
  Clock::time_point last_ = Clock::now();
  std::exception_ptr thrown_;
};

// Calls `body` without the GIL, with a progress to report to, and returns its result.
template <typename Body>
auto call(const py::object& function, Body&& body) {
  const Calls::Entry entry;
  Onlooker onlooker(function);
  try {
    const py::gil_scoped_release noGil;
    return body([&onlooker](const std::string& phase, double fraction) {
      return onlooker(phase, fraction);
    });
  } catch (const api::Error& error) {
    onlooker.rethrow();
    raise(error);
  }
}

// Calls `body` with the GIL held, for work that takes no time.
template <typename Body>
auto call(Body&& body) {
  try {
    return body();
  } catch (const api::Error& error) {
    raise(error);
  }
}

}  // namespace whit::python
