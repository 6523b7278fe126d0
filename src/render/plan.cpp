#include "render/plan.h"

#include <stdexcept>

#include "accel/accel.h"
#include "core/index.h"
#include "render/steps.h"
#include "simd/kernels.h"
#include "stages/lobes.h"

namespace whit {

namespace {

// Effects that mean nothing without another one go with it.
EffectSet consistent(const Scene& scene, EffectSet e) {
  if (!e.has(Effect::sky)) e = e.without(Effect::skyImage);
  const bool showsSky =
      scene.sky.kind == Sky::Kind::image ? e.has(Effect::skyImage) : e.has(Effect::sky);
  if (!showsSky || scene.blurredSky.r.empty()) e = e.without(Effect::blurredSky);
  if (!e.has(Effect::glossy)) e = e.without(Effect::glossyReflection).without(Effect::blurredSky);
  if (!e.has(Effect::lights)) {
    e = e.without(Effect::shadows);
    e = e.without(Effect::spotLights).without(Effect::directionalLights);
  }
  if (!e.has(Effect::shadows)) e = e.without(Effect::softShadows);
  if (!e.has(Effect::ambient) && !e.has(Effect::blurredSky)) {
    e = e.without(Effect::ambientOcclusion);
  }
  if (!e.has(Effect::textures) || !e.has(Effect::emission)) e = e.without(Effect::emissionMaps);
  if (!e.has(Effect::transmission)) e = e.without(Effect::absorption).without(Effect::coverage);
  return e;
}

FeatureSet featuresOf(const Scene& scene, const RenderOptions& options, EffectSet e) {
  const bool maps = e.has(Effect::textures) || e.has(Effect::normalMaps) || e.has(Effect::coverage);
  const bool emission = e.has(Effect::emission);
  const auto any = [&](const auto& is) { return std::ranges::any_of(scene.materials, is); };

  return FeatureSet()
      .with(Feature::ambient,
            (e.has(Effect::ambient) || e.has(Effect::blurredSky)) && !isOccluded(scene.ambient, e))
      .with(Feature::emission, emission)
      .with(Feature::emissionFactors,
            e.has(Effect::emissionMaps) || (emission && e.has(Effect::vertexColors)))
      .with(Feature::vertexColors, e.has(Effect::vertexColors))
      .with(Feature::sky, e.has(Effect::sky))
      .with(Feature::glossy, e.has(Effect::glossy))
      .with(Feature::lobes, any([&](const Material& m) { return m.dimsBelow(e); }))
      .with(Feature::roughnessMaps, e.has(Effect::glossy) && e.has(Effect::textures) &&
                                        any([](const Material& m) { return m.variesRoughness(); }))
      .with(Feature::occlusionMaps, e.has(Effect::textures) && any([](const Material& m) {
                                      return m.occlusionMap != kNoTexture;
                                    }))
      .with(Feature::mirrorMaps,
            e.has(Effect::mirror) && any([&](const Material& m) { return m.variesMirror(e); }))
      .with(Feature::transmissionMaps, e.has(Effect::transmission) && any([&](const Material& m) {
                                         return m.variesTransmission(e);
                                       }))
      .with(Feature::coverage, e.has(Effect::coverage))
      .with(Feature::streams, samplesLobes(e) || e.has(Effect::softShadows) ||
                                  isOccluded(scene.ambient, e) || options.roulette > 0)
      .with(Feature::transmission, e.has(Effect::transmission))
      .with(Feature::absorption, e.has(Effect::absorption))
      .with(Feature::fog, e.has(Effect::fog))
      .with(Feature::instances, e.has(Effect::instances))
      .with(Feature::spheres, e.has(Effect::spheres))
      .with(Feature::coplanar, !scene.coplanar.empty())
      .with(Feature::shadows, e.has(Effect::shadows))
      .with(Feature::spotLights, e.has(Effect::spotLights))
      .with(Feature::smoothNormals, e.has(Effect::smoothNormals))
      // Without vertex normals that differ from their triangles' nothing is to be corrected.
      .with(Feature::shadowOffset,
            options.shading.terminator && e.has(Effect::shadows) && e.has(Effect::smoothNormals))
      .with(Feature::cones, maps && options.shading.textureFilter == TextureFilter::trilinear)
      .with(Feature::ended, keptChannels(options).has(Channel::error))
      .with(Feature::alpha, keptChannels(options).has(Channel::alpha))
      .with(Feature::textures, e.has(Effect::textures))
      .with(Feature::normalMaps, e.has(Effect::normalMaps))
      .with(Feature::secondUvs, maps && !scene.secondUvs.empty());
}

KernelUse useOf(const simd::Kernel& kernel) {
  return {kernel.stage, std::string(kernel.name), simd::chosenTarget()};
}

// A step that is no kernel is counted with the kernel whose columns it amends.
Step amendingStep(std::string_view name, const simd::Kernel& kernel, StepFunction run, Parts reads,
                  Parts writes) {
  return {.name = std::string(name),
          .number = simd::indexOf(kernel),
          .stage = kernel.stage,
          .run = run,
          .reads = reads,
          .writes = writes,
          .kernels = {}};
}

Step stepOf(const simd::Kernel& kernel) {
  Step step = amendingStep(kernel.name, kernel, kernel.find(), kernel.reads, kernel.writes);
  step.kernels = {useOf(kernel)};
  return step;
}

// Rays to Embree and back: one at a time, or in packets that kernels fill and empty.
Step embreeStep(const char* name, const char* call, StepFunction run, const simd::Kernel& pack,
                const simd::Kernel& unpack, bool packets) {
  Step step = amendingStep(name, pack, run, pack.reads, unpack.writes);
  step.kernels = {{pack.stage, call, "embree"}};
  if (packets) step.kernels = {useOf(pack), step.kernels[0], useOf(unpack)};
  return step;
}

class Planner {
 public:
  Planner(const Scene& scene, const RenderOptions& options) : scene_(scene), options_(options) {
    const bool all = options.effects == EffectChoice::all;
    const EffectSet called = all ? EffectSet::all() : scene.effects;
    plan_.effects =
        consistent(scene, called.without(options.disable).without(optionalEffectsOff(options)));
    plan_.features = featuresOf(scene, options, plan_.effects);
    plan_.sampled = plan_.features.has(Feature::streams);
    plan_.channels = keptChannels(options);
  }

