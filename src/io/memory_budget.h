// A budget of memory for the loading of a scene. Thread-safe, because textures are decoded in
// parallel.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

#include "core/error.h"
#include "core/text.h"

namespace whit {

class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t bytes) : limit_(bytes) {}

  // To be called before the memory is taken. Throws Error(limit) when count * size more bytes do
  // not fit. It waits for memory that others hold for a while, so a caller that holds some itself
  // uses MemoryHold.
  void charge(std::uint64_t count, std::uint64_t size, const std::string& what) {
    std::unique_lock lock(mutex_);
    givenBack_.wait(lock, [&] { return held_ == 0 || fits(count, size); });
    take(count, size, what);
  }

  std::uint64_t left() const {
    const std::lock_guard lock(mutex_);
    return limit_ - used_ - held_;
  }

  // A MemoryHold calls these two.
  void hold(std::uint64_t count, std::uint64_t size, const std::string& what) {
    const std::lock_guard lock(mutex_);
    take(count, size, what);
    used_ -= count * size;
    held_ += count * size;
  }

  void endHold(std::uint64_t bytes, std::uint64_t kept) {
    {
      const std::lock_guard lock(mutex_);
      held_ -= bytes;
      used_ += kept;
    }
    givenBack_.notify_all();
  }

 private:
  bool fits(std::uint64_t count, std::uint64_t size) const {
    return size == 0 || count <= (limit_ - used_ - held_) / size;
  }

  void take(std::uint64_t count, std::uint64_t size, const std::string& what) {
    if (!fits(count, size)) {
      throwLimit(concat(what, " needs ", count, " x ", size, " bytes, and ", limit_ - used_ - held_,
                        " of ", limit_, " are left (--max-memory)"));
    }

    used_ += count * size;
  }

  const std::uint64_t limit_;
  mutable std::mutex mutex_;
  std::condition_variable givenBack_;
  std::uint64_t used_ = 0, held_ = 0;  // together at most limit_
};

// Holds a part of a budget for as long as the object lives, unless it is kept. Without a budget
// nothing is counted.
class MemoryHold {
 public:
  MemoryHold() = default;

  // Does not wait, so that those who hold something cannot wait for each other: throws
  // Error(limit) at once where it does not fit.
  MemoryHold(MemoryBudget* budget, std::uint64_t count, std::uint64_t size,
             const std::string& what) {
    if (!budget) return;
    budget->hold(count, size, what);
    held_ = std::unique_ptr<MemoryBudget, GiveBack>(budget, GiveBack{count * size});
  }

  // Charges the budget for good with what was held.
  void keep() {
    const std::uint64_t bytes = held_.get_deleter().bytes;
    if (MemoryBudget* const budget = held_.release()) budget->endHold(bytes, bytes);
  }

 private:
  struct GiveBack {
    std::uint64_t bytes;

    void operator()(MemoryBudget* budget) const { budget->endHold(bytes, 0); }
  };

  std::unique_ptr<MemoryBudget, GiveBack> held_;
};

}  // namespace whit
