#include "oracle/tracer.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <numbers>

#include "oracle/geometry.h"
#include "oracle/integral.h"
#include "oracle/media.h"
#include "oracle/optics.h"
#include "oracle/placement.h"

namespace oracle {

namespace {

// Branches that count for less are left out: even hundreds of them show in no float.
constexpr double kNegligible = 1e-10;

// As a sine: a ray this near to the plane of a surface whose normals differ from the plane's is one
// that the surface may have to turn back.
constexpr double kSkimming = 0.011;
// The page states no error of the table of albedos for views within 3 degrees of the surface.
constexpr double kLeastTabled = 0.0523;

// A lobe of no more than this alpha is a mirror's.
constexpr double kSmooth = 1e-3;

// Along either side of the square that an integral is over: where whit takes many samples, where it
// takes one, and where a sample meets the next integral, of which the mean over many is right
// however few there are.
constexpr int kPointsASide = 12, kFewerPointsASide = 6, kFewestPointsASide = 2;

constexpr int Material::*kMaps[] = {&Material::diffuseMap, &Material::specularMap,
                                    &Material::emissionMap, &Material::normalMap,
                                    &Material::coverageMap};

// What is left of the surface on each texel of a map. A coverage map is a mean over what alpha
// leaves; every other map is weighed by the coverage besides.
Shares sharesLeft(const Scene& scene, const Material& material, int Material::*map) {
  const Texture& own = scene.textures[material.*map];
  const bool isCut = material.alphaMap != kNone, isCovered = material.coverageMap != kNone;
  if (!isCut && !isCovered) return {};

  const Shares uncut = isCut ? uncutShares(scene.textures[material.alphaMap], material.alphaCutoff)
                             : uncutShares(scene.textures[material.coverageMap], kClear);
  Shares left = stretched(uncut, own.width, own.height);
  if (!isCovered || map == &Material::coverageMap) return left;

  const Shares covered =
      stretched(coveredShares(scene.textures[material.coverageMap]), own.width, own.height);
  std::ranges::transform(left.of, covered.of, left.of.begin(), std::multiplies());
  return left;
}

// How much of texture space, of which a repeat is 1, a cone of this width covers: its section by
// the plane is longer than wide, and counts as if it were as wide as long (Akenine-Moeller et al.
// 2019, "Texture level of detail strategies for real-time ray tracing", section 20.3.4).
double footprintOf(const Hit& hit, double width, double cosine) {
  const double repeat = length(cross(hit.alongU, hit.alongV));  // in the world
  return repeat > 0 ? std::pow(width / cosine, 2) / repeat : 0;
}

// A normal map's: x along growing u, y along growing v, both turned into the plane of `normal`,
// which like the result is on the outside.
Vec mappedNormal(const Hit& hit, const Color& texel, const Vec& normal) {
  const Vec x = normalized(hit.alongU - normal * dot(hit.alongU, normal));
  Vec y = cross(normal, x);
  if (dot(y, hit.alongV) < 0) y = -y;
  return normalized(x * (2 * texel.x - 1) + y * (2 * texel.y - 1) + normal * (2 * texel.z - 1));
}

// The coat comes first; what it leaves is the most that passes. The color keeps its hue, but a
// channel for which the coat leaves more than the others need keeps more.
Color underCoat(const Color& color, const Color& coat) {
  const double most = largest(color);
  if (!(most > 0)) return {};

  const auto leftOf = [](double taken) { return std::max(0.0, 1 - taken); };
  const auto fits = [&](double own, double taken) {
    return own > leftOf(taken) ? leftOf(taken) / own : 1.0;
  };
  const Color fitting = eachOf(fits, color, coat);
  const double hueKept = std::min({fitting.x, fitting.y, fitting.z});

  const auto share = [&](double taken) {
    return std::min(1.0, std::max(hueKept, leftOf(taken) / most));
  };
  return color * eachOf(share, coat);
}

class Paths final : public Tracer {
 public:
  Paths(const Scene& scene, const Options& options)
      : scene_(atItsTime(scene)),
        options_(options),
        textures_(scene.textures.begin(), scene.textures.end()),
        geometry_(scene, textures_) {
    for (const Material& material : scene.materials) {
      for (const auto& map : kMaps) {
        const int number = material.*map;
        if (number == kNone) continue;
        shown_.emplace(std::pair(&material, &map),
                       MipChain(scene.textures[number], sharesLeft(scene, material, map)));
      }
    }
  }

