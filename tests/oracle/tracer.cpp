#include "oracle/tracer.h"

#include <numbers>

#include "oracle/optics.h"

namespace oracle {

namespace {

// Branches that count for less are left out: even hundreds of them show in no float.
constexpr double kNegligible = 1e-10;

// As a sine: a ray this near to the plane of a surface whose normals differ from the plane's is one
// that the surface may have to turn back.
constexpr double kSkimming = 0.011;

}  // namespace

// A point of a surface, everything turned to the side that the ray comes from.
struct Tracer::Surface {
  Vec position, toViewer;
  Vec plane, normal;  // unit: of the triangle, and interpolated
  Vec lift;           // from the triangle to the surface that its vertex normals stand for
  bool smooth = false, entering = false;
  Material material;  // textures and vertex colors applied
};

Tracer::Tracer(const Scene& scene, const Options& options)
    : scene_(scene), options_(options), geometry_(scene) {}

Sight Tracer::look(double x, double y) const {
  const Ray ray = eyeRay(x, y);
  Sight sight;
  sight.radiance = trace(ray, 0, 1, mediaAround(ray.origin), sight.undecided);
  return sight;
}

Ray Tracer::eyeRay(double x, double y) const {
  const Camera& camera = scene_.camera;
  const Vec forward = normalized(camera.at - camera.eye);
  const Vec right = normalized(cross(forward, camera.up)), up = cross(right, forward);
  const bool parallel = camera.orthographicHeight > 0;
  const double height =
      parallel ? camera.orthographicHeight : 2 * std::tan(camera.fov * std::numbers::pi / 360);
  const double pixel = height / scene_.height;
  const Vec aside =
      right * ((x - scene_.width / 2.0) * pixel) + up * ((scene_.height / 2.0 - y) * pixel);
  if (parallel) return {camera.eye + aside, forward};
  return {camera.eye, normalized(forward + aside)};
}

// A point is inside of what a ray from there leaves more often than it enters; what it leaves first
// it has entered last.
Media Tracer::mediaAround(const Vec& point) const {
  const Ray ray{point, normalized({-0.5377, 0.7161, -0.4453})};
  std::vector<Medium> left, entered;
  for (const Hit& hit : geometry_.all(ray)) {
    const Material& material = scene_.materials[static_cast<std::size_t>(hit.triangle->material)];
    if (!material.isDielectric()) continue;
    const Medium medium = mediumOf(material);
    if (dot(ray.direction, hit.triangle->outward) < 0) {
      entered.push_back(medium);
      continue;
    }
    const auto known = std::find(entered.begin(), entered.end(), medium);
    if (known == entered.end()) {
      left.push_back(medium);
    } else {
      entered.erase(known);
    }
  }
  Media media;
  for (auto medium = left.rbegin(); medium != left.rend(); ++medium) media.enter(*medium);
  return media;
}

Tracer::Surface Tracer::surfaceAt(const Ray& ray, const Hit& hit) const {
  const Triangle& triangle = *hit.triangle;
  Surface s;
  s.position = ray.origin + ray.direction * hit.t;
  s.toViewer = -ray.direction;
  s.entering = dot(ray.direction, triangle.outward) < 0;
  s.smooth = triangle.smooth;
  s.material = scene_.materials[static_cast<std::size_t>(triangle.material)];
  const double side = s.entering ? 1 : -1;
  s.plane = triangle.outward * side;
  s.normal = s.plane;
  Vec normal;
  Color color;
  double u = 0, v = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner& corner = triangle.corners[i];
    const double weight = hit.weights[i];
    color += corner.color * weight;
    u += corner.uv[0] * weight, v += corner.uv[1] * weight;
    if (!s.smooth) continue;
    normal += corner.normal * weight;
    // Hanika 2021: down to the tangent plane of each corner, weighed as the corners are.
    const Vec n = corner.normal * side;
    s.lift += n * (weight * std::max(0.0, -dot(s.position - corner.position, n)));
  }
  if (s.smooth) s.normal = normalized(normal) * side;
  s.material.diffuse = s.material.diffuse * color;
  const auto textured = [&](int map, Color& what) {
    if (map == kNone) return;
    const Texture& texture = scene_.textures[static_cast<std::size_t>(map)];
    what = what * textureAt(texture, u, v, options_.nearestTexel);
  };
  textured(s.material.diffuseMap, s.material.diffuse);
  textured(s.material.specularMap, s.material.specular);
  textured(s.material.emissionMap, s.material.emission);
  return s;
}

