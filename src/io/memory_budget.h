// How much a scene may take while it is loaded. Thread-safe, because textures are decoded in
// parallel.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "core/error.h"

namespace whit {

class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t bytes) : limit_(bytes) {}

  // Before the memory is taken: throws Error(limit) when count * size more bytes do not fit.
  void charge(std::uint64_t count, std::uint64_t size, const std::string& what) {
    const std::uint64_t room = left();
    if (size > 0 && count > room / size) {
      throwLimit(what + " needs " + std::to_string(count) + " x " + std::to_string(size) +
                 " bytes, and " + std::to_string(room) + " of " + std::to_string(limit_) +
                 " are left");
    }
    used_ += count * size;
  }
  std::uint64_t left() const {
    const std::uint64_t used = used_;
    return used < limit_ ? limit_ - used : 0;
  }

 private:
  std::uint64_t limit_;
  std::atomic<std::uint64_t> used_{0};
};

}  // namespace whit
