#include <algorithm>
#include <vector>

#include "bake/facet.h"
#include "reference/add_impulses.h"
#include "reference/check_shadows.h"
#include "reference/find_intersections.h"
#include "reference/find_radiance_and_shadow_rays.h"
#include "reference/media.h"
#include "reference/reference.h"
#include "reference/write_emitted_and_reflective_ambient.h"
#include "sampling/random_streams.h"
#include "sampling/ray_limit.h"
#include "sampling/sample_pattern.h"

namespace whit::reference {

namespace {

Path childOf(const Path& path, std::uint32_t branch) {
  Path child = path;
  child.straight = false;
  child.number = childStream(path.number, branch);
  return child;
}

}  // namespace

Tracer::Tracer(const Scene& scene, const Intersector& intersector, const Settings& settings,
               const PathObserver& observer)
    : scene_(scene),
      intersector_(intersector),
      observer_(observer),
      options_(settings.options),
      effects_(settings.effects.without(optionalEffectsOff(options_))),
      earlier_(settings.earlier),
      samples_(samplePattern(options_.spp)) {
  if (options_.shading.textureFilter == TextureFilter::trilinear) {
    maps_.emplace(scene, settings.threads);
  }
}

RgbD Tracer::traceImpulse(const Ray& ray, int depth, double throughput, std::uint32_t media,
                          RayCounts& counts, Path path) const {
  const bool absorbs = effects_.has(Effect::absorption) && media != 0;
  const bool foggy = effects_.has(Effect::fog) && media == 0 && !(ray.direction == Vec3d());
  const auto transmittanceAfter = [&](double distance) {
    if (foggy) return leftBy(scene_.fog, distance);
    if (absorbs) return reference::transmittance(scene_, media, distance);
    return RgbD(1.0);
  };
  const auto scattered = [&](const RgbD& transmittance) {
    if (!foggy) return RgbD();
    return RgbD(scene_.fog.color) * (RgbD(1.0) - transmittance);
  };

  const std::optional<ChosenSurface> found = nearest(ray, depth);
  if (!found) {
    const RgbD transmittance = transmittanceAfter(kInfinity);
    if (path.straight) counts.clear += transmittance * path.weight;
    if (path.straight && options_.background.hidesSky()) return scattered(transmittance);
    return skyAlong(scene_, effects_, ray.direction) * transmittance + scattered(transmittance);
  }

  const Candidate& candidate = found->candidate;
  const TriangleHit hit = refineHit(scene_, ray, candidate);
  const RgbD transmittance = transmittanceAfter(hit.t);
  Surfel surfel = surfelAt(ray, *found, hit);
  const Crossing crossing =
      crossMedia(scene_, effects_, surfel.material, surfel.entering, media, found->alsoCrossed);
  const LobePoints points{path.number, lobeSampling(depth, glossySamples(options_), path.sample)};
  findLayers(scene_, effects_, crossing, options_.shading, points, surfel);

  const double throughputHere = throughput * maxComponent(transmittance);
  path.weight = path.weight * transmittance;
  RgbD radiance;
  if (!crossing.hidden) {
    radiance = emittedAndAmbient(scene_, effects_, surfel);
    if (isOccluded(scene_.ambient, effects_)) {
      radiance += radianceFromAmbient(surfel, depth, counts, path);
    }
    if (effects_.has(Effect::lights)) {
      radiance += radianceFromLights(surfel, depth, throughputHere, counts, path);
    }
  }
  if (depth < options_.depth || keptChannels(options_).has(Channel::error)) {
    const Impulses children =
        findImpulses(scene_, effects_, surfel, crossing, media, options_.shading);
    Choice choice = chooseImpulses(children, surfel, crossing, depth, throughputHere, media, path);
    for (const RayKind kind : kImpulseKinds) {
      const Impulse child = children.of(kind);
      Path childPath = childOf(path, branchOf(kind));
      childPath.straight = path.straight && child.ray.direction == ray.direction;
      RgbD sum = follow(child, kind, depth + 1, throughputHere, counts, childPath, 1, choice);
      for (const SampledLobe& sampled : kSampledLobes) {
        if (sampled.lobe.kind != kind || crossing.hidden) continue;
        sum += radianceByLobe(sampled, surfel, depth, throughputHere, media, counts, path, choice);
      }
      radiance += sum;
    }
  }
  return radiance * transmittance + scattered(transmittance);
}

Surfel Tracer::surfelAt(const Ray& ray, const ChosenSurface& chosen, const TriangleHit& hit) const {
  const TextureLookup lookup{options_.shading.textureFilter,
                             maps_ ? &*maps_ : nullptr,
                             {ray.cone.widthAt(hit.t), ray.cone.spread}};
  return makeSurfel(scene_, effects_, chosen.candidate, hit, ray, lookup,
                    chosen.alsoCrossed >= kSharesPlace);
}

// Returns the closest surface that the ray hits. Rays of the camera pass the surfaces that the eye
// lies in.
std::optional<ChosenSurface> Tracer::nearest(Ray ray, int depth) const {
  Candidate candidate;
  for (int attempt = 0; attempt < kAttemptsPastEye; ++attempt) {
    if (!intersector_.closest(ray, candidate)) return std::nullopt;
    if (depth > 0) break;
    if (!liesInSurface(scene_, ray.origin, candidate.triangle, candidate.instance)) break;
    ray.tNear = distancePastEye(ray.origin, attempt);
  }
  const ChosenSurface chosen = chooseSurface(scene_, effects_, ray, candidate);
  observer_.hit(chosen.candidate);
  return chosen;
}

// Calls use(impulse, branch of its path, number of samples) for each sample of the lobe.
template <typename Use>
void Tracer::forEachSample(const SampledLobe& sampled, const Surfel& surfel, int depth,
                           std::uint32_t media, const Path& path, const Use& use) const {
  const auto& [lobe, raysOf, impulseOf] = sampled;
  const Material& material = scene_.materials[surfel.material];
  if (!lobe.isSampled(material, effects_)) return;

  const LobeSampling sampling = lobeSampling(depth, lobe.samples(options_), path.sample);
  const double factor = factorOfLobe(lobe, material, effects_, surfel, depth, path.number);
  const std::uint32_t rays = raysOf(surfel, sampling);
  for (std::uint32_t k = 0; k < rays; ++k) {
    const UnitPoint at = pointOf(lobe, path.number, sampling, k);
    Impulse impulse = impulseOf(surfel, media, at, options_.shading);
    impulse.weight *= factor;
    use(impulse, lobe.firstBranch + k, rays);
  }
}

// The mean of the lobe's samples. Each is followed as if it were the whole lobe, so that their
// number does not decide which light is worth its rays.
RgbD Tracer::radianceByLobe(const SampledLobe& sampled, const Surfel& surfel, int depth,
                            double throughput, std::uint32_t media, RayCounts& counts, Path path,
                            Choice& choice) const {
  RgbD sum;
  int number = 1;
  const auto add = [&](const Impulse& impulse, std::uint32_t branch, int samples) {
    number = samples;
    Path child = childOf(path, branch);
    child.straight = path.straight && impulse.ray.direction == -surfel.view;
    sum +=
        follow(impulse, sampled.lobe.kind, depth + 1, throughput, counts, child, samples, choice);
  };
  forEachSample(sampled, surfel, depth, media, path, add);
  return sum / number;
}

// The impulses of the surface that are followed. Only trees that are traced again leave some out.
Choice Tracer::chooseImpulses(const Impulses& impulses, const Surfel& surfel,
                              const Crossing& crossing, int depth, double throughput,
                              std::uint32_t media, Path path) const {
  Choice choice;
  if (!path.tree || !path.tree->narrows || depth >= options_.depth) return choice;

  // The largest channels of the weights of those that are worth following, in order.
  std::vector<double> weights;
  const auto add = [&](const Impulse& impulse, std::uint32_t branch, int shares) {
    const double largest = maxComponent(impulse.weight), contribution = throughput * largest;
    if (!(largest > 0 && survives(options_, contribution, childOf(path, branch).number))) return;
    weights.push_back(largest * growthOfSurvivors(options_, contribution) / shares);
  };
  for (const RayKind kind : kImpulseKinds) {
    add(impulses.of(kind), branchOf(kind), 1);
    for (const SampledLobe& sampled : kSampledLobes) {
      if (sampled.lobe.kind != kind || crossing.hidden) continue;
      forEachSample(sampled, surfel, depth, media, path, add);
    }
  }

  choice.width = path.width * std::max<std::uint64_t>(1, weights.size());
  if (choice.width <= widestTree(options_.maxRays, options_.depth)) return choice;
  choice.width = path.width;
  choice.all = false;
  for (const double weight : weights) choice.weights += weight;
  const double drawn = choiceDraw(path.number) * choice.weights;
  double passed = weights[0];
  while (passed <= drawn && choice.chosen + 1 < weights.size()) passed += weights[++choice.chosen];
  return choice;
}

// Returns the radiance that an impulse brings back, if it is worth following. The impulse is one of
// `shares` samples of its lobe.
RgbD Tracer::follow(const Impulse& impulse, RayKind kind, int depth, double throughput,
                    RayCounts& counts, Path path, int shares, Choice& choice) const {
  const double largest = maxComponent(impulse.weight), contribution = throughput * largest;
  // Written so that a NaN ends the path.
  const bool isLast = depth > options_.depth;
  if (isLast || !(largest > 0 && survives(options_, contribution, path.number))) {
    if (isLast || options_.roulette == 0) counts.ended += contribution * path.share / shares;
    return {};
  }
  const bool isChosen = choice.all || choice.next == choice.chosen;
  ++choice.next;
  if (!isChosen) return {};
  const std::uint64_t most = options_.maxRays;
  if (path.tree && ++path.tree->followed > most && !path.tree->narrows) return {};

  ++counts[kind];
  path.width = choice.width;
  double grows = growthOfSurvivors(options_, contribution), reaches = contribution * grows;
  if (choice.all) {
    path.share /= shares;
  } else {
    grows = choice.weights * shares / largest;
    reaches = throughput * choice.weights;
  }
  const Impulse followed{impulse.weight * grows, impulse.ray, impulse.media};
  path.weight = path.weight * followed.weight / shares;
  observer_.began(followed, kind);
  const RgbD radiance = traceImpulse(impulse.ray, depth, reaches, impulse.media, counts, path);
  observer_.ended(radiance);
  return followed.weight * radiance;
}

// Returns the mean, over sampled directions, of the ambient light that is not occluded.
RgbD Tracer::radianceFromAmbient(const Surfel& surfel, int depth, RayCounts& counts,
                                 Path path) const {
  const LobeSampling points = lightSampling(depth, options_.ambientSamples, path.sample);
  RgbD sum;
  for (std::uint32_t k = 0; k < points.count; ++k) {
    const LightArrival arrival = ambientArrival(scene_, effects_, surfel, options_.shading,
                                                lightPoint(path.number, points, kAmbientLight, k));
    if (!(maxComponent(arrival.radiance) > 0)) continue;
    ++counts[RayKind::occlusion];
    if (isVisible(intersector_, arrival.shadowRay, arrival.tFar)) sum += arrival.radiance;
  }
  return sum / points.count;
}

// Each point of a light is looked at as if it were the whole light, so that their number does not
// decide which light is worth its shadow rays.
RgbD Tracer::radianceFromLights(const Surfel& surfel, int depth, double throughput,
                                RayCounts& counts, Path path) const {
  RgbD sum;
  for (std::uint32_t number = 0; number < scene_.lights.size(); ++number) {
    const Light& light = scene_.lights[number];
    const bool soft = effects_.has(Effect::softShadows) && hasExtent(light);
    const LobeSampling points = lightSampling(depth, soft ? options_.lightSamples : 1, path.sample);
    for (std::uint32_t k = 0; k < points.count; ++k) {
      const LightPoint point{points.count == 1, lightPoint(path.number, points, number, k)};
      const LightArrival arrival =
          arrivalFromLight(scene_, effects_, surfel, light, options_.shading, point);

      const double largest = maxComponent(arrival.radiance);
      if (!(largest > 0 && throughput * largest >= options_.shading.lightCutoff)) continue;
      if (effects_.has(Effect::shadows)) {
        ++counts[RayKind::shadow];
        if (!isVisible(intersector_, arrival.shadowRay, arrival.tFar)) continue;
      }
      sum += points.count == 1 ? arrival.radiance : arrival.radiance / points.count;
    }
  }
  return sum;
}

}  // namespace whit::reference
