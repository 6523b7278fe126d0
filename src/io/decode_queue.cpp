#include "io/decode_queue.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/worker_pool.h"

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
  std::function<void()> task = std::move(tasks_[index]);
  lock.unlock();
  Outcome outcome = outcomeOf(task);
  lock.lock();
  if (outcome.limit) {
    tasks_[index] = std::move(task);
    postponed_.push_back(index);
    done_.notify_all();
  } else {
    end(index, outcome.failure, lock);
  }
  return true;
}

void DecodeQueue::end(std::size_t index, std::exception_ptr failure,
                      std::unique_lock<std::mutex>& lock) {
  failures_[index] = std::move(failure);
  const double fraction = static_cast<double>(++ended_) / static_cast<double>(tasks_.size());
  done_.notify_all();
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
  while (!closing_) {
    if (!runOne(lock)) wake_.wait(lock, [&] { return closing_ || begun_ < tasks_.size(); });
  }
}

void DecodeQueue::finish() {
  std::unique_lock lock(mutex_);
  while (runOne(lock)) continue;
  done_.wait(lock, [&] { return ended_ + postponed_.size() == tasks_.size(); });
  runAgain(lock);
  for (const std::exception_ptr& failure : failures_) {
    if (failure) std::rethrow_exception(failure);
  }
}

}  // namespace whit
