// A budget of memory for the loading of a scene. Thread-safe, because textures are decoded in
// parallel.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>

#include "core/error.h"

namespace whit {

class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t bytes) : limit_(bytes) {}

  // Before the memory is taken: throws Error(limit) when count * size more bytes do not fit. What
  // others hold for a while is waited for; whoever holds something himself uses MemoryHold.
  void charge(std::uint64_t count, std::uint64_t size, const std::string& what) {
    std::unique_lock lock(mutex_);
    givenBack_.wait(lock, [&] { return held_ == 0 || fits(count, size); });
    take(count, size, what);
  }
  std::uint64_t left() const {
    const std::lock_guard lock(mutex_);
    return limit_ - used_ - held_;
  }

 private:
  friend class MemoryHold;

  bool fits(std::uint64_t count, std::uint64_t size) const {
    return size == 0 || count <= (limit_ - used_ - held_) / size;
  }
  void take(std::uint64_t count, std::uint64_t size, const std::string& what) {
    if (!fits(count, size)) {
      throwLimit(what + " needs " + std::to_string(count) + " x " + std::to_string(size) +
                 " bytes, and " + std::to_string(limit_ - used_ - held_) + " of " +
                 std::to_string(limit_) + " are left");
    }
    used_ += count * size;
  }

  const std::uint64_t limit_;
  mutable std::mutex mutex_;
  std::condition_variable givenBack_;
  std::uint64_t used_ = 0, held_ = 0;  // together at most limit_
};

// A part of a budget for as long as the object lives, unless it is kept. Without a budget nothing
// is counted.
class MemoryHold {
 public:
  MemoryHold() = default;
  // Does not wait, so that those who hold something cannot wait for each other: throws
  // Error(limit) at once where it does not fit.
  MemoryHold(MemoryBudget* budget, std::uint64_t count, std::uint64_t size, const std::string& what)
      : budget_(budget) {
    if (!budget) return;
    const std::lock_guard lock(budget->mutex_);
    budget->take(count, size, what);
    budget->used_ -= count * size;
    budget->held_ += bytes_ = count * size;
  }
  MemoryHold(MemoryHold&& other) noexcept
      : budget_(std::exchange(other.budget_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
  MemoryHold& operator=(MemoryHold&& other) noexcept {
    std::swap(budget_, other.budget_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~MemoryHold() { end(false); }

  // For good: what was held is now charged.
  void keep() { end(true); }

 private:
  void end(bool keep) {
    if (!budget_) return;
    {
      const std::lock_guard lock(budget_->mutex_);
      budget_->held_ -= bytes_;
      if (keep) budget_->used_ += bytes_;
    }
    budget_->givenBack_.notify_all();
    budget_ = nullptr;
  }

  MemoryBudget* budget_ = nullptr;
  std::uint64_t bytes_ = 0;
};

}  // namespace whit
