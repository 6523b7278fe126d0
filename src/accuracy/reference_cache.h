// The pictures that points are measured against, rendered once and kept in files: those of the
// scalar reference and the picture with all transport.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "accuracy/measurement.h"
#include "bake/scene.h"
#include "core/image.h"
#include "core/options.h"
#include "core/progress.h"

namespace whit::accuracy {

struct ReferencePicture {
  Image image;
  std::string digest;     // covers everything that the picture depends on; the file's name
  double renderMs = 0;    // the time that rendering took
  double rays = 0;        // number of rays
  bool fromFile = false;  // rendered by an earlier run
};

// The picture with all light that whit can transport. Packets render it in several passes of
// independent noise. The reference in double would take a hundred times as long, so that its noise
// would be far above the rounding errors that it avoids.
struct TransportPicture : TransportFacts {
  Image image;
};

// The number of passes of the picture with all transport; even, so that both halves are alike.
inline constexpr int kTransportPasses = 8;

// The mean of independent pictures of one view, which differ in their noise, and its error.
class PassMean {
 public:
  void add(const Image& pass) { passes_.push_back(pass); }

  // Needs one pass or more.
  Image mean() const { return picture(0, 1); }
  // The mean of the passes with even or odd numbers, to tell how visible noise is. Needs two passes
  // or more.
  Image half(bool odd) const { return picture(odd ? 1 : 0, 2); }
  // The standard error of the mean in linear radiance: the root mean square over pixels and
  // channels. Needs two passes or more.
  double standardError() const;
  // The mean over pixels and channels.
  double meanRadiance() const;

 private:
  // The means of every step-th pass, from `first` on.
  std::vector<RgbD> means(std::size_t first, std::size_t step) const;
  Image picture(std::size_t first, std::size_t step) const;

  std::vector<Image> passes_;
};

// Files are named by a digest of scene tables, camera, options, image window and program. A file
// with another digest, or one that cannot be read, is rendered again.
class ReferenceCache {
 public:
  // Makes `folder` if it does not exist. `program` identifies the code that renders, including
  // Embree and the compiler.
  ReferenceCache(const Scene& scene, const Camera& camera, std::string folder,
                 const std::string& program);

  // `options` must have Mode::reference. Throws Error(io) when the folder cannot be written.
  const ReferencePicture& get(const RenderOptions& options, Progress* progress);

  // The mean of kTransportPasses passes with these options, which must have Mode::packets; each has
  // options.spp samples. Throws Error(io) when the folder cannot be written.
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
