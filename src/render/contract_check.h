// Holds steps to their contracts (stages/contract.h), in builds without NDEBUG: a step that writes
// into a part of its chunk that it does not name ends the program with a message.
#pragma once

#include <array>
#include <cstdint>

#include "render/plan.h"

namespace whit {

#ifdef NDEBUG

class ContractCheck {
 public:
  ContractCheck(const Step&, const Chunk&) {}
};

#else

class ContractCheck {
 public:
  ContractCheck(const Step& step, const Chunk& chunk);
  ~ContractCheck();
  ContractCheck(const ContractCheck&) = delete;
  ContractCheck& operator=(const ContractCheck&) = delete;

 private:
  // A checksum of what each part holds; of children, those that were there before the step.
  using Sums = std::array<std::uint64_t, 8>;
  Sums sums() const;

  const Step& step_;
  const Chunk chunk_;  // as it was before the step; columns are shared
  bool checks_;
  Sums before_{};
};

#endif

}  // namespace whit
