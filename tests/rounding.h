#pragma once

namespace whit {

// What the formulas in double may be off by, for values up to a few hundred.
inline constexpr double kRounding = 1e-12;

}  // namespace whit
