// Makes the sky that --sky names.
#pragma once

#include <cstdint>
#include <string>

#include "core/warnings.h"
#include "scene/light.h"

namespace whit {

inline constexpr const char* kNoSky = "none";

// kNoSky, "studio" (scene/studio_sky.h) or the file of an equirectangular image, of which the
// decoded texels and the file take `mostBytes` at most. Throws as readRawImage() does.
Sky namedSky(const std::string& name, std::uint64_t mostBytes, Warnings& warnings);

}  // namespace whit