  Sight look(double x, double y) const override {
    const Ray ray = eyeRay(x, y);
    Random random(static_cast<std::uint32_t>(std::floor(y) * scene_.width + std::floor(x)));
    return trace(ray, branchAt(ray, random));
  }

  Color sample(int x, int y, Random& random) const override {
    const double right = random.between(0, 1), down = random.between(0, 1);
    const Ray ray = throughLens(eyeRay(x + right, y + down), random);
    Branch branch = branchAt(ray, random);
    branch.drawn = true;
    return trace(ray, branch).radiance;
  }

  const Face* nearest(double x, double y) const override {
    const std::optional<Meeting> meeting = geometry_.nearest(eyeRay(x, y));
    return meeting ? meeting->hit.face : nullptr;
  }

 private:
  // Where a ray is in the tree of them.
  struct Branch {
    Random& random;
    double width;  // of the cone about the ray, where it starts
    Media media;
    bool drawn = false;  // of each integral one point
    int depth = 0;
    double weight = 1;     // of the pixel
    bool sampled = false;  // one of many of its kind
  };

  // A point of a surface, everything turned to the side that the ray comes from.
  struct Surface {
    Vec position, toViewer;
    Vec plane, normal;  // unit: of the face, and interpolated
    Vec lift;           // from a triangle to the surface that its vertex normals stand for
    bool smooth = false, entering = false;
    Material material;          // textures and vertex colors applied
    Color belowLobe = gray(1);  // of the light, what the glossy lobe leaves
    bool tabled = false;        // whit looks the lobe's albedo up
    // Frosted glass: the facets of an interface reflect and refract, those of a sheet scatter what
    // goes straight on.
    bool roughInterface = false, roughSheet = false;
    double n1 = 1, n2 = 1;  // indices in front and behind, where it is frosted
  };

  struct Impulse {
    Vec direction;
    Color part;
    Media media;
    double height;         // sine over the plane, on its side
    bool sampled = false;  // one of the many points of an integral
  };

  // Calls visit(u, v) for points of the unit square, as many as the branch's integrals have.
  template <typename Visit>
  static void forEvenPoints(const Branch& branch, const Visit& visit) {
    int side = branch.depth == 0 ? kPointsASide : kFewerPointsASide;
    if (branch.sampled) side = kFewestPointsASide;
    if (branch.drawn) side = 1;
    oracle::forEvenPoints(side, branch.random, visit);
  }

  Branch branchAt(const Ray& ray, Random& random) const {
    const double width = scene_.camera.orthographicHeight > 0 ? pixelSize() : 0;
    return {random, width, mediaAround(ray.origin)};
  }

  // From a point of the lens to where the ray from its center meets the plane in focus.
  Ray throughLens(const Ray& ray, Random& random) const {
    const Camera& camera = scene_.camera;
    if (!(camera.aperture > 0)) return ray;

    const Vec forward = normalized(camera.at - camera.eye);
    const Vec right = normalized(cross(forward, camera.up)), up = cross(right, forward);
    const double focus = camera.focus > 0 ? camera.focus : length(camera.at - camera.eye);
    const Vec sharp = ray.origin + ray.direction * (focus / dot(ray.direction, forward));

    // A random point of the lens.
    const double radius = camera.aperture * std::sqrt(random.between(0, 1));
    const double turn = random.between(0, 2 * std::numbers::pi);
    const Vec start = ray.origin + (right * std::cos(turn) + up * std::sin(turn)) * radius;
    return {start, normalized(sharp - start)};
  }