  Plan make() {
    plan_.perSample = {stepOf(simd::kGenerateRays)};
    if (has(Effect::transmission)) {
      amend(plan_.perSample, "findInitialMedia", simd::kGenerateRays, findInitialMedia, {rays},
            {rays});
    }

    findIntersections();
    add(plan_.perQueue, simd::kWriteEmittedAndReflectiveAmbient);
    if (seesThrough()) {
      amend(plan_.perQueue, "startAlpha", simd::kWriteEmittedAndReflectiveAmbient, startAlpha,
            {rays, surfels}, {radiance});
    }

    // After startAlpha, which takes the sky away but not the fog before it.
    if (has(Effect::fog)) add(plan_.perQueue, simd::kAddFog);

    if (isOccluded(scene_.ambient, plan_.effects)) addAmbientLight();
    if (has(Effect::lights)) {
      for (const auto i : indices(scene_.lights)) addSamplesOf(i);
    }

    addImpulses();
    if (has(Effect::absorption) || has(Effect::fog)) plan_.atEye = {stepOf(simd::kReturnToEye)};
    if (countsRays()) {
      amend(plan_.atEye, "keepRayCounts", simd::kReturnToEye, keepRayCounts, {rayCounts},
            {channels});
    }
    if (notesEnds()) {
      amend(plan_.atEye, "keepEnds", simd::kReturnToEye, keepEnds, {rays, radiance}, {channels});
    }
    if (seesThrough()) {
      amend(plan_.atEye, "keepAlpha", simd::kReturnToEye, keepAlpha, {rays, radiance}, {channels});
    }

    plan_.perTile = {amendingStep("updateImage", simd::kEncodeDisplay, updateImage,
                                  {radiance, pixels}, {radiance, codes, film})};
    plan_.perTile[0].kernels = {useOf(simd::kEncodeDisplay)};
    markEndsOfStages();
    return std::move(plan_);
  }

