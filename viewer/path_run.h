// Flies the scene's camera path frame by frame: --benchmark and --record.
#pragma once

#include <memory>

#include "viewer/window.h"

namespace whit::cli {
struct OpenScene;
}

namespace whit::view {

struct ViewOptions;

// Shows kBenchmarkFrames frames along the path (around the point looked at, if there is none) as
// fast as they come, and prints to standard output what tracing and displaying took. Then presses
// keys at rest and in motion, and prints how soon the picture changed.
void runBenchmark(const ViewOptions& options, const std::shared_ptr<cli::OpenScene>& scene,
                  Window& window);
inline constexpr int kBenchmarkFrames = 120;

// Writes the path's frames as NAME/frame-NNNN.png, 24 a second, while showing them. Throws
// Error(usage) when the scene has no path.
void recordPath(const ViewOptions& options, const cli::OpenScene& scene, Window& window);

}  // namespace whit::view
