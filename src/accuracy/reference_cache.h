// Pictures of the scalar reference, rendered once and kept in files.
#pragma once

#include <map>
#include <string>

#include "core/image.h"
#include "core/options.h"
#include "core/progress.h"
#include "scene/scene.h"

namespace whit::accuracy {

struct ReferencePicture {
  Image image;
  std::string digest;     // of all that it depends on; the file's name
  double renderMs = 0;    // what it took when it was rendered
  double rays = 0;        // that it took
  bool fromFile = false;  // rendered by an earlier run
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

  std::string digest(const RenderOptions& options) const;

 private:
  const Scene& scene_;
  Camera camera_;
  std::string folder_, sceneDigest_;
  std::map<std::string, ReferencePicture> pictures_;
};

}  // namespace whit::accuracy
