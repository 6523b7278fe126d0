#include "oracle/optics.h"

#include <numbers>

#include "oracle/bilinear.h"

namespace oracle {

namespace {

constexpr double kPi = std::numbers::pi;

double clamped(double value) { return std::clamp(value, 0.0, 1.0); }

// Two unit vectors that are perpendicular to the normal and to each other.
std::array<Vec, 2> acrossTo(const Vec& normal) {
  const Vec other = std::abs(normal.y) < 0.7 ? Vec{0, 1, 0} : Vec{1, 0, 0};
  const Vec x = normalized(cross(other, normal));
  return {x, cross(normal, x)};
}

// The unit vector that is perpendicular to the normal and turned by this angle about it.
Vec aboutAxis(const Vec& normal, double turn) {
  const auto [x, y] = acrossTo(normal);
  return x * std::cos(turn) + y * std::sin(turn);
}

// Between the cones as glTF's KHR_lights_punctual has it.
double spotFalloff(const Light& light, const Vec& toLight) {
  const double cosine = -dot(normalized(light.direction), toLight);
  const double inner = std::cos(light.innerConeAngle * kPi / 180),
               outer = std::cos(light.outerConeAngle * kPi / 180);
  const double s = clamped((cosine - outer) / (inner - outer));
  return s * s;
}

}  // namespace

double fresnel(double n1, double n2, double cosine) {
  if (n1 == n2) return 0;
  const double sine2 = n1 / n2 * (n1 / n2) * (1 - cosine * cosine);  // of the refracted ray
  if (sine2 >= 1) return 1;

  const double behind = std::sqrt(1 - sine2);
  const double s = (n1 * cosine - n2 * behind) / (n1 * cosine + n2 * behind);
  const double p = (n1 * behind - n2 * cosine) / (n1 * behind + n2 * cosine);
  return (s * s + p * p) / 2;
}

double fresnelBySchlick(double n1, double n2, double cosine) {
  if (n1 == n2) return 0;
  const double sine2 = n1 / n2 * (n1 / n2) * (1 - cosine * cosine);
  if (sine2 >= 1) return 1;

  const double outside = n1 < n2 ? cosine : std::sqrt(1 - sine2);
  const double normal = (n1 - n2) / (n1 + n2) * ((n1 - n2) / (n1 + n2));
  return schlick(gray(normal), gray(1), outside).x;
}

Color schlick(const Color& normal, const Color& grazing, double cosine) {
  return mix(normal, grazing, std::pow(1 - cosine, 5));
}

Vec mirrored(const Vec& direction, const Vec& normal) {
  return direction - normal * (2 * dot(direction, normal));
}

Vec refracted(const Vec& direction, const Vec& normal, double n1, double n2) {
  const double cosine = -dot(direction, normal), eta = n1 / n2;
  const double behind = std::sqrt(1 - eta * eta * (1 - cosine * cosine));
  return normalized(direction * eta + normal * (eta * cosine - behind));
}

namespace {

double squaredAlpha(const Material& material) { return std::pow(material.roughness, 4); }

double smithLambda(const Material& material, double cosine) {
  const double tangent2 = 1 / (cosine * cosine) - 1;
  return (std::sqrt(1 + squaredAlpha(material) * tangent2) - 1) / 2;
}

// The share of facets that neither direction is masked from.
double masking(const Material& material, double nl, double nv) {
  return 1 / (1 + smithLambda(material, nl) + smithLambda(material, nv));
}

}  // namespace

double facetsFacing(const Material& material, double nh) {
  const double a2 = squaredAlpha(material), width = nh * nh * (a2 - 1) + 1;
  return a2 / (kPi * width * width);
}

double shareSeen(const Material& material, double nv) {
  return 1 / (1 + smithLambda(material, nv));
}

Vec facetSeen(const Material& material, const Vec& normal, const Vec& toViewer, double u,
              double v) {
  const double alpha = std::sqrt(squaredAlpha(material));
  const auto [x, y] = acrossTo(normal);

  // Where the facets make a hemisphere: a point of the disk that the view sees of it.
  const Vec view =
      normalized({alpha * dot(toViewer, x), alpha * dot(toViewer, y), dot(toViewer, normal)});
  const double aside = std::hypot(view.x, view.y);
  const Vec right = aside > 0 ? Vec{-view.y / aside, view.x / aside, 0} : Vec{1, 0, 0};
  const Vec up = cross(view, right);

  const double radius = std::sqrt(u), turn = 2 * kPi * v, across = radius * std::cos(turn);
  const double seen = (1 + view.z) / 2;
  const double along = (1 - seen) * std::sqrt(1 - across * across) + seen * radius * std::sin(turn);
  const double out = std::sqrt(std::max(0.0, 1 - across * across - along * along));

  // Back from the hemisphere to the facets as they are.
  const Vec facet = right * across + up * along + view * out;
  return normalized(x * (alpha * facet.x) + y * (alpha * facet.y) +
                    normal * std::max(0.0, facet.z));
}

Color lobeReflectance(const Material& material, double vh) {
  const double grazing = clamped(largest(material.specular) / 0.04);
  return schlick(material.specular, gray(grazing), vh);
}

Color glossyLobe(const Material& material, const Vec& normal, const Vec& toViewer,
                 const Vec& toLight) {
  const Vec half = normalized(toViewer + toLight);
  return lobeReflectance(material, dot(toViewer, half)) *
         facetLobe(material, normal, toViewer, toLight);
}

double facetLobe(const Material& material, const Vec& normal, const Vec& toViewer,
                 const Vec& toLight) {
  const Vec half = normalized(toViewer + toLight);
  const double nl = dot(normal, toLight), nv = dot(normal, toViewer), nh = dot(normal, half);
  return facetsFacing(material, nh) * masking(material, nl, nv) / (4 * nl * nv);
}

namespace {

// The facet that refracts one direction to the other, on the viewer's side.
Vec refractingFacet(double n1, double n2, const Vec& normal, const Vec& toViewer,
                    const Vec& toLight) {
  const Vec facet = normalized(toViewer * n1 + toLight * n2);
  return dot(facet, normal) > 0 ? facet : -facet;
}

}  // namespace

double transmittedLobe(const Material& material, double n1, double n2, const Vec& normal,
                       const Vec& toViewer, const Vec& toLight) {
  const Vec facet = refractingFacet(n1, n2, normal, toViewer, toLight);
  const double vh = dot(toViewer, facet), lh = -dot(toLight, facet);
  const double nv = dot(normal, toViewer), nl = -dot(normal, toLight), root = n1 * vh - n2 * lh;
  return vh * lh / (nv * nl) * n2 * n2 * shareSeen(material, nv) * shareSeen(material, nl) *
         facetsFacing(material, dot(normal, facet)) / (root * root);
}

double transmittedDensity(const Material& material, double n1, double n2, const Vec& normal,
                          const Vec& toViewer, const Vec& toLight) {
  const Vec facet = refractingFacet(n1, n2, normal, toViewer, toLight);
  const double vh = dot(toViewer, facet), lh = -dot(toLight, facet), nv = dot(normal, toViewer);
  const double seen =
      facetsFacing(material, dot(normal, facet)) * shareSeen(material, nv) * vh / nv;
  const double root = n1 * vh - n2 * lh;
  return seen * n2 * n2 * lh / (root * root);
}

// Half of the facets, on one side of the plane of incidence, evenly by D cos: the masked share of
// what they reflect, over what the surface shows of itself. Facets that reflect below the horizon
// are left out by the bounds of the inner integral, and the ends of the outer one are sampled more
// densely: the result is off by 0.003 at most, 0.001 from a cosine of 0.2 on.
Color lobeAlbedo(const Material& material, double nv) {
  constexpr int kTilts = 48, kTurns = 24;
  const double a2 = squaredAlpha(material), sine = std::sqrt(1 - nv * nv);
  Color sum;
  for (int i = 0; i < kTilts; ++i) {
    const double x = (i + 0.5) / kTilts, u = x * x * (3 - 2 * x), density = 6 * x * (1 - x);
    const double nh = std::sqrt((1 - u) / (1 + (a2 - 1) * u));
    const double aside = sine * std::sqrt(1 - nh * nh);

    // Where the reflected ray lies in the surface.
    const double limit = nv * (1 / (2 * nh) - nh);
    const double widest = std::acos(aside > 0 ? std::clamp(limit / aside, -1.0, 1.0) : -1.0);

    for (int k = 0; k < kTurns; ++k) {
      const double vh = aside * std::cos(widest * (k + 0.5) / kTurns) + nv * nh;
      const double nl = 2 * vh * nh - nv;
      if (!(vh > 0 && nl > 0)) continue;
      const double weight = density * widest / kPi * vh / (nv * nh) * masking(material, nl, nv);
      sum += lobeReflectance(material, vh) * weight;
    }
  }
  return sum / (kTilts * kTurns);
}

double mirroredShare(const Material& material) {
  return clamped((0.3 - material.roughness) / (0.3 - 0.05));
}

Arrival arrivalOf(const Light& light, const Vec& point) {
  if (light.kind == Light::Kind::directional) {
    return {light.intensity, -normalized(light.direction), INFINITY};
  }

  const Vec way = light.position - point;
  const double distance = length(way);
  Arrival arrival{{}, way / distance, distance};
  const double nearness = std::max(distance * distance, light.radius * light.radius);
  arrival.irradiance = light.intensity / nearness;

  if (light.kind == Light::Kind::spot) {
    arrival.irradiance = arrival.irradiance * spotFalloff(light, arrival.toLight);
  }
  return arrival;
}

LightSphere::LightSphere(const Light& light, const Vec& point) : light_(light) {
  const Vec way = light.position - point;
  distance_ = length(way);
  axis_ = way / distance_;
  widest_ = std::asin(light.radius / distance_);
}

LightSphere::Part LightSphere::partAt(double u, double v) const {
  const double angle = widest_ * u, radius = light_.radius;
  const Vec toLight = axis_ * std::cos(angle) + aboutAxis(axis_, 2 * kPi * v) * std::sin(angle);

  const double beside = distance_ * std::sin(angle);  // of the way, at the sphere's center
  const double inside = std::sqrt(std::max(0.0, radius * radius - beside * beside));
  const Color radiance = light_.intensity / (kPi * radius * radius);
  const double part = 2 * kPi * widest_ * std::sin(angle), cone = 2 * kPi * (1 - std::cos(widest_));
  const double falloff = light_.kind == Light::Kind::spot ? spotFalloff(light_, toLight) : 1;
  const double way = distance_ * std::cos(angle) - inside;
  return {{radiance * (part * falloff), toLight, way}, cone / part};
}

double LightSphere::largestSample(const Material& material, const Vec& normal,
                                  const Vec& toViewer) const {
  const double lowest = std::acos(std::clamp(dot(normal, axis_), -1.0, 1.0)) - widest_;
  const double cosine = std::cos(std::max(0.0, lowest)), nv = dot(normal, toViewer);
  if (!(cosine > 0)) return 0;

  double reflected = largest(material.diffuse) / kPi * cosine;
  if (largest(material.specular) > 0 && nv > 0) {
    // The light is masked from itself and from the viewer at least as much as by either alone.
    const double seen = std::min(shareSeen(material, nv), shareSeen(material, cosine));
    reflected += facetsFacing(material, 1) * seen / (4 * nv);
  }

  const double cone = 2 * kPi * (1 - std::cos(widest_));
  return reflected * cone * largest(light_.intensity) / (kPi * light_.radius * light_.radius);
}

Color skyAlong(const Sky& sky, const Vec& direction) {
  if (sky.kind == Sky::Kind::gradient) {  // linear in the sine of the elevation
    const Color& pole = direction.y > 0 ? sky.zenith : sky.ground;
    return mix(sky.horizon, pole, std::abs(direction.y)) * sky.scale;
  }

  // Equirectangular: the first column begins at -z, further ones lie towards +x. The image turned
  // about +y, right-handed, shows towards -x what it has at -z.
  const double angle = std::atan2(direction.x, -direction.z) / (2 * kPi) + sky.rotation / 360;
  const double polar = std::acos(std::clamp(direction.y, -1.0, 1.0)) / kPi;
  return bilinear(angle * sky.width, polar * sky.height,
                  [&](int x, int y) {
                    const int row = std::clamp(y, 0, sky.height - 1);
                    return sky.texels[row * sky.width + wrapped(x, sky.width)];
                  }) *
         sky.scale;
}

Color ambientAt(const Ambient& ambient, const Sky& sky, const Vec& normal) {
  const double up = (1 + normal.y) / 2;
  if (ambient.fromSky == 0) return mix(ambient.down, ambient.up, up);

  // Means over either hemisphere, weighed by the cosine c to its pole: that of c itself is the
  // integral of 2 c c over [0, 1].
  constexpr double kMeanCosine = 2.0 / 3;
  const Color above = mix(sky.horizon, sky.zenith, kMeanCosine),
              below = mix(sky.horizon, sky.ground, kMeanCosine);
  return mix(below, above, up) * (ambient.fromSky * sky.scale);
}

Vec cosineDirection(const Vec& normal, double u, double v) {
  return aboutAxis(normal, 2 * kPi * v) * std::sqrt(u) + normal * std::sqrt(1 - u);
}

Color transmittance(const Color& absorption, double distance) {
  const auto channel = [&](double sigma) { return sigma > 0 ? std::exp(-sigma * distance) : 1.0; };
  return eachOf(channel, absorption);
}

}  // namespace oracle
