// Pictures that others are measured against, rendered once and kept in files: those of the scalar
// reference, and those with all transport.
#pragma once

#include <map>
#include <string>

#include "bake/scene.h"
#include "core/image.h"
#include "core/options.h"
#include "core/progress.h"

namespace whit::accuracy {

struct ReferencePicture {
  Image image;
  std::string digest;     // of all that it depends on; the file's name
  double renderMs = 0;    // what it took when it was rendered
  double rays = 0;        // that it took
  bool fromFile = false;  // rendered by an earlier run
};

// With all light that whit can transport, by packets in several passes of independent noise. The
// reference, in double, would take a hundred times as long: it would have that much more noise,
// which is far above what rounding does (compare standardError with the arithmetic error of a
// sweep).
struct TransportPicture {
  Image image;
  std::string digest;
  int passes = 0, samples = 0;  // samples a pixel, of all passes together
  double standardError = 0;     // PassMean's
  double meanRadiance = 0;
  double noiseFlip = 0;  // mean FLIP between the even passes and the odd ones
  double renderMs = 0;
  bool fromFile = false;
};

// A file is used only if its digest covers the same scene tables, camera, options, image window and
// program, bit for bit. One that cannot be read is rendered again.
class ReferenceCache {
 public:
  // `folder` is made if it is not there; `program` identifies the code that renders, Embree and
  // compiler included.
  ReferenceCache(const Scene& scene, const Camera& camera, std::string folder,
                 const std::string& program);

  // `options` must be of Mode::reference. Throws Error(io) when the folder cannot be written.
  const ReferencePicture& get(const RenderOptions& options, Progress* progress);

  // The mean of kTransportPasses passes with these options, of Mode::packets, each with
  // options.spp samples. Throws likewise.
  TransportPicture transport(const RenderOptions& options, Progress* progress) const;

  std::string digest(const RenderOptions& options) const;

 private:
  std::string pathOf(const std::string& digest) const;

  const Scene& scene_;
  Camera camera_;
  std::string folder_, sceneDigest_;
  std::map<std::string, ReferencePicture> pictures_;
};

}  // namespace whit::accuracy
