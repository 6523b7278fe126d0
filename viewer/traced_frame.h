// What is asked of the tracing thread, and what comes back.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "cli/open_scene.h"
#include "io/image_file.h"
#include "render/renderer.h"

namespace whit::view {

struct FrameRequest {
  Camera camera;
  ImageSize size;
  int spp = 1;
  float exposure = 0;
  ToneCurve toneCurve = ToneCurve::none;
  EffectSet disable;
  int reloads = 0;             // of the scene before it
  bool interruptible = false;  // given up when another one is asked for
};

// Whether both ask for the same picture.
inline bool samePicture(const FrameRequest& a, const FrameRequest& b) {
  return a.camera.eye == b.camera.eye && a.camera.at == b.camera.at && a.camera.up == b.camera.up &&
         a.camera.fov == b.camera.fov && a.size == b.size && a.spp == b.spp &&
         a.exposure == b.exposure && a.toneCurve == b.toneCurve && a.disable == b.disable &&
         a.reloads == b.reloads;
}

struct TracedFrame {
  std::shared_ptr<const cli::OpenScene> scene;  // null: nothing traced yet
  FrameRequest request;
  RenderOptions options;  // the picture's, size and viewpoint included
  Film film;
  FrameStats stats;
  ImageMetadata metadata;
  EffectSet effects;  // that were traced
  Machine machine;
  std::uint64_t triangles = 0;
};

}  // namespace whit::view
