// What each kernel takes a ray, for every SIMD target of this machine:
//   build/tests/kernels_bench [--benchmark_filter=interpolate] [...]
// Before it is timed, a target's kernels are compared with their scalar twins; afterwards its
// columns must still hold the same bits.
#include <benchmark/benchmark.h>

#include <functional>
#include <map>
#include <utility>

#include "bench/bench_tile.h"

namespace whit::bench {
namespace {

struct Job {
  std::string kernel;
  std::function<void(BenchTile&)> run;
  std::function<std::size_t(const BenchTile&)> rays;
  std::string tile = "atrium";
};

// Scenes with what kernels do by choice only.
constexpr const char *kLifted = "atrium, --terminator on", *kScattering = "glossy, --glossy 4";

RenderOptions optionsOf(const std::string& tile) {
  RenderOptions options;
  options.shading.terminator = tile == kLifted;
  options.glossy = tile == kScattering ? 4 : 0;
  return options;
}

std::size_t tileRays(const BenchTile& tile) { return tile.n(); }

const std::vector<Job>& jobs() {
  static const std::vector<Job> list{
      {"generateRays", [](BenchTile& t) { t.generate(); }, tileRays},
      {"packRays", [](BenchTile& t) { simd::packRays(*t.rays, t.n(), kReach, t.packets()); },
       tileRays},
      {"unpackHits",
       [](BenchTile& t) { simd::unpackHits(t.packets(), t.n(), t.triangleBase, *t.unpacked); },
       tileRays},
      {"interpolateSurfels", [](BenchTile& t) { t.interpolate(); }, tileRays},
      {"writeEmittedAndReflectiveAmbient", [](BenchTile& t) { t.writeEmitted(); }, tileRays},
      {"findRadianceAndShadowRays", [](BenchTile& t) { t.findShadowRays(); }, tileRays},
      {"packShadowRays",
       [](BenchTile& t) { simd::packShadowRays(*t.shadows, t.shadowCount, kReach, t.packets()); },
       [](const BenchTile& t) { return t.shadowCount; }},
      {"unpackVisibility",
       [](BenchTile& t) {
         simd::unpackVisibility(t.packets(), t.shadowCount, t.shadows->slot, t.unpackedVisible());
       },
       [](const BenchTile& t) { return t.shadowCount; }},
      {"addShading", [](BenchTile& t) { simd::addShading(*t.unshadowed, t.n(), *t.radiance); },
       tileRays},
      {"addReflections", [](BenchTile& t) { t.reflect(); }, tileRays},
      {"addRefractions", [](BenchTile& t) { t.refract(t.reflections); }, tileRays, "glass"},
      {"liftShadowOrigins", [](BenchTile& t) { t.lift(); }, tileRays, kLifted},
      {"addGlossyReflections", [](BenchTile& t) { t.scatter(); }, tileRays, kScattering},
      {"returnImpulses",
       [](BenchTile& t) {
         simd::returnImpulses(*t.children, *t.radiance, t.reflections, *t.radiance);
       },
       [](const BenchTile& t) { return t.reflections; }},
      {"encodeDisplay",
       [](BenchTile& t) {
         simd::encodeDisplay(1, ToneCurve::none, SrgbEncoding::exact, *t.radiance, t.n(),
                             t.codes.data());
       },
       tileRays},
  };
  return list;
}

// Empty, or which stage is how far from its twin.
std::string twinsDiffer(BenchTile& tile) {
  for (const StageDifference& row : compareStages(tile.renderer(), tile.camera(), tile.film())) {
    if (row.worstUlp <= row.limitUlp) continue;
    return std::string(kStageNames[static_cast<std::size_t>(row.stage)]) + " " + row.column +
           " differs from its twin by " + std::to_string(row.worstUlp) + " ulp";
  }
  return {};
}

void time(benchmark::State& state, BenchTile& tile, const Job& job, const std::string& target,
          std::map<std::string, std::string>& verdicts) {
  simd::chooseTarget(target);
  const auto known = verdicts.find(target);
  const std::string verdict = known != verdicts.end() ? known->second : twinsDiffer(tile);
  verdicts[target] = verdict;
  if (!verdict.empty()) return state.SkipWithError(verdict.c_str());
  tile.run();
  const std::vector<std::uint32_t> expected = tile.bits();
  for (auto _ : state) job.run(tile);
  tile.run();
  if (tile.bits() != expected) {
    verdicts[target] = job.kernel + ": the same input gave other bits";
    return state.SkipWithError(verdicts[target].c_str());
  }
  const auto rays = static_cast<double>(job.rays(tile));
  state.counters["per_ray"] = benchmark::Counter(
      rays, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

int runAll() {
  struct Input {
    std::unique_ptr<BenchTile> tile;
    std::map<std::string, std::string> verdicts;
  };
  std::map<std::string, Input> inputs;
  for (const Job& job : jobs()) {
    Input& input = inputs[job.tile];
    const std::string scene = job.tile.substr(0, job.tile.find(','));
    if (!input.tile) input.tile = std::make_unique<BenchTile>(scene, optionsOf(job.tile));
    for (const std::string& target : simd::availableTargets()) {
      const std::string name = job.kernel + "/" + scene + "/" + target;
      benchmark::RegisterBenchmark(name.c_str(), [&input, &job, target](auto& state) {
        time(state, *input.tile, job, target, input.verdicts);
      });
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  for (const auto& [name, input] : inputs) {
    for (const auto& [target, verdict] : input.verdicts) {
      if (!verdict.empty()) return 1;
    }
  }
  return 0;
}

}  // namespace
}  // namespace whit::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  return whit::bench::runAll();
}
