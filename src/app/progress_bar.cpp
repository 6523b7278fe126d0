#include "app/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <mutex>

#include "core/formatted.h"
#include "core/printable.h"
#include "core/stopwatch.h"

namespace whit::cli {

namespace {

constexpr std::size_t kBarWidth = 20, kPhaseWidth = 30;
constexpr double kBetweenDrawingsMs = 50;

class ProgressBar : public Progress {
 public:
  ~ProgressBar() override {
    if (drawn_) std::fputs("\r\x1b[K", stderr);
  }

  void report(const std::string& phase, double fraction) override {
    const std::lock_guard lock(mutex_);
    if (drawn_ && sinceDrawn_.ms() < kBetweenDrawingsMs) return;
    sinceDrawn_ = Stopwatch();
    drawn_ = true;
    std::fprintf(stderr, "\r%s\x1b[K", printable(progressText(phase, fraction)).c_str());
    std::fflush(stderr);
  }

 private:
  std::mutex mutex_;
  Stopwatch sinceDrawn_;
  bool drawn_ = false;
};

}  // namespace

std::string progressText(const std::string& phase, double fraction) {
  const double done = fraction > 0 ? std::min(fraction, 1.0) : 0.0;  // NaN too is no progress
  const auto filled = static_cast<std::size_t>(done * kBarWidth);
  return "[" + std::string(filled, '#') + std::string(kBarWidth - filled, '-') +
         formatted("] %3d %% ", static_cast<int>(done * 100)) + phase.substr(0, kPhaseWidth);
}

std::unique_ptr<Progress> makeProgressBar(const CommonOptions& common) {
  if (common.quiet || common.progress != "auto" || !isatty(STDERR_FILENO)) return nullptr;
  return std::make_unique<ProgressBar>();
}

}  // namespace whit::cli
