#include "io/image/decode_queue.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/usable_threads.h"

namespace whit {

namespace {

struct Outcome {
  std::exception_ptr failure;
  bool limit = false;
};

Outcome outcomeOf(const std::function<void()>& task) {
  try {
    task();
  } catch (const Error& error) {
    return {std::current_exception(), error.status() == ExitStatus::limit};
  } catch (...) {
    return {std::current_exception(), false};
  }
  return {};
}

}  // namespace

DecodeQueue::DecodeQueue(int threads, Progress* progress, std::string phase)
    : progress_(progress),
      phase_(std::move(phase)),
      threads_(std::max(threads > 0 ? threads : usableThreads(), 1)) {}

DecodeQueue::~DecodeQueue() {
  {
    const std::lock_guard lock(mutex_);
    begun_ = tasks_.size();
  }
  try {
    close();
  } catch (...) {  // thrown by the progress observer; the tasks are dropped anyway
    return;
  }
}

void DecodeQueue::add(std::function<void()> task) {
  if (!pool_) {
    pool_.emplace(threads_, Denormals::kept).begin(job_);
    running_ = true;
  }
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    failures_.emplace_back();
  }
  wake_.notify_one();
}

void DecodeQueue::runOne(std::unique_lock<std::mutex>& lock) {
  const std::size_t index = begun_++;
  std::function<void()> task = std::move(tasks_[index]);
  lock.unlock();
  Outcome outcome = outcomeOf(task);
  lock.lock();
  if (outcome.limit) {
    tasks_[index] = std::move(task);
    postponed_.push_back(index);
  } else {
    end(index, outcome.failure, lock);
  }
}

void DecodeQueue::end(std::size_t index, std::exception_ptr failure,
                      std::unique_lock<std::mutex>& lock) {
  failures_[index] = std::move(failure);
  const double fraction = static_cast<double>(++ended_) / static_cast<double>(tasks_.size());
  lock.unlock();
  reportProgress(progress_, phase_, fraction);
  lock.lock();
}

void DecodeQueue::runAgain(std::unique_lock<std::mutex>& lock) {
  std::vector<std::size_t> again;
  again.swap(postponed_);
  std::sort(again.begin(), again.end());
  for (const std::size_t index : again) {
    lock.unlock();
    Outcome outcome = outcomeOf(tasks_[index]);
    tasks_[index] = nullptr;
    lock.lock();
    end(index, outcome.failure, lock);
  }
}

void DecodeQueue::work() {
  std::unique_lock lock(mutex_);
  try {
    for (;;) {
      wake_.wait(lock, [&] { return closing_ || begun_ < tasks_.size(); });
      if (begun_ == tasks_.size()) return;
      runOne(lock);
    }
  } catch (...) {  // thrown by the progress observer to cancel the work
    if (!lock.owns_lock()) lock.lock();
    begun_ = tasks_.size();
    throw;
  }
}

void DecodeQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_all();
  if (std::exchange(running_, false)) pool_->finish();
}

void DecodeQueue::finish() {
  close();
  std::unique_lock lock(mutex_);
  runAgain(lock);
  for (const std::exception_ptr& failure : failures_) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace whit