Color Tracer::trace(const Ray& ray, int depth, double weight, const Media& media,
                    double& undecided) const {
  if (weight < kNegligible) return {};
  const Color absorption = media.current().absorption;
  const std::optional<Hit> hit = geometry_.nearest(ray);
  if (!hit) return skyAlong(scene_.sky, ray.direction) * transmittance(absorption, INFINITY);
  const Color left = transmittance(absorption, hit->t);
  weight *= largest(left);

  const Surface surface = surfaceAt(ray, *hit);
  Media behind = media;
  if (surface.material.isDielectric()) {
    const Medium medium = mediumOf(surface.material);
    surface.entering ? behind.enter(medium) : behind.leave(medium);
    if (behind.current() == media.current()) {  // the surface is not there
      if (depth == options_.depth) return {};
      const Ray on{surface.position, ray.direction};
      return trace(on, depth + 1, weight, behind, undecided) * left;
    }
  }
  Color radiance =
      surface.material.emission +
      surface.material.diffuse * ambientAt(scene_.ambient, scene_.sky, surface.normal) +
      lightFrom(surface, weight, undecided);
  if (depth < options_.depth) {
    radiance += impulses(surface, depth, weight, media, behind, undecided);
  }
  return radiance * left;
}

Color Tracer::lightFrom(const Surface& surface, double weight, double& undecided) const {
  const Material& material = surface.material;
  Color sum;
  for (const Light& light : scene_.lights) {
    const Arrival arrival = arrivalOf(light, surface.position);
    const double cosine = dot(surface.normal, arrival.toLight);
    if (!(cosine > 0) || !(largest(arrival.irradiance) > 0)) continue;
    if (!lit(surface, arrival, light)) continue;
    Color reflected = material.diffuse / std::numbers::pi;
    if (largest(material.specular) > 0) {
      // The lobe has no value for a viewer behind it.
      if (dot(surface.normal, surface.toViewer) < kSkimming) {
        undecided += weight;
      } else {
        reflected += glossyLobe(material, surface.normal, surface.toViewer, arrival.toLight);
      }
    }
    sum += reflected * arrival.irradiance * cosine;
  }
  return sum;
}

// Light comes neither from behind the triangle nor through anything that casts shadows.
bool Tracer::lit(const Surface& surface, const Arrival& arrival, const Light& light) const {
  const bool lifted = options_.terminator && length(surface.lift) > 0;
  if (!lifted) {
    if (!(dot(surface.plane, arrival.toLight) > 0)) return false;
    return !geometry_.blocked({surface.position, arrival.toLight}, arrival.distance);
  }
  const Vec start = surface.position + surface.lift;
  const bool directional = light.kind == Light::Kind::directional;
  const Vec way = directional ? arrival.toLight : light.position - start;
  return !geometry_.blocked({start, normalized(way)}, directional ? INFINITY : length(way));
}

namespace {

// The coat comes first; what it leaves is the most that passes.
double leftBy(double coat, double largest) {
  return std::min(1.0, std::max(0.0, 1 - coat) / largest);
}

Color underCoat(const Color& transmission, const Color& coat) {
  const double most = largest(transmission);
  return transmission * Color{leftBy(coat.x, most), leftBy(coat.y, most), leftBy(coat.z, most)};
}

}  // namespace

Color Tracer::impulses(const Surface& surface, int depth, double weight, const Media& media,
                       const Media& behind, double& undecided) const {
  const Material& material = surface.material;
  const bool reflects = largest(material.mirror) > 0 || largest(material.mirrorGrazing) > 0;
  if (!reflects && !material.isDielectric()) return {};
  const Vec direction = -surface.toViewer;
  const double cosine = dot(surface.toViewer, surface.normal);
  if (surface.smooth && cosine < kSkimming) {
    undecided += weight;
    return {};
  }
  Color radiance;
  const Color coat = schlick(material.mirror, material.mirrorGrazing, cosine);
  Color reflectance = coat;
  if (material.isDielectric()) {
    const double n1 = media.current().ior, n2 = behind.current().ior;
    const double interface =
        options_.schlickFresnel ? fresnelBySchlick(n1, n2, cosine) : fresnel(n1, n2, cosine);
    reflectance += (gray(1) - coat) * interface;
    if (interface < 1) {
      const Ray on{surface.position, refracted(direction, surface.normal, n1, n2)};
      const Color passed = underCoat(material.transmission, coat) * (1 - interface);
      const double part = weight * largest(passed);
      if (surface.smooth && -dot(on.direction, surface.plane) < kSkimming) undecided += part;
      radiance += passed * trace(on, depth + 1, part, behind, undecided);
    }
  }
  if (largest(reflectance) > 0) {
    const Ray back{surface.position, mirrored(direction, surface.normal)};
    const double part = weight * largest(reflectance);
    if (surface.smooth && dot(back.direction, surface.plane) < kSkimming) undecided += part;
    radiance += reflectance * trace(back, depth + 1, part, media, undecided);
  }
  return radiance;
}

}  // namespace oracle
