// The progress of a sweep: how far it has come, and how long it will still take.
#pragma once

#include <string>

#include "core/progress.h"
#include "core/stopwatch.h"

namespace whit::accuracy {

// Work is counted in whatever unit its steps agree on; time left follows from what has been done.
// While a step runs, it can itself report its fraction.
class Pace : public Progress {
 public:
  Pace(Progress* out, std::string subject) : out_(out), subject_(std::move(subject)) {}

  void plan(double work) { total_ += work; }
  void begin(const std::string& step, double work);
  void end();   // of the step that was begun
  void skip();  // instead of end(): the step turned out not to be needed
  void report(const std::string& phase, double fraction) override;
  double seconds() const { return stopwatch_.ms() / 1000; }  // since the start

 private:
  Progress* out_;
  std::string subject_, step_;
  double total_ = 0, done_ = 0, current_ = 0;
  Stopwatch stopwatch_;
};

// "sponza: depth=4, 35 s left"; no time while nothing is known.
std::string paceText(const std::string& subject, const std::string& step, double elapsedSeconds,
                     double fraction);

}  // namespace whit::accuracy
