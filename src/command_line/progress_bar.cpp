#include "command_line/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>

#include "core/stopwatch.h"
#include "core/text.h"

namespace whit::cli {

void printWarnings(const Warnings& warnings) {
  for (const auto& [kind, entry] : warnings.entries()) {
    std::fprintf(stderr, "whit: warning: %s (%s, first: %s)\n", printable(kind).c_str(),
                 counted(entry.count, "time").c_str(), printable(entry.first).c_str());
  }
}

namespace {

constexpr std::size_t kBarWidth = 20, kPhaseWidth = 30;
constexpr double kBetweenDrawingsMs = 50, kUntilTimeLeftMs = 1000;
constexpr double kLongestLeft = 1e8;  // seconds

class ProgressBar : public Progress {
 public:
  ~ProgressBar() override {
    if (drawn_) std::fputs("\r\x1b[K", stderr);
  }

  void report(const std::string& phase, double fraction) override {
    const std::lock_guard lock(mutex_);
    // Several workers may report out of order. A fraction far below the last one means that other
    // work has begun.
    if (!(fraction >= fraction_ / 2)) {
      sinceBegun_ = Stopwatch();
      fraction_ = 0;
    }
    fraction_ = std::max(fraction_, fraction);

    if (drawn_ && sinceDrawn_.ms() < kBetweenDrawingsMs) return;
    sinceDrawn_ = Stopwatch();
    drawn_ = true;

    const std::string text = progressText(phase, fraction) + timeLeft(sinceBegun_.ms(), fraction);
    std::fprintf(stderr, "\r%s\x1b[K", printable(text).c_str());
    std::fflush(stderr);
  }

 private:
  std::mutex mutex_;
  Stopwatch sinceDrawn_, sinceBegun_;
  double fraction_ = 0;
  bool drawn_ = false;
};

}  // namespace

std::string progressText(const std::string& phase, double fraction) {
  const double done = fraction > 0 ? std::min(fraction, 1.0) : 0.0;  // NaN too is no progress
  const auto filled = static_cast<std::size_t>(done * kBarWidth);
  return "[" + std::string(filled, '#') + std::string(kBarWidth - filled, '-') +
         formatted("] %3d %% ", static_cast<int>(done * 100)) + phase.substr(0, kPhaseWidth);
}

std::string timeLeft(double ms, double fraction) {
  if (!(ms >= kUntilTimeLeftMs) || !(fraction > 0) || !(fraction < 1)) return "";

  const double seconds = std::ceil(ms * (1 - fraction) / fraction / 1000);
  if (seconds >= kLongestLeft) return "";
  const int s = static_cast<int>(seconds);
  return s < 3600 ? formatted(", %d:%02d left", s / 60, s % 60)
                  : formatted(", %d:%02d:%02d left", s / 3600, s / 60 % 60, s % 60);
}

std::unique_ptr<Progress> makeProgressBar(const CommonOptions& common) {
  if (common.quiet || common.progress != "auto" || !isatty(STDERR_FILENO)) return nullptr;
  return std::make_unique<ProgressBar>();
}

}  // namespace whit::cli
