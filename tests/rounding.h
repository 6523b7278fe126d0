#pragma once

namespace whit {

// Upper bound on the rounding error of formulas in double, for values up to a few hundred.
inline constexpr double kRounding = 1e-12;

}  // namespace whit
