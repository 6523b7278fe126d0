#include "io/decode_queue.h"

#include <algorithm>
#include <utility>

#include "core/worker_pool.h"

namespace whit {

DecodeQueue::DecodeQueue(int threads, Progress* progress, std::string phase)
    : progress_(progress), phase_(std::move(phase)) {
  const int count = threads > 0 ? threads : usableThreads();
  workerLimit_ = static_cast<std::size_t>(std::max(count, 1) - 1);
}

DecodeQueue::~DecodeQueue() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
    begun_ = tasks_.size();
  }
  wake_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void DecodeQueue::add(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    failures_.emplace_back();
  }
  if (workers_.size() < workerLimit_) workers_.emplace_back([this] { work(); });
  wake_.notify_one();
}

bool DecodeQueue::runOne(std::unique_lock<std::mutex>& lock) {
  if (begun_ >= tasks_.size()) return false;
  const std::size_t index = begun_++;
  const std::function<void()> task = std::move(tasks_[index]);
  lock.unlock();
  std::exception_ptr failure;
  try {
    task();
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  failures_[index] = failure;
  const double fraction = static_cast<double>(++ended_) / static_cast<double>(tasks_.size());
  done_.notify_all();
  lock.unlock();
  reportProgress(progress_, phase_, fraction);
  lock.lock();
  return true;
}

void DecodeQueue::work() {
  std::unique_lock lock(mutex_);
  while (!closing_) {
    if (!runOne(lock)) wake_.wait(lock, [&] { return closing_ || begun_ < tasks_.size(); });
  }
}

void DecodeQueue::finish() {
  std::unique_lock lock(mutex_);
  while (runOne(lock)) continue;
  done_.wait(lock, [&] { return ended_ == tasks_.size(); });
  for (const std::exception_ptr& failure : failures_) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace whit