  double pixelSize() const {
    const Camera& camera = scene_.camera;
    const double height = camera.orthographicHeight > 0
                              ? camera.orthographicHeight
                              : 2 * std::tan(camera.fov * std::numbers::pi / 360);
    return height / scene_.height;
  }

  // Cones about the rays of an eye grow with all of the way, past mirrors and through glass as
  // well.
  double widthAfter(double width, double way) const {
    return scene_.camera.orthographicHeight > 0 ? width : width + way * pixelSize();
  }

  Ray eyeRay(double x, double y) const {
    const Camera& camera = scene_.camera;
    const Vec forward = normalized(camera.at - camera.eye);
    const Vec right = normalized(cross(forward, camera.up)), up = cross(right, forward);
    const bool parallel = camera.orthographicHeight > 0;
    const double pixel = pixelSize();
    const Vec aside =
        right * ((x - scene_.width / 2.0) * pixel) + up * ((scene_.height / 2.0 - y) * pixel);
    if (parallel) return {camera.eye + aside, forward};
    return {camera.eye, normalized(forward + aside)};
  }

  // A point is inside of what a ray from there leaves more often than it enters; what it leaves
  // first it has entered last.
  Media mediaAround(const Vec& point) const {
    const Ray ray{point, normalized({-0.5377, 0.7161, -0.4453})};
    std::vector<Medium> left, entered;
    for (const Hit& hit : geometry_.all(ray)) {
      if (!hit.face->material->isDielectric()) continue;
      const Medium medium = mediumOf(*hit.face->material);
      if (dot(ray.direction, hit.outward) < 0) {
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

  // What a triangle's vertices say of the surface between them. A sphere is the surface.
  static void addVertices(Surface& s, const Hit& hit) {
    if (hit.triangle == nullptr) return;
    s.smooth = hit.triangle->smooth;
    const double side = s.entering ? 1 : -1;

    Vec normal;
    Color color;
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner& corner = hit.triangle->corners[i];
      const double weight = hit.weights[i];
      color += corner.color * weight;
      if (!s.smooth) continue;
      normal += corner.normal * weight;
      // Hanika 2021: down to the tangent plane of each corner, weighed as the corners are.
      const Vec n = corner.normal * side;
      s.lift += n * (weight * std::max(0.0, -dot(s.position - corner.position, n)));
    }

    if (s.smooth) s.normal = normalized(normal) * side;
    s.material.diffuse = s.material.diffuse * color;
  }

  Surface surfaceAt(const Ray& ray, const Hit& hit, double width) const {
    Surface s;
    s.position = ray.origin + ray.direction * hit.t;
    s.toViewer = -ray.direction;
    s.entering = dot(ray.direction, hit.outward) < 0;
    s.material = *hit.face->material;
    const double side = s.entering ? 1 : -1;
    s.plane = hit.outward * side;
    s.normal = s.plane;
    addVertices(s, hit);

    // The footprint chooses the mip level of a trilinear lookup.
    const double footprint = footprintOf(hit, width, -dot(ray.direction, s.plane));
    const auto texel = [&](int Material::*map) {
      const Texture& texture = scene_.textures[s.material.*map];
      const double texels = footprint * texture.width * texture.height;
      return shown_.at({hit.face->material, std::ranges::find(kMaps, map)})
          .at(hit.uv[0], hit.uv[1], options_.filter, texels);
    };
    const auto textured = [&](int Material::*map, Color& what) {
      if (s.material.*map != kNone) what = what * texel(map);
    };

    textured(&Material::diffuseMap, s.material.diffuse);
    textured(&Material::specularMap, s.material.specular);
    textured(&Material::emissionMap, s.material.emission);
    if (s.material.coverageMap != kNone) s.material.coverage *= texel(&Material::coverageMap).x;
    if (s.material.normalMap != kNone) {
      s.normal = mappedNormal(hit, texel(&Material::normalMap), s.normal * side) * side;
      s.smooth = true;
    }
    return s;
  }

  void pass(Media& media, const Ray& ray, const Hit& hit) const {
    const Medium medium = mediumOf(*hit.face->material);
    if (dot(ray.direction, hit.outward) < 0) {
      media.enter(medium);
    } else {
      media.leave(medium);
    }
  }

  // A surface sends on no more light than it gets: the diffuse color has what the coat, the
  // interface and what passes leave.
  Color diffuseLeft(const Surface& surface, const Media& before, const Media& behind) const {
    const Material& material = surface.material;
    const double cosine = std::clamp(dot(surface.toViewer, surface.normal), 0.0, 1.0);
    const Color coat = schlick(material.mirror, material.mirrorGrazing, cosine);
    if (!material.passesLight()) return underCoat(material.diffuse, coat);

    const double n1 = before.current().ior, n2 = behind.current().ior;
    const double interface = surface.roughInterface ? 0 : interfaceReflectance(n1, n2, cosine);
    const Color through = underCoat(material.transmission, coat);
    return underCoat(material.diffuse, coat + through) * (1 - interface);
  }

  // Mirror and interface come before the glossy lobe.
  Color aboveLobe(const Surface& surface, const Media& before, const Media& behind) const {
    const Material& material = surface.material;
    const double cosine = std::clamp(dot(surface.toViewer, surface.normal), 0.0, 1.0);
    const Color left = gray(1) - schlick(material.mirror, material.mirrorGrazing, cosine);
    if (!material.passesLight() || surface.roughInterface) return left;
    return left * (1 - interfaceReflectance(before.current().ior, behind.current().ior, cosine));
  }

  double interfaceReflectance(double n1, double n2, double cosine) const {
    const auto reflectance = options_.schlickFresnel ? fresnelBySchlick : fresnel;
    return reflectance(n1, n2, cosine);
  }

  // Where samples are taken of lobes. A sheet on a solid's face is clear, and so is a surface
  // between equal indices.
  void findFrosting(Surface& surface, const Media& before, const Media& behind) const {
    const Material& m = surface.material;
    const bool isRough = m.frosted && m.transmits() && m.roughness * m.roughness > kSmooth;
    if (options_.lobeSamples() == 0 || !isRough) return;

    surface.n1 = before.current().ior;
    surface.n2 = behind.current().ior;
    // Where both indices are equal, an interface is as clear as if it were smooth.
    surface.roughInterface = m.isDielectric() && surface.n1 != surface.n2;
    surface.roughSheet = !m.isDielectric() && surface.n1 == surface.n2;
  }

  Color facetReflectance(const Surface& surface, double vh) const {
    if (!surface.roughInterface) return lobeReflectance(surface.material, vh);
    return gray(interfaceReflectance(surface.n1, surface.n2, vh));
  }

  Sight trace(const Ray& ray, const Branch& branch) const {
    if (branch.weight < kNegligible) return {};

    const Color absorption = branch.media.current().absorption;
    const std::optional<Meeting> meeting = geometry_.nearest(ray);
    if (!meeting) {
      const Color left = transmittance(absorption, INFINITY);
      const Color sky = skyAlong(scene_.sky, ray.direction) * left;
      return {.radiance = sky, .brightest = largest(sky)};
    }

    const Color left = transmittance(absorption, meeting->hit.t);
    Branch there = branch;
    there.weight *= largest(left);
    there.width = widthAfter(branch.width, meeting->hit.t);

    Surface surface = surfaceAt(ray, meeting->hit, there.width);

    Media behind = branch.media;
    const bool isDielectric = surface.material.isDielectric();
    if (isDielectric) pass(behind, ray, meeting->hit);
    for (const Hit& other : meeting->alsoCrossed) pass(behind, ray, other);

    if (isDielectric && behind.current() == branch.media.current()) {  // the surface is not there
      if (branch.depth == options_.depth) return {};
      ++there.depth;
      there.media = behind;
      return trace({surface.position, ray.direction}, there) * left;
    }

    // What the glossy lobe reflects, the diffuse color does not get.
    findFrosting(surface, branch.media, behind);
    const Sight taken = lobeWeight(surface, there);
    const bool isSampled = samplesLobe(surface.material) || surface.roughInterface;
    surface.belowLobe = gray(1) - taken.radiance;
    surface.tabled = largest(taken.radiance) > 0 && !isSampled;
    surface.material.diffuse = diffuseLeft(surface, branch.media, behind) * surface.belowLobe;

    // Light that arrives without further surfaces between.
    Sight seen = lightFrom(surface, there);
    seen.radiance += surface.material.emission;
    const bool indirectly = options_.indirect > 0 && surface.material.diffuseReflection;
    if (!indirectly) seen += ambientLight(surface, there);

    // What whit takes from the diffuse color varies with its samples, and together with what these
    // bring: the square of a sum of two is at most twice the sum of the squares, and of three,
    // where frosted glass transmits samples of the same facets, three times.
    const Color together = gray(surface.roughInterface || surface.roughSheet ? 3 : 2);
    const auto grows = [](double left) { return 1 / std::max(left, 0.01); };
    const Color below = surface.belowLobe;
    if (surface.tabled) {
      const double left = std::min({below.x, below.y, below.z});
      seen.tabled += largest(seen.radiance) * grows(left);
    }
    Sight varies = taken * (seen.radiance * eachOf(grows, below));
    varies.radiance = {};
    varies.variance = varies.variance * together;
    seen += varies;
    seen.undecided += taken.undecided;

    // Light that arrives from other surfaces.
    Sight on;
    if (there.depth < options_.depth) {
      on = impulses(surface, there, behind);
      if (indirectly) seen += indirectLight(surface, there);
      Sight sampled = glossyReflection(surface, there);
      sampled.variance = sampled.variance * together;
      seen += sampled * aboveLobe(surface, branch.media, behind);
      Sight frosted = frostedTransmission(surface, there, behind);
      frosted.variance = frosted.variance * together;
      seen += frosted;
    }

    seen = seen * gray(surface.material.coverage) + on;
    seen = seen * left;
    seen.brightest = std::max(seen.brightest, largest(seen.radiance));
    return seen;
  }

  // What the surface sends on of the light, if nothing is between.
  static Sight reflectedFrom(const Surface& surface, const Arrival& arrival) {
    const double cosine = dot(surface.normal, arrival.toLight);
    if (!(cosine > 0) || !(largest(arrival.irradiance) > 0)) return {};

    Sight sight;
    Color reflected = surface.material.diffuse / std::numbers::pi;
    if (largest(surface.material.specular) > 0) {
      // The lobe has no value for a viewer behind it.
      if (dot(surface.normal, surface.toViewer) < kSkimming) {
        sight.undecided = 1;
      } else {
        reflected +=
            glossyLobe(surface.material, surface.normal, surface.toViewer, arrival.toLight);
      }
    }

    sight.radiance = reflected * arrival.irradiance * cosine;
    return sight;
  }

  Sight lightFrom(const Surface& surface, const Branch& branch) const {
    Sight sum;
    for (const Light& light : scene_.lights) {
      const bool extended = light.kind != Light::Kind::directional && light.radius > 0;
      if (options_.lightSamples > 1 && extended &&
          length(surface.position - light.position) > light.radius) {
        sum += lightFromSphere(surface, light, branch);
        continue;
      }

      const Arrival arrival = arrivalOf(light, surface.position);
      const Sight reflected = reflectedFrom(surface, arrival);
      if (largest(reflected.radiance) > 0 && lit(surface, arrival)) sum += reflected;
    }
    return sum;
  }

  Sight lightFromSphere(const Surface& surface, const Light& light, const Branch& branch) const {
    const LightSphere sphere(light, surface.position);
    Integral integral;
    double undecided = 0;

    forEvenPoints(branch, [&](double u, double v) {
      const auto [arrival, ratio] = sphere.partAt(u, v);
      const Sight reflected = reflectedFrom(surface, arrival);
      if (!(largest(reflected.radiance) > 0)) return integral.addNothing();
      undecided = std::max(undecided, reflected.undecided);
      integral.addLight(lit(surface, arrival), reflected.radiance, ratio);
    });

    Sight sight = integral.mean(options_.lightSamples);
    sight.undecided = undecided;
    const double most = sphere.largestSample(surface.material, surface.normal, surface.toViewer);
    sight.largestSample = std::max(most / options_.lightSamples, 2 * most / integral.points());
    return sight;
  }

  // What casts shadows hides the ambient light of its directions, as far as that is looked for.
  Sight ambientLight(const Surface& surface, const Branch& branch) const {
    const Color all =
        surface.material.diffuse * ambientAt(scene_.ambient, scene_.sky, surface.normal);
    if (options_.ambientSamples == 0 || scene_.ambient.occlusion == 0 || !(largest(all) > 0)) {
      return {.radiance = all};
    }

    Integral integral;
    forEvenPoints(branch, [&](double u, double v) {
      const Ray ray{surface.position, cosineDirection(surface.normal, u, v)};
      integral.addLight(!geometry_.blocked(ray, scene_.ambient.occlusion), all, 1);
    });

    const int samples = branch.depth == 0 ? options_.ambientSamples : 1;
    Sight sight = integral.mean(samples);
    sight.largestSample = largest(all) / std::min(samples, integral.points());
    return sight;
  }

  // By its samples' density cosine / pi a diffuse surface sends on the mean of what they see.
  Sight indirectLight(const Surface& surface, const Branch& branch) const {
    const Color& part = surface.material.diffuse;
    if (!(largest(part) > 0)) return {};

    Integral integral;
    forEvenPoints(branch, [&](double u, double v) {
      const Vec direction = cosineDirection(surface.normal, u, v);
      integral.add(along(surface, branch, {direction, part, branch.media, 1, true}), part, 1);
    });
    return integral.mean(branch.depth == 0 ? options_.indirect : 1);
  }

  // Light comes neither from behind the face nor through anything that casts shadows.
  bool lit(const Surface& surface, const Arrival& arrival) const {
    const bool lifted = options_.terminator && length(surface.lift) > 0;
    if (!lifted) {
      if (!(dot(surface.plane, arrival.toLight) > 0)) return false;
      return !geometry_.blocked({surface.position, arrival.toLight}, arrival.distance);
    }

    const Vec start = surface.position + surface.lift;
    if (arrival.distance == INFINITY) return !geometry_.blocked({start, arrival.toLight}, INFINITY);
    const Vec way = surface.position + arrival.toLight * arrival.distance - start;
    return !geometry_.blocked({start, normalized(way)}, length(way));
  }

  // What comes along the impulse, of which the surface sends on a part.
  Sight along(const Surface& surface, const Branch& branch, const Impulse& impulse) const {
    Branch child = branch;
    ++child.depth;
    child.weight *= largest(impulse.part);
    child.media = impulse.media;
    child.sampled = branch.sampled || impulse.sampled;
    Sight seen = trace({surface.position, impulse.direction}, child);
    if (surface.smooth && impulse.height < kSkimming) seen.undecided += 1;
    return seen;
  }

  Sight follow(const Surface& surface, const Branch& branch, const Impulse& impulse) const {
    return along(surface, branch, impulse) * impulse.part;
  }

  Sight impulses(const Surface& surface, const Branch& branch, const Media& behind) const {
    const Material& material = surface.material;
    const bool mirrors = surface.tabled && material.reflectsGlossily();
    const double alongMirror = mirrors ? mirroredShare(material) : 0;
    if (!material.isMirror() && !material.passesLight() && alongMirror == 0) return {};

    const Vec direction = -surface.toViewer;
    const double cosine = dot(surface.toViewer, surface.normal);
    if (surface.smooth && cosine < kSkimming) return {.undecided = 1};

    Sight sum;
    const Color coat = schlick(material.mirror, material.mirrorGrazing, cosine);
    // What is not there of a sheet leaves what is behind it: the interface of other solids, if its
    // place is theirs, and all that comes through that.
    const double there = material.coverage;
    Color reflectance = coat * there;
    double passed = 1;

    if (material.passesLight()) {
      const double n1 = branch.media.current().ior, n2 = behind.current().ior;
      const double interface = surface.roughInterface ? 0 : interfaceReflectance(n1, n2, cosine);
      passed = 1 - interface;
      reflectance += (gray(1) - coat) * interface * there + gray(interface) * (1 - there);
      if (interface < 1 && !surface.roughInterface) {
        const Vec on = refracted(direction, surface.normal, n1, n2);
        Color through =
            underCoat(material.transmission, coat) * surface.belowLobe * there + gray(1 - there);
        if (surface.roughSheet) through = gray(1 - there);
        const Color passed = through * (1 - interface);
        sum += follow(surface, branch, {on, passed, behind, -dot(on, surface.plane)});
      }
    }

    // What the mirror, the interface and a smooth lobe reflect is one ray.
    const Color albedo = gray(1) - surface.belowLobe;
    reflectance += albedo * (gray(1) - coat) * (passed * alongMirror * there);
    if (largest(reflectance) > 0) {
      const Vec back = mirrored(direction, surface.normal);
      const double height = dot(back, surface.plane);
      Sight reflected = follow(surface, branch, {back, reflectance, branch.media, height});
      reflected.tabled += alongMirror * largest(reflected.radiance) / largest(reflectance);
      sum += reflected;
    }

    return sum;
  }

  bool samplesLobe(const Material& material) const {
    return options_.lobeSamples() > 0 && material.reflectsGlossily();
  }

  // The lobe's albedo towards the viewer, of which whit has the mean weight of its samples or a
  // table.
  Sight lobeWeight(const Surface& surface, const Branch& branch) const {
    const Material& material = surface.material;
    const double nv = dot(surface.normal, surface.toViewer);
    if (!material.lobeCovers() && !surface.roughInterface) return {};
    const bool tabled = !samplesLobe(material) && !surface.roughInterface && !branch.drawn;
    if (nv < (tabled ? kLeastTabled : kSkimming)) return {.undecided = 1};
    if (tabled) return {.radiance = lobeAlbedo(material, nv)};
    if (material.roughness * material.roughness <= kSmooth) {
      return {.radiance = lobeReflectance(material, nv)};
    }

    Integral integral;
    forEvenPoints(branch, [&](double u, double v) {
      const Vec facet = facetSeen(material, surface.normal, surface.toViewer, u, v);
      const std::optional<Impulse> reflected = reflectionBy(surface, branch, facet);
      if (!reflected) return integral.addNothing();
      integral.add({.radiance = gray(1)}, reflected->part, 1);
    });
    return integral.mean(branch.depth == 0 ? options_.lobeSamples() : 1);
  }

  // A sample of the lobe's reflection, if the facet reflects to the outside. The density of what
  // the facets that are seen reflect is D G1 / (4 nv).
  std::optional<Impulse> reflectionBy(const Surface& surface, const Branch& branch,
                                      const Vec& facet) const {
    const Material& material = surface.material;
    const Vec& normal = surface.normal;
    const Vec toLight = mirrored(-surface.toViewer, facet);
    const double nv = dot(normal, surface.toViewer), nl = dot(normal, toLight);
    const double vh = dot(surface.toViewer, facet);
    if (!(vh > 0) || !(nl > 0)) return std::nullopt;

    const double density =
        facetsFacing(material, dot(normal, facet)) * shareSeen(material, nv) / (4 * nv);
    const Color part = facetReflectance(surface, vh) *
                       (facetLobe(material, normal, surface.toViewer, toLight) * nl / density);
    return Impulse{toLight, part, branch.media, dot(toLight, surface.plane), true};
  }

  // By the facets that are seen, as whit samples them.
  Sight glossyReflection(const Surface& surface, const Branch& branch) const {
    const Material& material = surface.material;
    if (!samplesLobe(material) && !surface.roughInterface) return {};

    const double nv = dot(surface.normal, surface.toViewer);
    if (surface.smooth && nv < kSkimming) return {.undecided = 1};

    if (material.roughness * material.roughness <= kSmooth) {
      const Vec back = mirrored(-surface.toViewer, surface.normal);
      const Color part = lobeReflectance(material, nv);
      return follow(surface, branch, {back, part, branch.media, dot(back, surface.plane)});
    }

    Integral integral;
    forEvenPoints(branch, [&](double u, double v) {
      const Vec facet = facetSeen(material, surface.normal, surface.toViewer, u, v);
      const std::optional<Impulse> reflected = reflectionBy(surface, branch, facet);
      if (!reflected) return integral.addNothing();
      integral.add(along(surface, branch, *reflected), reflected->part, 1);
    });
    return integral.mean(branch.depth == 0 ? options_.lobeSamples() : 1);
  }

  // What frosted glass transmits, by the facets that are seen.
  Sight frostedTransmission(const Surface& surface, const Branch& branch,
                            const Media& behind) const {
    if (!surface.roughInterface && !surface.roughSheet) return {};

    const Material& material = surface.material;
    const Vec& normal = surface.normal;
    const Vec& toViewer = surface.toViewer;
    const double nv = dot(normal, toViewer), n1 = surface.n1, n2 = surface.n2;
    if (surface.smooth && nv < kSkimming) return {.undecided = 1};
    const Color coat = schlick(material.mirror, material.mirrorGrazing, nv);
    const Color through = underCoat(material.transmission, coat);

    Integral integral;
    forEvenPoints(branch, [&](double u, double v) {
      const Vec facet = facetSeen(material, normal, toViewer, u, v);
      const double vh = dot(toViewer, facet);
      if (!(vh > 0)) return integral.addNothing();

      Vec on;
      Color part = through;
      if (surface.roughInterface) {
        const double passed = 1 - interfaceReflectance(n1, n2, vh);
        if (!(passed > 0)) return integral.addNothing();
        on = refracted(-toViewer, facet, n1, n2);
        const double nl = -dot(normal, on);
        if (!(nl > 0)) return integral.addNothing();
        part = part * (passed * nl * transmittedLobe(material, n1, n2, normal, toViewer, on) /
                       transmittedDensity(material, n1, n2, normal, toViewer, on));
      } else {
        // Whatever the facets do, a sheet lets it out at its far side.
        const Vec back = mirrored(-toViewer, facet);
        on = back - normal * (dot(normal, back) + std::abs(dot(normal, back)));
        if (samplesLobe(material)) part = part * (gray(1) - lobeReflectance(material, vh));
      }

      const Impulse impulse{on, part, behind, -dot(on, surface.plane), true};
      integral.add(along(surface, branch, impulse), part, 1);
    });
    return integral.mean(branch.depth == 0 ? options_.lobeSamples() : 1);
  }

  const Scene scene_;  // at its time
  const Options& options_;
  std::vector<MipChain> textures_;  // as masks cut: at full size
  // As materials show them.
  std::map<std::pair<const Material*, int Material::*const*>, MipChain> shown_;
  Geometry geometry_;
};

}  // namespace

std::unique_ptr<Tracer> makeTracer(const Scene& scene, const Options& options) {
  return std::make_unique<Paths>(scene, options);
}

}  // namespace oracle
