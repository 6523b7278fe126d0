// Three doubles: points, directions and colors of the oracle.
#pragma once

#include <algorithm>
#include <cmath>

namespace oracle {

struct Vec {
  double x = 0, y = 0, z = 0;
  bool operator==(const Vec&) const = default;
};
using Color = Vec;

inline Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator-(const Vec& a) { return {-a.x, -a.y, -a.z}; }
inline Vec operator*(const Vec& a, const Vec& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
inline Vec operator*(const Vec& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline Vec operator/(const Vec& a, double s) { return a * (1 / s); }
inline Vec& operator+=(Vec& a, const Vec& b) { return a = a + b; }

inline double dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Vec& a) { return std::sqrt(dot(a, a)); }
inline Vec normalized(const Vec& a) { return a / length(a); }
inline double largest(const Vec& a) { return std::max({a.x, a.y, a.z}); }
inline Vec magnitudes(const Vec& a) { return {std::abs(a.x), std::abs(a.y), std::abs(a.z)}; }
// f(x...), f(y...), f(z...): the same of each component.
template <typename Function, typename... Vectors>
Vec eachOf(const Function& f, const Vectors&... v) {
  return {f(v.x...), f(v.y...), f(v.z...)};
}
inline Color gray(double value) { return {value, value, value}; }

// What a file of floats makes of it: both sides then have the same number.
inline double asFloat(double value) { return static_cast<float>(value); }
inline Vec asFloat(const Vec& a) { return {asFloat(a.x), asFloat(a.y), asFloat(a.z)}; }

}  // namespace oracle
