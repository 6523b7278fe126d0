#include "accuracy/points.h"

#include <algorithm>
#include <cstdlib>

#include "core/option_table.h"
#include "core/text.h"
#include "output/digest.h"

namespace whit::accuracy {

namespace {

RenderOptions presetOf(const RenderOptions& base, const std::string& quality) {
  RenderOptions options = base;
  setOption(options, "quality", quality);
  applyQuality(options, {});
  return options;
}

// Adds a point, unless an earlier one has its options.
void addPoint(std::vector<Point>& points, PointKind kind, const std::string& knob,
              const std::string& value, std::optional<Cause> cause, const RenderOptions& options,
              bool minor = false) {
  // Two points with equal options would have the same picture and the same time.
  const std::string digest = digestOf(options);
  for (const Point& earlier : points) {
    if (digestOf(earlier.options) == digest) return;
  }

  Point& point = points.emplace_back();
  point.kind = kind;
  point.knob = knob;
  point.value = value;
  point.cause = cause;
  point.options = options;
  point.minor = minor;
}

// True if the knob's values are plain numbers of samples of pixels, lobes or lights.
bool countsSamples(const Knob& knob) {
  return std::ranges::all_of(knob.values, [](const KnobValue& value) {
    const bool whole = value.label.find_first_not_of("0123456789") == std::string::npos;
    return whole && value.prerequisites.empty();
  });
}

// The largest value of the knob that is at most `other`, or its first value.
const KnobValue& atMost(const Knob& knob, const KnobValue& other) {
  const auto number = [](const KnobValue& v) { return std::strtod(v.label.c_str(), nullptr); };
  const KnobValue* best = &knob.values.front();
  for (const KnobValue& value : knob.values) {
    if (number(value) <= number(other) && number(value) > number(*best)) best = &value;
  }
  return *best;
}

}  // namespace

PointList makePoints(const RenderOptions& base, EffectSet effects, const std::vector<Knob>& knobs) {
  PointList list;
  const bool standard = digestOf(base) == digestOf(presetOf(base, "standard"));
  addPoint(list.points, PointKind::baseline, "", standard ? "standard" : "baseline", {}, base);

  // The presets of --quality compare with the single options below.
  for (const QualityPreset& preset : qualityPresets()) {
    addPoint(list.points, PointKind::preset, "quality", preset.name, {},
             presetOf(base, preset.name));
  }

  // A knob that has no effect in this scene is listed as idle, with the reason.
  for (const Knob& knob : knobs) {
    const std::string because = knob.idle(effects);
    if (!because.empty()) {
      list.idle.push_back({knob.name, because});
      continue;
    }

    for (const KnobValue& value : knob.values) {
      const std::string unable = value.idle(effects);
      if (!unable.empty()) {
        list.idle.push_back({knob.name + "=" + value.label, unable});
        continue;
      }

      RenderOptions options = base;
      value.apply(options);
      addPoint(list.points, PointKind::knob, knob.name, value.label, knob.cause, options,
               value.minor);
    }
  }
  return list;
}

std::vector<Knob> knobsTowardsTransport() {
  std::vector<Knob> knobs;
  for (const Knob& knob : allKnobs()) {
    if (knob.cause == Cause::transport || (knob.cause == Cause::sampling && countsSamples(knob))) {
      knobs.push_back(knob);
    }
  }
  return knobs;
}

void addTransportPoints(const RenderOptions& base, EffectSet effects,
                        const std::vector<Knob>& knobs, PointList& list) {
  const auto activeOf = [&](Cause cause) {
    // The presets below vary the samples of a pixel, so --spp is not among the knobs.
    std::vector<Knob> chosen;
    for (const Knob& knob : knobs) {
      const bool active = knob.cause == cause && countsSamples(knob) && knob.idle(effects).empty();
      if (active && knob.name != "spp") chosen.push_back(knob);
    }
    return chosen;
  };

  const std::vector<Knob> samplings = activeOf(Cause::sampling);
  for (const Knob& transport : activeOf(Cause::transport)) {
    for (const KnobValue& light : transport.values) {
      for (const QualityPreset& preset : qualityPresets()) {
        // Only the samples of a pixel come from the preset; other options stay those of the
        // baseline.
        RenderOptions options = base;
        options.spp = presetOf(base, preset.name).spp;
        light.apply(options);
        if (!hasTransport(options)) continue;

        const std::string samples = options.spp == base.spp ? "" : concat("spp=", options.spp, " ");
        std::string label = samples + transport.name + "=" + light.label;
        addPoint(list.points, PointKind::joint, "", label, {}, options);

        // A second point has up to as many samples of each lobe and light as of indirect light.
        for (const Knob& knob : samplings) {
          const KnobValue& samplesOfKnob = atMost(knob, light);
          samplesOfKnob.apply(options);
          label += " " + knob.name + "=" + samplesOfKnob.label;
        }
        addPoint(list.points, PointKind::joint, "", label, {}, options);
      }
    }
  }
}

}  // namespace whit::accuracy
