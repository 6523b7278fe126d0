// What `whit info` tells, for its table and its JSON alike.
#pragma once

#include <string>
#include <vector>

#include "render/renderer.h"

namespace whit::cli {

struct EffectRow {
  std::string name;
  bool on = false;
  std::string because;
};
// Every effect, in the order of core/effects.h; "disabled by --disable" overrides the scene's
// reason.
std::vector<EffectRow> effectRows(const Scene& scene, const RenderOptions& options);

// Scene, tables, queues and acceleration structure, in 10^6 bytes.
double memoryMb(const Scene& scene, const Renderer& renderer);

}  // namespace whit::cli
