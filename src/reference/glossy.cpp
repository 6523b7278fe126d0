#include "reference/glossy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "reference/fresnel.h"
#include "reference/ray_origin.h"

namespace whit::reference {

namespace {

// Seen from nearer to the normal than this, as a sine, the plane of incidence is lost in rounding,
// and any other serves as well.
constexpr double kLeastSine = 0.01;

// Right-handed, z along the surface's normal, the view in the plane of x and z.
struct Frame {
  Vec3d x, y, z;
  double sine = 0;  // of the view to z
};

Frame frameOfIncidence(const Vec3d& n, const Vec3d& view) {
  const Vec3d along = view - n * dot(n, view);
  const double sine = length(along);
  const Vec3d axis = std::fabs(n.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d x = sine > kLeastSine ? along / sine : normalized(cross(n, axis));
  return {x, cross(n, x), n, sine};
}

}  // namespace

Vec3d visibleNormal(const Vec3d& view, double alpha, const UnitPoint& at) {
  const double u = static_cast<double>(at.u), v = static_cast<double>(at.v);
  // Of a unit sphere instead of the stretched one: facets that mirror the view into the cap above
  // the plane that it grazes.
  const Vec3d seen = normalized(Vec3d(view.x * alpha, view.y * alpha, view.z));
  const double fall = v * (1 + seen.z);  // how far below the pole
  const double radius = std::sqrt(std::max(0.0, fall * (2 - fall)));
  const Vec3d halfway{radius * std::cos(2 * std::numbers::pi * u) + seen.x,
                      radius * std::sin(2 * std::numbers::pi * u) + seen.y, (1 - v) * (1 + seen.z)};
  return normalized(Vec3d(halfway.x * alpha, halfway.y * alpha, halfway.z), {0, 0, 1});
}

int lobeRays(const Surfel& surfel, const LobeSampling& sampling) {
  return surfel.alpha > double{kSmoothAlpha} ? static_cast<int>(sampling.count) : 1;
}

Impulse glossyImpulse(const Surfel& s, MediaStack stack, const UnitPoint& at,
                      const ShadingChoices& choices) {
  const Frame frame = frameOfIncidence(s.shadingNormal, s.view);
  const double nv = std::max(dot(s.shadingNormal, s.view), 1e-4);
  const double alpha = s.alpha > double{kSmoothAlpha} ? s.alpha : 0, a2 = alpha * alpha;
  const Vec3d m = visibleNormal(normalized(Vec3d(frame.sine, 0, nv)), alpha, at);
  const Vec3d h = frame.x * m.x + frame.y * m.y + frame.z * m.z;
  const double vh = dot(s.view, h);
  const Vec3d mirrored = normalized(h * (2 * vh) - s.view);
  const double nl = dot(s.shadingNormal, mirrored);
  if (!(nl > 0)) return {};

  const double maskV = std::sqrt(nv * nv * (1 - a2) + a2),
               maskL = std::sqrt(nl * nl * (1 - a2) + a2);
  const double passes = nl * (nv + maskV) / (nl * maskV + nv * maskL);
  const RgbD f0 = s.specular, f90(std::min(1.0, 25 * maxComponent(f0)));
  const RgbD fresnel = f0 + (f90 - f0) * schlickTerm(std::clamp(vh, 0.0, 1.0));
  // Turned back by bent normals only: where both agree the ray is high enough as it is.
  const Vec3d r =
      choices.bend ? lifted(mirrored, s.geometricNormal, std::min(0.9 * nl, 0.01)) : mirrored;
  return {fresnel * passes, {rayOrigin(choices.offset, s, 1), r, s.cone}, stack};
}

}  // namespace whit::reference
