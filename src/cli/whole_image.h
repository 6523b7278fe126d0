// Whether a picture needs to be traced: what --resume asks of a file that is there.
#pragma once

#include <string>

#include "core/image.h"
#include "core/options.h"
#include "io/image/image_file.h"

namespace whit::cli {

// Whether `path` (.exr or .png) is what a render into `image` would write: there, readable to its
// last byte, and made with the same options of a scene with the same contents, as far as `expected`
// tells of them. What the options leave to the machine (--simd auto, --packet auto) may differ.
// Throws Error(io) when it is there but cannot be read.
bool isWhole(const std::string& path, const Image& image, const ImageMetadata& expected,
             const RenderOptions& options);

}  // namespace whit::cli
