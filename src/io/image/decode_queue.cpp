#include "io/image/decode_queue.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/worker_pool.h"

namespace whit {

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
    tasks_.push_back({std::move(task), nullptr});
  }
  wake_.notify_one();
}

void DecodeQueue::run(Task& task, std::unique_lock<std::mutex>& lock) {
  const bool isFirstRun = !std::exchange(task.failure, nullptr);
  bool again = false;
  lock.unlock();
  try {
    task.work();
  } catch (const Error& error) {
    task.failure = std::current_exception();
    again = isFirstRun && error.status() == ExitStatus::limit;
  } catch (...) {
    task.failure = std::current_exception();
  }
  lock.lock();
  if (again) return;
  task.work = nullptr;
  const double fraction = static_cast<double>(++ended_) / static_cast<double>(tasks_.size());
  lock.unlock();
  reportProgress(progress_, phase_, fraction);
  lock.lock();
}

void DecodeQueue::work() {
  std::unique_lock lock(mutex_);
  try {
    for (;;) {
      wake_.wait(lock, [&] { return closing_ || begun_ < tasks_.size(); });
      if (begun_ == tasks_.size()) return;
      run(tasks_[begun_++], lock);
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
  for (Task& task : tasks_) {
    if (task.work) run(task, lock);
  }
  for (const Task& task : tasks_) {
    if (task.failure) std::rethrow_exception(task.failure);
  }
}

}  // namespace whit
