#include "render/contract_check.h"

#ifndef NDEBUG

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace whit {

namespace {

// Steps that are checked: the first ones of a process, and then one in so many: enough to meet
// every kind, few enough to cost little.
constexpr std::uint64_t kFirstChecks = 200, kInterval = 97;

constexpr std::array kChecked{Part::rays,     Part::hits,          Part::surfels,
                              Part::radiance, Part::unshadowed,    Part::shadows,
                              Part::children, Part::parentRadiance};

template <typename Columns>
std::uint64_t sumOf(const Columns& columns, std::size_t n) {
  std::uint64_t sum = 0xcbf29ce484222325u;  // FNV-1a, a word at a time
  Columns::forEachColumn(columns, [&](const char*, const auto* column, Feature) {
    for (std::size_t i = 0; column && i < n; ++i) {
      std::uint32_t word = 0;
      std::memcpy(&word, column + i, sizeof word);
      sum = (sum ^ word) * 0x100000001b3u;
    }
  });
  return sum;
}

}  // namespace

ContractCheck::ContractCheck(const Step& step, const Chunk& chunk) : step_(step), chunk_(chunk) {
  static std::atomic<std::uint64_t> steps{0};
  const std::uint64_t number = steps++;
  checks_ = number < kFirstChecks || number % kInterval == 0;
  if (checks_) before_ = sums();
}

ContractCheck::~ContractCheck() {
  if (!checks_) return;
  const Sums after = sums();
  for (std::size_t i = 0; i < kChecked.size(); ++i) {
    const bool appends = kChecked[i] == Part::children;
    if (after[i] == before_[i] || (step_.writes.has(kChecked[i]) && !appends)) continue;
    std::fprintf(stderr, "step %s has written into part %d, which its contract does not name\n",
                 step_.name.c_str(), static_cast<int>(kChecked[i]));
    std::abort();
  }
}

ContractCheck::Sums ContractCheck::sums() const {
  return {sumOf(chunk_.rays, chunk_.n),
          sumOf(chunk_.hits, chunk_.n),
          sumOf(chunk_.surfels, chunk_.n),
          sumOf(chunk_.radiance, chunk_.n),
          sumOf(chunk_.unshadowed, chunk_.n),
          sumOf(chunk_.shadows, chunk_.shadowCount),
          sumOf(chunk_.children, chunk_.childCount),
          chunk_.depth > 0 ? sumOf(chunk_.parentRadiance, 1) : 0};
}

}  // namespace whit

#endif
