// Which SIMD target the kernels run on.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <mutex>
#include <string>

#include "hwy/targets.h"
#include "simd/kernels.h"

namespace whit::simd {

namespace {

struct TargetName {
  std::int64_t bit;
  const char* name;
};

// The best target comes first.
constexpr TargetName kTargetNames[] = {
    {HWY_AVX3_DL, "avx3_dl"},
    {HWY_AVX3, "avx3"},
    {HWY_AVX2, "avx2"},
    {HWY_SSE4, "sse4"},
    {HWY_SSSE3, "ssse3"},
    {HWY_NEON, "neon"},
    {HWY_EMU128, "scalar"},  // the baseline with Clang: four lanes of scalar code
    {HWY_SCALAR, "scalar"},
#ifdef HWY_SSE2
    {HWY_SSE2, "sse2"},
#endif
#ifdef HWY_NEON_WITHOUT_AES
    {HWY_NEON_WITHOUT_AES, "neon"},
#endif
};

constexpr std::int64_t namedTargets() {
  std::int64_t bits = 0;
  for (const TargetName& target : kTargetNames) bits |= target.bit;
  return bits;
}

static_assert((HWY_TARGETS & ~namedTargets()) == 0, "a compiled target has no name for --simd");

// The targets of this CPU, whichever target has been chosen since.
std::int64_t detectedTargets() {
  static const std::int64_t detected = [] {
    hwy::SetSupportedTargetsForTest(0);
    return (hwy::SupportedTargets() | HWY_STATIC_TARGET) & HWY_TARGETS;
  }();
  return detected;
}

void use(std::int64_t targets) {
  hwy::SetSupportedTargetsForTest(targets);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

}  // namespace

std::vector<std::string> availableTargets() {
  std::vector<std::string> names;
  for (const TargetName& target : kTargetNames) {
    if ((detectedTargets() & target.bit) != 0) names.emplace_back(target.name);
  }
  return names;
}

bool chooseTarget(const std::string& name) {
  static std::mutex mutex;
  static std::string chosen;
  const std::lock_guard lock(mutex);
  if (name == chosen) return true;  // others may be calling kernels

  const auto* const known = std::ranges::find_if(kTargetNames, [&](const TargetName& target) {
    return target.name == name && (detectedTargets() & target.bit) != 0;
  });
  if (name != "auto" && known == std::end(kTargetNames)) return false;

  use(name == "auto" ? 0 : known->bit);
  chosen = name;
  return true;
}

std::string chosenTarget() {
  const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
  for (const TargetName& target : kTargetNames) {
    if ((usable & target.bit) != 0) return target.name;
  }

  return "scalar";
}

}  // namespace whit::simd