 private:
  using enum Part;

  bool has(Effect effect) const { return plan_.effects.has(effect); }
  bool has(Feature feature) const { return plan_.features.has(feature); }
  bool inPackets() const { return options_.packet != 1; }
  bool countsRays() const { return plan_.channels.has(Channel::rays); }
  bool seesThrough() const { return has(Feature::alpha); }
  bool notesEnds() const { return has(Feature::ended); }

  // The kernel is skipped in chunks in which no material has a flag of `wants`; 0: never.
  static void add(std::vector<Step>& steps, const simd::Kernel& kernel, std::uint32_t wants = 0) {
    steps.push_back(stepOf(kernel));
    steps.back().wants = wants;
  }

  static void amend(std::vector<Step>& steps, std::string_view name, const simd::Kernel& kernel,
                    StepFunction run, Parts reads, Parts writes) {
    steps.push_back(amendingStep(name, kernel, run, reads, writes));
  }

  void findIntersections() {
    if (countsRays()) {
      amend(plan_.perQueue, "countRays", simd::kPackRays, countRays, {rays}, {rayCounts});
    }

    plan_.perQueue.push_back(embreeStep("findHits", "intersect", findHits, simd::kPackRays,
                                        simd::kUnpackHits, inPackets()));
    if (has(Feature::coplanar)) {
      amend(plan_.perQueue, "chooseCoplanar", simd::kUnpackHits, chooseCoplanar, {rays, hits},
            {hits});
    }

    // Spheres that move may become coincident at any time.
    const bool coincide = scene_.motion.ofGeometry || !scene_.coincidentSpheres.empty();
    if (has(Effect::spheres) && coincide) {
      amend(plan_.perQueue, "chooseSpheres", simd::kUnpackHits, chooseSpheres, {hits}, {hits});
    }
    if (notesEnds()) {
      amend(plan_.perQueue, "startEnds", simd::kUnpackHits, startEnds, {rays}, {radiance});
    }

    add(plan_.perQueue, simd::kInterpolateSurfels);
    if (has(Feature::roughnessMaps))
      add(plan_.perQueue, simd::kLookUpRoughness, kMaterialVariesRoughness);
    if (has(Feature::coverage)) add(plan_.perQueue, simd::kLookUpCoverage);

    // Channels are kept before findLayers, because the albedo is the material's, whatever the view.
    if (!plan_.channels.empty()) {
      amend(plan_.perQueue, "keepChannels", simd::kInterpolateSurfels, keepChannels,
            {rays, hits, surfels}, {channels});
    }

    if (has(Feature::occlusionMaps)) add(plan_.perQueue, simd::kLookUpOcclusion);
    if (has(Feature::mirrorMaps)) add(plan_.perQueue, simd::kLookUpMirror);
    if (has(Feature::transmissionMaps)) add(plan_.perQueue, simd::kLookUpTransmission);
    if (std::ranges::any_of(scene_.materials,
                            [&](const Material& m) { return m.isLayered(plan_.effects); })) {
      add(plan_.perQueue, simd::kFindLayers, kMaterialLayered);
    }

    if (has(Feature::shadowOffset)) add(plan_.perQueue, simd::kLiftShadowOrigins);
  }

