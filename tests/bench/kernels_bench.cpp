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
};

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
      {"addRefractions", [](BenchTile& t) { t.refract(t.reflections); }, tileRays},
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

// Absorption changes the rays' weights in place, so interpolateSurfels is not run again on glass.
bool repeats(const BenchTile& tile, const Job& job) {
  return job.kernel != "interpolateSurfels" || !tile.plan().effects.has(Effect::absorption);
}

int runAll() {
  std::vector<std::unique_ptr<BenchTile>> tiles;
  std::vector<std::map<std::string, std::string>> verdicts(2);
  for (const std::string scene : {"atrium", "glass"}) {
    tiles.push_back(std::make_unique<BenchTile>(scene));
    BenchTile& tile = *tiles.back();
    auto& known = verdicts[tiles.size() - 1];
    for (const Job& job : jobs()) {
      const bool refracts = job.kernel == "addRefractions";
      if ((scene == "glass") != refracts || !repeats(tile, job)) continue;
      for (const std::string& target : simd::availableTargets()) {
        const std::string name = job.kernel + "/" + scene + "/" + target;
        benchmark::RegisterBenchmark(name.c_str(), [&tile, &job, &known, target](auto& state) {
          time(state, tile, job, target, known);
        });
      }
    }
  }
  benchmark::RunSpecifiedBenchmarks();
  for (const auto& scene : verdicts) {
    for (const auto& [target, verdict] : scene) {
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
