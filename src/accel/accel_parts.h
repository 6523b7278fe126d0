// The members of an Accel. They are not in accel.h, so that no other file sees Embree.
#pragma once

#include <string>

#include "accel/accel.h"
#include "accel/embree_scene.h"
#include "simd/kernels.h"

namespace whit {

struct Accel::Parts {
  Parts(const Scene& scene, const AccelOptions& options, Progress* progress)
      : embree(scene, options, progress) {}

  // The width of a packet of shadow rays.
  int shadowPacket(bool coherent) const {
    return coherent && embree.coherentAnyHitMayHang(packet) ? 8 : packet;
  }
  // True if Embree should lead packets of this width through its BVH several at a time.
  bool together(int width, bool coherent) const {
    return coherent && embree.streamWidth() == width;
  }

  EmbreeScene embree;
  simd::PacketKernels kernels = simd::findPacketKernels();
  int packet = 8;
  std::string description;
};

}  // namespace whit