  void addAmbientLight() {
    const std::uint32_t samples = options_.ambientSamples;
    for (std::uint32_t k = 0; k < samples; ++k) {
      LightSteps& ambient =
          startLight(kAmbientLight, k, samples, simd::kFindAmbientAndOcclusionRays);
      ambient.steps.push_back(checkShadowsStep());
      add(ambient.steps, simd::kAddShading);
    }
  }

  LightSteps& startLight(std::size_t light, std::uint32_t sample, std::uint32_t samples,
                         const simd::Kernel& first) {
    LightSteps& started = plan_.perLight.emplace_back();
    started.light = light;
    started.sample = sample;
    started.samples = samples;
    started.steps = {stepOf(first)};
    if (countsRays()) {
      amend(started.steps, "countShadowRays", simd::kFindRadianceAndShadowRays, countShadowRays,
            {shadows}, {rayCounts});
    }
    return started;
  }

  Step checkShadowsStep() const {
    return embreeStep("checkShadows", "occluded", checkShadows, simd::kPackShadowRays,
                      simd::kUnpackVisibility, inPackets());
  }

  void addSamplesOf(std::size_t index) {
    const bool soft = has(Effect::softShadows) && hasExtent(scene_.lights[index]);
    const std::uint32_t count = soft ? options_.lightSamples : 1;
    for (std::uint32_t k = 0; k < count; ++k) addLight(index, k, count);
  }

  void addLight(std::size_t index, std::uint32_t sample, std::uint32_t samples) {
    const bool directional = scene_.lights[index].kind == Light::Kind::directional;
    if (directional && !has(Effect::directionalLights)) return;
    std::vector<Step>& steps =
        startLight(index, sample, samples, simd::kFindRadianceAndShadowRays).steps;
    if (has(Effect::shadows)) steps.push_back(checkShadowsStep());
    add(steps, simd::kAddShading);
  }

  // In the order in which a queue holds its rays, kind by kind.
  void addImpulses() {
    if (has(Effect::mirror)) {
      addImpulse(simd::kAddReflections, kMaterialReflects, RayKind::reflection, 1);
    }
    addLobe(simd::kAddGlossyReflections, kGlossyLobe);
    if (has(Effect::transmission)) {
      addImpulse(simd::kAddRefractions, kMaterialTransmits, RayKind::refraction, 1);
    }
    if (std::ranges::any_of(scene_.materials,
                            [&](const Material& m) { return m.frosts(plan_.effects); })) {
      addLobe(simd::kAddFrostedRefractions, kFrostedLobe);
    }
    addLobe(simd::kAddIndirect, kDiffuseLobe);

    if (options_.depth == 0 && !notesEnds()) plan_.impulses.clear();
    if (plan_.impulses.empty()) return;

    plan_.depth = options_.depth;
    if (seesThrough()) {
      amend(plan_.impulses, "markStraight", simd::kAddRefractions, markStraight, {rays, children},
            {children});
    }
    if (options_.maxRays > 0 && mostImpulses() > options_.maxRays) {
      plan_.limitsRays = true;
      plan_.features = plan_.features.with(Feature::streams);  // paths are told apart by them
      amend(plan_.impulses, "limitRays", simd::kReturnImpulses, limitRays, {rays, children},
            {children});
    }

    plan_.onReturn = {stepOf(simd::kReturnImpulses)};
    if (countsRays()) {
      amend(plan_.onReturn, "returnRayCounts", simd::kReturnImpulses, returnRayCounts,
            {rays, rayCounts}, {});
    }
    if (notesEnds()) {
      amend(plan_.onReturn, "returnEnds", simd::kReturnImpulses, returnEnds, {rays, radiance},
            {parentRadiance});
    }
    if (seesThrough()) {
      amend(plan_.onReturn, "returnAlpha", simd::kReturnImpulses, returnAlpha, {rays, radiance},
            {parentRadiance});
    }

    // Primary rays and the impulses of mirrors and glass are coherent at first; Embree then
    // traverses packets as frustums, to the same bits. Samples of lobes never are: declaring them
    // incoherent reduced the time of frames with 8 of them to 0.7. Embree leads the rays of an
    // incoherent packet through the BVH one by one. That is slower where the BVH is so small that
    // all rays visit most of it anyway: there even deep impulses count as coherent (whitted takes
    // 0.93 of the time, glass with its 38,000 triangles 1.2 times as long). Sorting rays by origin
    // and direction before they are packed gains nothing on AVX2 and AVX-512 (glass, whitted, tiles
    // of 32 to 256).
    constexpr std::size_t kFewSurfaces = 1000;
    const std::size_t surfaces = scene_.triangles.size() + scene_.instances.size();
    plan_.coherentDepth = surfaces <= kFewSurfaces ? 10 : 4;
    if (samplesLobes(plan_.effects)) plan_.coherentDepth = 0;
  }

