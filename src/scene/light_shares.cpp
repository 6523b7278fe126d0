#include "scene/light_shares.h"

#include <utility>

namespace whit {

void LightShare::saw(std::size_t light, bool visible) {
  if (light >= kSharedLights) return;
  (visible ? lit : dark) |= std::uint64_t{1} << light;
}

std::optional<bool> Lenders::visibility(std::size_t light) const {
  if (light >= kSharedLights) return std::nullopt;
  int lit = 0, dark = 0;
  for (int i = 0; i < count; ++i) {
    const LightShare& share = *shares[static_cast<std::size_t>(i)];
    lit += static_cast<int>(share.lit >> light & 1u);
    dark += static_cast<int>(share.dark >> light & 1u);
  }
  if ((lit > 0 && dark > 0) || lit + dark < kEnough) return std::nullopt;
  return lit > 0;
}

std::optional<Rgb> Lenders::impulses() const {
  if (count < kEnough) return std::nullopt;
  RgbD sum;
  for (int i = 0; i < count; ++i) sum += RgbD(shares[static_cast<std::size_t>(i)]->impulses);
  return Rgb(sum / static_cast<double>(count));
}

Lenders LightShares::lendersOf(int x, int y, const PixelSurface& surface) const {
  Lenders lenders;
  for (const auto& [dx, dy] :
       {std::pair(-1, 0), std::pair(1, 0), std::pair(0, -1), std::pair(0, 1)}) {
    if (!inside(x + dx, y + dy)) continue;
    const std::size_t i = index(x + dx, y + dy);
    if (!onSameSurface(surface, surfaces_[i])) continue;
    lenders.shares[static_cast<std::size_t>(lenders.count++)] = &shares_[i];
  }
  return lenders;
}

}  // namespace whit
