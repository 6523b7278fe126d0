// The rays of a pixel that the user points at: the question to the tracing thread, and its answer.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/app/explained_rays.h"
#include "cli/app/open_scene.h"
#include "inspect/ray_lines.h"

namespace whit::view {

struct RayQuery {
  Camera camera;
  RenderOptions options;  // as for a whole picture; the size must be there
  int x = 0, y = 0;       // from the top left
  int reloads = 0, edits = 0;
  std::optional<double> seconds;  // of the picture on screen; the answer is that of the scene's
};

// Whether the answer to one is that to the other.
inline bool sameRays(const RayQuery& a, const RayQuery& b) {
  return sameView(a.camera, b.camera) && a.options == b.options && a.x == b.x && a.y == b.y &&
         a.reloads == b.reloads && a.edits == b.edits && a.seconds == b.seconds;
}

// Of a node. The scene itself may be edited by the time that they are read.
struct RayWords {
  std::string met, medium;
  std::string parting;              // empty: here the reference does not part
  std::vector<std::string> lights;  // by name, as the node has them
};

struct RayPick {
  std::shared_ptr<const cli::OpenScene> scene;  // null: nothing was picked
  RayQuery query;
  cli::ExplainedRays rays;
  std::vector<RayWords> words;  // of the packets' nodes
  std::vector<RayLine> lines;   // of the packets
};

}  // namespace whit::view