  // Upper bound on the impulses of a sample.
  double mostImpulses() const {
    double ofDepth = 0, all = 0, kinds = 0;
    for (const Step& step : plan_.impulses) {
      ofDepth += static_cast<double>(step.childrenAt(0));
      kinds += static_cast<double>(step.childrenAt(1));
    }
    if (choosesLobe(plan_.effects)) kinds -= 1;
    for (int depth = 0; depth < options_.depth; ++depth) {
      all += ofDepth;
      ofDepth *= kinds;
    }
    return all;
  }

  void addLobe(const simd::Kernel& kernel, const Lobe& lobe) {
    if (!has(lobe.effect)) return;
    addImpulse(kernel, lobe.flag, lobe.kind, lobe.samples(options_));
  }

  void addImpulse(const simd::Kernel& kernel, std::uint32_t flag, RayKind kind, std::size_t atEye) {
    Step step = stepOf(kernel);
    step.wants = flag;
    step.childKind = kind;
    step.childrenAtEye = atEye;
    plan_.impulses.push_back(std::move(step));
  }

  void markEndsOfStages() {
    const auto mark = [](std::vector<Step>& steps) {
      for (const auto i : indices(steps)) {
        steps[i].endsStage = i + 1 == steps.size() || steps[i + 1].stage != steps[i].stage;
      }
    };
    for (auto* list : {&plan_.perSample, &plan_.perQueue, &plan_.impulses, &plan_.onReturn,
                       &plan_.atEye, &plan_.perTile}) {
      mark(*list);
    }
    for (LightSteps& light : plan_.perLight) mark(light.steps);
  }

  const Scene& scene_;
  const RenderOptions& options_;
  Plan plan_;
};

// Each step reads only what a step before it has written, or what is there from the start.
void requireOrder(const Plan& plan) {
  Parts written{Part::pixels};
  plan.forEachStep([&](const Step& step) {
    if (!written.holds(step.reads)) {
      throw std::logic_error("step " + step.name + " reads what no step before it writes");
    }
    written = written.with(step.writes);
    if (step.childrenAtEye > 0) written = written.with(Part::parentRadiance);
  });
}

}  // namespace

std::vector<Stage> Plan::stages() const {
  std::vector<Stage> list;
  forEachStep([&](const Step& step) {
    if (!contains(list, step.stage)) list.push_back(step.stage);
  });
  return list;
}

Plan makePlan(const Scene& scene, const RenderOptions& options) {
  Plan plan = Planner(scene, options).make();
  requireOrder(plan);
  return plan;
}

std::vector<KernelUse> kernelsOf(const Plan& plan) {
  std::vector<KernelUse> uses;
  plan.forEachStep([&](const Step& step) {
    for (const KernelUse& use : step.kernels) {
      if (!contains(uses, use)) uses.push_back(use);
    }
  });
  // Lights begin with different kernels of the same stage.
  std::ranges::stable_sort(
      uses, [](const KernelUse& a, const KernelUse& b) { return a.stage < b.stage; });
  return uses;
}

}  // namespace whit
