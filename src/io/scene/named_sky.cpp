#include "io/scene/named_sky.h"

#include "io/image/image_file.h"
#include "io/image/texture_from_image.h"
#include "make/studio_sky.h"

namespace whit {

Sky namedSky(const std::string& name, std::uint64_t mostBytes, Warnings& warnings) {
  if (name == kStudio) return studioSky();
  Sky sky;
  if (name == kNoSky) return sky;
  MemoryBudget budget(mostBytes);
  ImageLimits limits;
  limits.budget = &budget;
  sky.kind = Sky::Kind::image;
  sky.name = name;
  sky.image = makeEnvironment(readRawImage(name, limits, warnings));
  return sky;
}

}  // namespace whit
