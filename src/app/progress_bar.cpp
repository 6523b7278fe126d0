#include "app/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <mutex>

namespace whit::cli {

namespace {

constexpr int kBarWidth = 20;
constexpr std::size_t kPhaseWidth = 30;
constexpr std::chrono::milliseconds kBetweenDrawings{50};

class ProgressBar : public Progress {
 public:
  ~ProgressBar() override {
    if (drawn_) std::fputs("\r\x1b[K", stderr);
  }

  void report(const std::string& phase, double fraction) override {
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (drawn_ && now - last_ < kBetweenDrawings) return;
    last_ = now;
    drawn_ = true;
    std::fprintf(stderr, "\r%s\x1b[K", progressText(phase, fraction).c_str());
    std::fflush(stderr);
  }

 private:
  std::mutex mutex_;
  std::chrono::steady_clock::time_point last_;
  bool drawn_ = false;
};

}  // namespace

std::string progressText(const std::string& phase, double fraction) {
  const double done = fraction > 0 ? std::min(fraction, 1.0) : 0.0;  // NaN too is no progress
  const int filled = static_cast<int>(done * kBarWidth);
  char percent[16];
  std::snprintf(percent, sizeof percent, "%3d %%", static_cast<int>(done * 100));
  return "[" + std::string(static_cast<std::size_t>(filled), '#') +
         std::string(static_cast<std::size_t>(kBarWidth - filled), '-') + "] " + percent + " " +
         phase.substr(0, kPhaseWidth);
}

std::unique_ptr<Progress> makeProgressBar(bool wanted) {
  if (!wanted || !isatty(STDERR_FILENO)) return nullptr;
  return std::make_unique<ProgressBar>();
}

}  // namespace whit::cli
