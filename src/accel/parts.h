// What an Accel holds.
#pragma once

#include <string>

#include "accel/embree_scene.h"

namespace whit {

struct Accel::Parts {
  Parts(const Scene& scene, const AccelOptions& options, Progress* progress)
      : embree(scene, options, progress) {}
  // The width of a packet of shadow rays.
  int shadowPacket(bool coherent) const {
    return coherent && embree.coherentOcclusionMayHang(packet) ? 8 : packet;
  }

  EmbreeScene embree;
  int packet = 8;
  std::string description;
};

}  // namespace whit
