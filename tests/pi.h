#pragma once

#include <numbers>

namespace whit {

inline constexpr double kPi = std::numbers::pi;

}  // namespace whit
