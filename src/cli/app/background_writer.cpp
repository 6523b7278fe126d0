#include "cli/app/background_writer.h"

#include <memory>
#include <utility>

#include "cli/app/interrupt.h"
#include "core/stopwatch.h"

namespace whit::cli {

BackgroundWriter::~BackgroundWriter() {
  if (job_.valid()) job_.wait();
}

void BackgroundWriter::start(std::function<void()> write) {
  finish();
  // Opened here and not by the job: an interruption between the two would not know of the files.
  auto scope = std::make_unique<WriteScope>();
  job_ = std::async(std::launch::async,
                    [write = std::move(write), scope = std::move(scope)]() mutable {
                      const std::unique_ptr<WriteScope> held = std::move(scope);
                      const Stopwatch stopwatch;
                      write();
                      return stopwatch.ms();
                    });
}

void BackgroundWriter::finish() {
  if (!job_.valid()) return;
  const Stopwatch waiting;
  job_.wait();
  const double waitedMs = waiting.ms();
  times_.push_back({job_.get(), waitedMs});
}

}  // namespace whit::cli
