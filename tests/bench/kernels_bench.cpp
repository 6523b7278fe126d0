// Times each step of the plan by the ray, for every SIMD target of this machine; steps that call
// Embree are timed with it, and the kernels that fill and empty its packets once more alone:
//   build/tests/kernels_bench [--benchmark_filter=interpolate] [...]
// Before it is timed, a target's kernels are compared with their scalar reference; afterwards its
// columns must still hold the same bits.
#include <benchmark/benchmark.h>

#include <array>
#include <functional>
#include <map>
#include <memory>

#include "bench/bench_tile.h"
#include "inspect/stage_comparison.h"
#include "io/load_scene.h"

namespace whit::bench {
namespace {

// Scenes in which, taken together, every step runs, some only because of an option.
struct Input {
  std::string scene;
  bool terminator = false;
  int glossy = 0, indirect = 0, ambientSamples = 0;
};
const std::array kInputs{Input{"atrium"},
                         Input{"glass"},
                         Input{"atrium", true},
                         Input{"glossy", false, 4},
                         Input{"cornell", false, 0, 4},
                         Input{"cornell", false, 0, 0, 4}};

RenderOptions optionsOf(const Input& input) {
  RenderOptions options;
  options.shading.terminator = input.terminator;
  options.glossy = input.glossy;
  options.indirect = input.indirect;
  options.ambientSamples = input.ambientSamples;
  return options;
}

// Packets of 16 between columns and Embree, as in findHits and checkShadows.
class PacketBench {
 public:
  explicit PacketBench(const Chunk& chunk)
      : chunk_(chunk), words_(kTileRays / kPacket * kWords), hits_(kTileRays, FeatureSet()) {}

  // Calls visit(name of the kernel, function that runs it, number of rays) for each kernel.
  template <typename Visitor>
  void forEachKernel(Visitor&& visit) {
    const simd::PacketKernels kernels = simd::findPacketKernels();
    const PacketWords words{words_.data(), kWords, kPacket};

    visit(
        "packRays", [=, this] { kernels.packRays(chunk_.rays, chunk_.n, kReach, words); },
        chunk_.n);
    visit(
        "unpackHits", [=, this] { kernels.unpackHits(words, chunk_.n, kBase.data(), *hits_); },
        chunk_.n);
    visit(
        "packShadowRays",
        [=, this] { kernels.packShadowRays(chunk_.shadows, chunk_.shadowCount, kReach, words); },
        chunk_.shadowCount);
    visit(
        "unpackVisibility",
        [=, this] {
          kernels.unpackVisibility(words, chunk_.shadowCount, chunk_.shadows.slot, hits_->t);
        },
        chunk_.shadowCount);
  }

 private:
  static constexpr std::size_t kPacket = 16, kWords = 20 * kPacket;
  static constexpr float kReach = 1e10f;  // far end of all rays
  static constexpr std::array<std::uint32_t, kTriangleClasses> kBase{0, 1, 2, 3};
  const Chunk& chunk_;
  std::vector<float> words_;
  ColumnStore<HitColumns> hits_;
};

// Returns which stage differs how much from the scalar reference, or nothing if none does.
std::string referenceDiffers(BenchTile& tile) {
  for (const StageDifference& row :
       compareStages(tile.renderer(), tile.camera(), tile.smallFilm())) {
    if (row.worstUlp <= row.limitUlp) continue;
    return std::string(kStageNames[static_cast<std::size_t>(row.stage)]) + " " + row.column +
           " differs from its scalar by " + std::to_string(row.worstUlp) + " ulp";
  }
  return {};
}

// A tile, which is made when it is first needed, and what is wrong with its kernels; empty if
// nothing is.
struct Subject {
  Input input;
  const Scene& scene;
  std::vector<std::uint32_t>& pixels;  // pixels of the input's tile, which the first target chooses
  std::string target;
  std::unique_ptr<BenchTile> tile;
  std::string verdict;

  BenchTile& made() {
    if (!tile) {
      tile = std::make_unique<BenchTile>(scene, target, optionsOf(input), pixels);
      pixels = tile->pixels();
      verdict = referenceDiffers(*tile);
      simd::chooseTarget(target);
    }
    return *tile;
  }
};

void time(benchmark::State& state, Subject& subject, const std::function<void()>& run,
          std::size_t rays) {
  if (!subject.verdict.empty()) return state.SkipWithError(subject.verdict.c_str());
  BenchTile& tile = subject.made();

  tile.run();
  // The timed kernel must leave the columns as a plain run of the tile does.
  const std::vector<std::uint32_t> expected = tile.bits();
  for (auto _ : state) run();

  tile.run();
  if (tile.bits() != expected) {
    subject.verdict = "the same input gave other bits";
    return state.SkipWithError(subject.verdict.c_str());
  }

  state.counters["per_ray"] =
      benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsIterationInvariantRate |
                                                        benchmark::Counter::kInvert);
}

void registerOne(const std::string& kernel, Subject& subject, const std::function<void()>& run,
                 std::size_t rays) {
  const std::string name = kernel + "/" + subject.input.scene + "/" + subject.target;
  benchmark::RegisterBenchmark(
      name.c_str(), [&subject, run, rays](auto& state) { time(state, subject, run, rays); });
}

// Registers the steps of the subject's plan that no input before it had.
void registerAll(Subject& subject, std::vector<std::string>& known) {
  BenchTile& tile = subject.made();
  tile.plan().forEachStep([&](const Step& step) {
    const std::string name = step.name + "/" + subject.target;
    if (contains(known, name)) return;
    known.push_back(name);

    registerOne(
        step.name, subject,
        [&tile, &step] {
          Chunk chunk = tile.chunkFor(step);
          step.run(chunk);
        },
        tile.raysOf(step));
  });
}

Scene load(const std::string& name) {
  Warnings warnings;
  return Scene::finalize(loadScene(name, LoadOptions{}, warnings), warnings);
}

int runAll() {
  std::map<std::string, Scene> scenes;
  std::map<const Input*, std::vector<std::uint32_t>> pixels;
  std::vector<std::unique_ptr<Subject>> subjects;
  std::vector<std::unique_ptr<PacketBench>> packets;
  std::vector<std::string> known;

  for (const Input& input : kInputs) {
    if (!scenes.contains(input.scene)) scenes.emplace(input.scene, load(input.scene));
    const Scene& scene = scenes.at(input.scene);
    for (const std::string& target : simd::availableTargets()) {
      Subject& subject =
          *subjects.emplace_back(new Subject{input, scene, pixels[&input], target, nullptr, {}});
      registerAll(subject, known);

      // The packet kernels are timed on the first input only.
      if (&input != kInputs.data()) continue;
      simd::chooseTarget(target);
      packets.emplace_back(new PacketBench(subject.made().chunk()))
          ->forEachKernel([&](const char* name, const std::function<void()>& run,
                              std::size_t rays) { registerOne(name, subject, run, rays); });
    }
  }

  benchmark::RunSpecifiedBenchmarks();
  for (const auto& subject : subjects) {
    if (!subject->verdict.empty()) return 1;
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
