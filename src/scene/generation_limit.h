// The limit of the memory that shapes and patterns take while they are made: a few words in a scene
// file can ask for terabytes.
#pragma once

#include <cstdint>
#include <limits>

#include "core/error.h"
#include "core/text.h"

namespace whit {

// While an object lives, everything that its thread generates takes at most `bytes`. Without one
// there is no limit.
class GenerationLimit {
 public:
  explicit GenerationLimit(std::uint64_t bytes) : before_(left_) { left_ = bytes; }
  ~GenerationLimit() { left_ = before_; }
  GenerationLimit(const GenerationLimit&) = delete;
  GenerationLimit& operator=(const GenerationLimit&) = delete;

  // Called before the memory is taken. Throws Error(limit) when count * size bytes do not fit.
  static void require(std::uint64_t count, std::uint64_t size) {
    if (count <= left_ / size) return;
    throwLimit(concat("a shape or a pattern needs more than the ", left_, " bytes that are left"));
  }
  static void charge(std::uint64_t count, std::uint64_t size) {
    require(count, size);
    left_ -= count * size;
  }

 private:
  inline static thread_local std::uint64_t left_ = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t before_;
};

}  // namespace whit
