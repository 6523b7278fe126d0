// Three-component vectors, for points, directions and linear RGB. Plain data; float in the scene
// and the kernels' tables, double in the reference. And boxes along the axes.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace whit {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <typename T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr Vec3() = default;
  constexpr Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  constexpr explicit Vec3(T s) : x(s), y(s), z(s) {}
  template <typename U>
  constexpr explicit Vec3(const Vec3<U>& v)
      : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}

  constexpr T& operator[](int i) {
    if (i == 0) return x;
    return i == 1 ? y : z;
  }
  constexpr const T& operator[](int i) const {
    if (i == 0) return x;
    return i == 1 ? y : z;
  }

  constexpr Vec3 operator-() const { return {-x, -y, -z}; }
  constexpr Vec3 operator+(const Vec3& b) const { return {x + b.x, y + b.y, z + b.z}; }
  constexpr Vec3 operator-(const Vec3& b) const { return {x - b.x, y - b.y, z - b.z}; }
  constexpr Vec3 operator*(const Vec3& b) const { return {x * b.x, y * b.y, z * b.z}; }
  constexpr Vec3 operator*(T s) const { return {x * s, y * s, z * s}; }
  constexpr Vec3 operator/(T s) const { return {x / s, y / s, z / s}; }
  constexpr Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
  constexpr Vec3& operator*=(T s) { return *this = *this * s; }
  constexpr bool operator==(const Vec3& b) const = default;
};

template <typename T>
constexpr Vec3<T> operator*(T s, const Vec3<T>& v) {
  return v * s;
}
template <typename T>
constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
T length(const Vec3<T>& v) {
  return std::sqrt(dot(v, v));
}
template <typename T>
constexpr T maxComponent(const Vec3<T>& v) {
  return std::max(v.x, std::max(v.y, v.z));
}
template <typename T>
constexpr Vec3<T> min(const Vec3<T>& a, const Vec3<T>& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
template <typename T>
constexpr Vec3<T> max(const Vec3<T>& a, const Vec3<T>& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
template <typename T>
constexpr Vec3<T> abs(const Vec3<T>& v) {
  return {std::max(v.x, -v.x), std::max(v.y, -v.y), std::max(v.z, -v.z)};
}
// The axis along which `v` is largest; of equal ones the first.
template <typename T>
constexpr int largestAxis(const Vec3<T>& v) {
  if (v.x >= v.y && v.x >= v.z) return 0;
  return v.y >= v.z ? 1 : 2;
}
template <typename T>
bool isFinite(const Vec3<T>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Unit vector along v; `fallback` when v is zero or not finite. Scales by a power of two of the
// largest component first, so that neither tiny nor huge vectors lose their direction.
template <typename T>
Vec3<T> normalized(const Vec3<T>& v, const Vec3<T>& fallback = {}) {
  const T largest = maxComponent(abs(v));
  if (!(largest > 0) || !isFinite(v)) return fallback;

  // Sizes whose squares are ordinary numbers too need no scaling, which would change no bit.
  if (largest > T(1e-9) && largest < T(1e9)) return v / length(v);

  int exponent = 0;
  std::frexp(largest, &exponent);
  const Vec3<T> scaled{std::ldexp(v.x, -exponent), std::ldexp(v.y, -exponent),
                       std::ldexp(v.z, -exponent)};

  return scaled / length(scaled);
}

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
using Rgb = Vec3<float>;  // linear, Rec. 709 primaries
using RgbD = Vec3<double>;

// Nothing of any color; NaN counts as nothing.
inline bool isBlack(const Rgb& c) { return !(maxComponent(c) > 0); }

struct Vec2f {
  float x = 0, y = 0;
  bool operator==(const Vec2f&) const = default;
};

// How bright a color looks (Rec. 709).
inline double luminance(const Rgb& c) {
  return 0.2126 * static_cast<double>(c.x) + 0.7152 * static_cast<double>(c.y) +
         0.0722 * static_cast<double>(c.z);
}

// A box along the axes, grown around points.
template <typename Vector>
struct BoxOf {
  using Limits = std::numeric_limits<decltype(Vector::x)>;
  Vector lower{Limits::max()}, upper{Limits::lowest()};

  bool empty() const { return !(lower.x <= upper.x); }
  void add(const Vector& p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  double diagonal() const { return length(Vec3d(upper) - Vec3d(lower)); }
  Vec3d center() const { return (Vec3d(lower) + Vec3d(upper)) * 0.5; }
  Vector half() const { return (upper - lower) * 0.5; }
  // Corner i of eight: bit k of `i` chooses the lower or the upper end of axis k.
  Vector corner(int i) const {
    const Vector ends[] = {lower, upper};
    return {ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2 & 1].z};
  }
};
using Box = BoxOf<Vec3f>;

}  // namespace whit
