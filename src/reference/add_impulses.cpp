#include "reference/add_impulses.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "reference/fresnel.h"
#include "sampling/ggx_lobe.h"

namespace whit::reference {

namespace {

Ray reflectedRay(const Surfel& s, const ShadingChoices& choices) {
  const Vec3d mirrored = reflect(-s.view, s.shadingNormal),
              origin = rayOrigin(choices.offset, s, 1);
  if (!choices.bend) return {origin, mirrored, s.cone};
  return {origin, raised(mirrored, s.geometricNormal, smallestElevation(s)), s.cone};
}

Ray refractedRay(const Surfel& s, const Interface& interface, double c,
                 const ShadingChoices& choices) {
  const Vec3d d = -s.view, origin = rayOrigin(choices.offset, s, -1);
  if (interface.k == 0) return {origin, d, s.cone};
  const Vec3d bent = refract(interface, d, s.shadingNormal, c);
  if (!choices.bend) return {origin, bent, s.cone};
  // Under the geometric normal the ray would leave this steeply, if at all; normals that agree
  // change nothing.
  const double facing = dot(s.view, s.geometricNormal);
  const double g2 = interface.k + facing * facing;
  const double steepness = g2 > 0 ? std::sqrt(g2) / interface.eta : 1;
  return {origin, raised(bent, -s.geometricNormal, smallestElevation(steepness)), s.cone};
}

// Scales the color down where color + taken would exceed 1. All channels are scaled by one factor,
// so that glass keeps its hue under a mirror; but a channel whose own sum allows more keeps more,
// which matters under colored mirrors.
RgbD limited(const RgbD& color, const RgbD& taken) {
  const RgbD left = max(RgbD(1.0) - taken, RgbD(0.0));
  const double largest = maxComponent(color);
  double common = 1;
  for (int i = 0; i < 3; ++i) {
    if (color[i] > left[i]) common = std::min(common, left[i] / color[i]);
  }
  const auto share = [&](double own) {
    return own >= largest ? 1 : std::max(common, own / largest);
  };
  return color * RgbD(share(left.x), share(left.y), share(left.z));
}

double cosineOf(const Surfel& surfel) {
  return std::clamp(dot(surfel.view, surfel.shadingNormal), 0.0, 1.0);
}

// Returns how much of `color`, which lies under the mirror, is sent out if layers between them send
// out the share `others`. A coat dims it even where there is light enough for both.
RgbD underMirror(const Material& material, const RgbD& color, const RgbD& mirror,
                 const RgbD& others = {}) {
  const RgbD below = material.coat ? color * (RgbD(1.0) - mirror) : color;
  return limited(below, mirror + others);
}

// The share of the light that the interface does not reflect, but for facets, which are a lobe.
double passedBy(const Crossing& crossing, const ShadingChoices& choices, const Surfel& surfel) {
  if (!crossing.dielectric || surfel.frosting.ofInterface) return 1;
  const double c = cosineOf(surfel);
  return 1 - makeInterface(crossing.n1, crossing.n2, c, choices.fresnel).reflectance;
}

// Seen from nearer to the normal than this, as a sine, the plane of incidence is lost in rounding,
// and any other serves as well.
constexpr double kLeastSine = 0.01;

// Right-handed, z along the surface's normal, the view in the plane of x and z.
struct Frame {
  Vec3d x, y, z;
  double sine = 0;  // sine of the angle between view and z
};

Frame frameOfIncidence(const Vec3d& n, const Vec3d& view) {
  const Vec3d along = view - n * dot(n, view);
  const double sine = length(along);
  const Vec3d axis = std::fabs(n.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d x = sine > kLeastSine ? along / sine : normalized(cross(n, axis));
  return {x, cross(n, x), n, sine};
}

// A child that samples a lobe.
struct LobeChild {
  Impulse impulse;
  int rays = 1;  // number of rays that share the lobe
};

// Finds the sample of a lobe whose path number is that of the child; none for mirrored and
// refracted rays.
std::optional<LobeChild> sampleOfLobe(const World& world, const Chunk& chunk, std::size_t child,
                                      RayKind kind, const Surfel& surfel) {
  if (!chunk.has(Feature::streams)) return std::nullopt;
  const std::uint32_t slot = chunk.children.parent[child], path = chunk.rays.path[slot];
  for (const auto& [lobe, raysOf, impulseOf] : kSampledLobes) {
    if (lobe.kind != kind) continue;
    const LobeSampling sampling =
        lobeSampling(chunk.depth, lobe.samples(chunk.options()), chunk.sampleNumber);
    const int rays = raysOf(surfel, sampling);
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(rays); ++k) {
      if (chunk.children.path[child] != childStream(path, lobe.firstBranch + k)) continue;
      const UnitPoint at = pointOf(lobe, path, sampling, k);
      Impulse impulse = impulseOf(surfel, mediaOf(chunk, slot), at, chunk.options().shading);
      const Material& material = world.scene.materials[surfel.material];
      impulse.weight *= factorOfLobe(lobe, material, world.effects, surfel, chunk.depth, path);
      return LobeChild{impulse, rays};
    }
  }
  return std::nullopt;
}

RayKind kindOf(const Chunk& chunk, std::size_t child) {
  const auto end = chunk.childSegments.begin() + chunk.childSegmentCount;
  return std::find_if(chunk.childSegments.begin(), end,
                      [&](const Segment& s) { return child < s.end; })
      ->kind;
}

}  // namespace

double smallestElevation(double elevation) { return std::min(0.9 * elevation, 0.01); }

double smallestElevation(const Surfel& surfel) {
  return smallestElevation(dot(surfel.view, surfel.geometricNormal));
}

Vec3d raised(const Vec3d& r, const Vec3d& normal, double elevation) {
  const double own = dot(r, normal);
  return own < elevation ? normalized(r + normal * (elevation - own)) : r;
}

Impulses findImpulses(const Scene& scene, EffectSet effects, const Surfel& surfel,
                      const Crossing& crossing, MediaStack stack, const ShadingChoices& choices) {
  Impulses result;
  if (crossing.hidden) {
    result.refracted = {RgbD(1.0),
                        {rayOrigin(choices.offset, surfel, -1), -surfel.view, surfel.cone},
                        crossing.stackBehind};
    return result;
  }
  const Material& material = scene.materials[surfel.material];
  const double c = cosineOf(surfel);
  const bool mirrors = effects.has(Effect::mirror);
  const RgbD mirror = mirrorOf(material, effects, surfel);
  RgbD reflectance = mirror * surfel.coverage;
  if (crossing.dielectric) {
    const Interface interface = makeInterface(crossing.n1, crossing.n2, c, choices.fresnel);
    const double passed = 1 - interface.reflectance;
    const bool isRough = surfel.frosting.ofInterface;
    if (mirrors && !isRough) reflectance = RgbD(interface.reflectance) + reflectance * passed;
    if (passed > 0 && !isRough) {
      // Samples bring what frosted sheets transmit.
      RgbD through;
      if (!surfel.frosting.ofSheet) {
        const RgbD transmission = RgbD(material.transmission) * surfel.transmission;
        through = underMirror(material, transmission, mirror) * (RgbD(passed) - surfel.lobe) *
                  surfel.coverage;
      }
      result.refracted = {through + RgbD((1 - surfel.coverage) * passed),
                          refractedRay(surfel, interface, c, choices), crossing.stackBehind};
    }
  }
  const double alongMirror = mirroredShare(material, effects, surfel);
  reflectance += surfel.lobe * (RgbD(1.0) - mirror) * (alongMirror * surfel.coverage);
  if (maxComponent(reflectance) > 0) {
    result.reflected = {reflectance, reflectedRay(surfel, choices), stack};
  }
  return result;
}

LobePoints lobePointsOf(const Chunk& chunk, std::size_t slot) {
  const std::uint32_t path = chunk.has(Feature::streams) ? chunk.rays.path[slot] : 0;
  return {path, lobeSampling(chunk.depth, glossySamples(chunk.options()), chunk.sampleNumber)};
}

RgbD mirrorOf(const Material& material, EffectSet effects, const Surfel& surfel) {
  if (!effects.has(Effect::mirror)) return {};
  const RgbD normal = RgbD(material.mirror) * surfel.mirror, grazing(material.mirrorGrazing);
  return normal + (grazing - normal) * schlickTerm(cosineOf(surfel));
}

double mirroredShare(const Material& material, EffectSet effects, const Surfel& surfel) {
  return material.mirrorsByLobe(effects) ? mirroredShareOf(std::sqrt(surfel.alpha)) : 0;
}

RgbD underCoat(const Material& material, EffectSet effects, const Surfel& surfel) {
  if (!material.isUnderCoat(effects)) return RgbD(1.0);
  return RgbD(1.0) - mirrorOf(material, effects, surfel);
}

void findLobes(const Material& material, EffectSet effects, const Crossing& crossing,
               const ShadingChoices& choices, Surfel& surfel) {
  const RgbD mirror = mirrorOf(material, effects, surfel);
  if (material.frosts(effects) && !crossing.hidden) {
    Frosting& frosting = surfel.frosting;
    frosting.ofInterface = material.boundsMedium();
    frosting.ofSheet = !frosting.ofInterface && crossing.n1 == crossing.n2;
    frosting.reflects = material.scatters(effects);
    frosting.n1 = crossing.n1;
    frosting.n2 = crossing.n2;
    frosting.transmission =
        underMirror(material, RgbD(material.transmission) * surfel.transmission, mirror);
    frosting.mediaBehind = crossing.stackBehind;
  }
  surfel.aboveLobe = (RgbD(1.0) - mirror) * passedBy(crossing, choices, surfel);
}

namespace {

// The mean weight of the very samples of the lobe that are taken, or else its albedo.
RgbD weightOfLobe(const Material& material, EffectSet effects, const ShadingChoices& choices,
                  const LobePoints& points, const Surfel& surfel) {
  if (!material.scatters(effects)) {
    const double f90 = lobeGrazing(surfel.specular, surfel.grazingRatio);
    return lobeAlbedo(surfel.specular, f90, cosineOf(surfel), std::sqrt(surfel.alpha));
  }
  Surfel alone = surfel;
  alone.coverage = 1;
  alone.aboveLobe = RgbD(1.0);
  RgbD sum;
  const int rays = glossyRays(surfel, points.sampling);
  for (int i = 0; i < rays; ++i) {
    const auto k = static_cast<std::uint32_t>(i);
    const UnitPoint at = pointOf(kGlossyLobe, points.path, points.sampling, k);
    sum += glossyImpulse(alone, 0, at, choices).weight / rays;
  }
  return sum;
}

}  // namespace

void findLayers(const Scene& scene, EffectSet effects, const Crossing& crossing,
                const ShadingChoices& choices, const LobePoints& points, Surfel& surfel) {
  const Material& material = scene.materials[surfel.material];
  findLobes(material, effects, crossing, choices, surfel);
  if (crossing.hidden || !material.isLayered(effects)) return;
  const RgbD mirror = mirrorOf(material, effects, surfel);
  const double passed = passedBy(crossing, choices, surfel);
  RgbD albedo, through;
  if (material.dimsBelow(effects)) {
    albedo = weightOfLobe(material, effects, choices, points, surfel);
  }
  surfel.lobe = albedo * passed;
  surfel.underCoat = underCoat(material, effects, surfel);

  if (crossing.dielectric && material.hasTransmission()) {
    through = underMirror(material, RgbD(material.transmission) * surfel.transmission, mirror);
  }
  surfel.diffuse =
      underMirror(material, surfel.diffuse, mirror, through) * (RgbD(1.0) - albedo) * passed;
}

namespace {

// The width of the facets' distribution; 0 where they are as good as smooth, or bend no light.
double widthOfFacets(const Surfel& s) {
  const bool bends = !s.frosting.ofInterface || s.frosting.n1 != s.frosting.n2;
  return s.alpha > double{kSmoothAlpha} && bends ? s.alpha : 0;
}

// A facet that the viewer sees.
struct Facet {
  Vec3d normal;
  double cosine = 0;  // between viewer and facet, in [0, 1]
  RgbD reflectance;
  Vec3d mirrored;        // the view, unit
  double elevation = 0;  // sine of its elevation over the surface
  double passes = 0;     // share of the light that passes other facets
};

Facet facetAt(const Surfel& s, const UnitPoint& at, FresnelModel model) {
  const Frame frame = frameOfIncidence(s.shadingNormal, s.view);
  const double nv = std::max(dot(s.shadingNormal, s.view), kLeastCosine), alpha = widthOfFacets(s);
  const double turn = 2 * std::numbers::pi * double{at.u};
  const Vec3d m = visibleNormal(normalized(Vec3d(frame.sine, 0, nv)), alpha, std::cos(turn),
                                std::sin(turn), double{at.v});
  Facet facet;
  facet.normal = frame.x * m.x + frame.y * m.y + frame.z * m.z;
  const double vh = dot(s.view, facet.normal);
  facet.cosine = std::clamp(vh, 0.0, 1.0);
  facet.mirrored = normalized(facet.normal * (2 * vh) - s.view);
  facet.elevation = dot(s.shadingNormal, facet.mirrored);
  facet.passes = passingShare(nv, facet.elevation, alpha);

  if (s.frosting.ofInterface) {
    const Frosting& f = s.frosting;
    facet.reflectance = RgbD(makeInterface(f.n1, f.n2, facet.cosine, model).reflectance);
  } else {
    const RgbD f0 = s.specular, f90(lobeGrazing(f0, s.grazingRatio));
    facet.reflectance = f0 + (f90 - f0) * schlickTerm(facet.cosine);
  }
  return facet;
}

}  // namespace

int glossyRays(const Surfel& surfel, const LobeSampling& sampling) {
  return widthOfFacets(surfel) > 0 ? sampling.count : 1;
}

Impulse glossyImpulse(const Surfel& s, MediaStack stack, const UnitPoint& at,
                      const ShadingChoices& choices) {
  const Facet facet = facetAt(s, at, choices.fresnel);
  if (!(facet.elevation > 0)) return {};

  // A ray is raised only where the shading normal differs from the geometric one; elsewhere it is
  // high enough already.
  const double least = smallestElevation(facet.elevation);
  const Vec3d r = choices.bend ? raised(facet.mirrored, s.geometricNormal, least) : facet.mirrored;
  return {facet.reflectance * (facet.passes * s.coverage) * s.aboveLobe,
          {rayOrigin(choices.offset, s, 1), r, s.cone},
          stack};
}

Impulse frostedImpulse(const Surfel& s, MediaStack, const UnitPoint& at,
                       const ShadingChoices& choices) {
  const Frosting& f = s.frosting;
  Facet facet = facetAt(s, at, choices.fresnel);
  const double alpha = widthOfFacets(s);
  Vec3d direction;
  double depth = 0, passes = 0;  // sine under the surface; share that passes other facets
  if (f.ofSheet) {
    if (!f.reflects) facet.reflectance = {};
    depth = std::fabs(facet.elevation);
    direction = facet.mirrored - s.shadingNormal * (depth + facet.elevation);
    passes = 1;
  } else if (f.ofInterface && facet.reflectance.x < 1) {
    const Interface interface = makeInterface(f.n1, f.n2, facet.cosine, choices.fresnel);
    direction = refract(interface, -s.view, facet.normal, facet.cosine);
    depth = -dot(s.shadingNormal, direction);
    passes = seenShare(depth, alpha);
  }
  if (!(depth > 0)) return {};

  const bool goesOn = alpha == 0 && f.n1 == f.n2;
  if (choices.bend) direction = raised(direction, -s.geometricNormal, smallestElevation(depth));
  return {(RgbD(1.0) - facet.reflectance) * (passes * s.coverage) * f.transmission,
          {rayOrigin(choices.offset, s, -1), goesOn ? -s.view : direction, s.cone},
          f.mediaBehind};
}

Impulse indirectImpulse(const Surfel& s, MediaStack stack, const UnitPoint& at,
                        const ShadingChoices& choices) {
  const Vec3d drawn = cosineDirection(s.shadingNormal, at);
  const double elevation = smallestElevation(dot(s.shadingNormal, drawn));
  const Vec3d r = choices.bend ? raised(drawn, s.geometricNormal, elevation) : drawn;
  return {s.diffuse * s.coverage, {rayOrigin(choices.offset, s, 1), r, s.cone}, stack};
}

double factorOfLobe(const Lobe& lobe, const Material& material, EffectSet effects,
                    const Surfel& surfel, int depth, std::uint32_t path) {
  if (lobe.kind == RayKind::refraction) return 1;
  if (depth == 0) return surfel.occlusion;
  if (!material.scatters(effects) || !material.diffuses(effects)) return 1;

  // The lobe's weight is that of its one sample (findLayers).
  const RgbD mirror = mirrorOf(material, effects, surfel);
  const double glossy = maxComponent(surfel.lobe * (RgbD(1.0) - mirror));
  const double diffuse = maxComponent(surfel.diffuse), both = glossy + diffuse;

  const bool isGlossy = lobe.kind == RayKind::reflection;
  const bool followsGlossy = double{pathDraw(path, kLobeSalt)} * both < glossy;
  if (isGlossy != followsGlossy) return 0;
  const double own = isGlossy ? glossy : diffuse;
  return own > 0 ? both / own : 1;
}

bool survives(const RenderOptions& options, double contribution, std::uint32_t path) {
  // Written so that a NaN ends the path.
  if (options.roulette == 0) return contribution >= double{options.cutoff};
  return double{rouletteDraw(path)} * double{options.roulette} < contribution;
}

double growthOfSurvivors(const RenderOptions& options, double contribution) {
  return contribution < double{options.roulette} ? double{options.roulette} / contribution : 1;
}

RayRow addImpulses(const World& world, const Chunk& chunk, std::size_t child) {
  const std::uint32_t slot = chunk.children.parent[child];
  const std::uint32_t path = chunk.has(Feature::streams) ? chunk.rays.path[slot] : 0;

  Surfel surfel = surfelOf(chunk, slot);
  const std::uint32_t stack = mediaOf(chunk, slot);
  const Crossing crossing = crossMedia(world.scene, world.effects, surfel.material, surfel.entering,
                                       stack, alsoCrossedAt(chunk, slot));

  const Material& material = world.scene.materials[surfel.material];
  surfel.grazingRatio = double{material.grazingRatio};
  findLobes(material, world.effects, crossing, chunk.options().shading, surfel);

  // A sample of a lobe has the path that its random numbers came from, other impulses that of their
  // branch.
  const RayKind kind = kindOf(chunk, child);
  RayRow row;
  row.path = childStream(path, branchOf(kind));

  LobeChild traced;
  if (const auto sample = sampleOfLobe(world, chunk, child, kind, surfel)) {
    traced = *sample;
    row.path = chunk.children.path[child];
  } else {
    traced.impulse =
        findImpulses(world.scene, world.effects, surfel, crossing, stack, chunk.options().shading)
            .of(kind);
  }

  const Impulse& impulse = traced.impulse;
  const double contribution = double{chunk.rays.throughput[slot]} * maxComponent(impulse.weight);
  const double grows = growthOfSurvivors(chunk.options(), contribution);

  row.org = impulse.ray.origin;
  row.dir = impulse.ray.direction;
  row.weight = impulse.weight * (grows / traced.rays);

  row.throughput = contribution * grows;
  row.parent = slot;
  row.media = impulse.media;

  const bool goesOn = impulse.ray.direction == rayOf(chunk, slot).direction;
  row.straight = goesOn && chunk.has(Feature::alpha) && chunk.isStraight(slot) ? 1 : 0;
  row.cone = impulse.ray.cone.width;

  return row;
}

}  // namespace whit::reference
