#include "accuracy/pace.h"

#include <cmath>

namespace whit::accuracy {

std::string paceText(const std::string& subject, const std::string& step, double elapsedSeconds,
                     double fraction) {
  std::string text = subject;
  if (fraction > 0.01 && fraction <= 1) {
    const double left = elapsedSeconds * (1 - fraction) / fraction;
    text += " " + std::to_string(static_cast<long>(std::ceil(left))) + " s left";
  }
  return text + ": " + step;
}

void Pace::begin(const std::string& step, double work) {
  step_ = step;
  current_ = work;
  report("", 0);
}

void Pace::end() {
  done_ += current_;
  current_ = 0;
}

void Pace::skip() {
  total_ -= current_;
  current_ = 0;
}

void Pace::report(const std::string&, double fraction) {
  const double all = total_ > 0 ? (done_ + current_ * fraction) / total_ : 0;
  reportProgress(out_, paceText(subject_, step_, seconds(), all), all);
}

}  // namespace whit::accuracy
