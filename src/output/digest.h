// Digests of everything that a picture depends on: 128 bits of XXH3 as 32 hexadecimal digits.
#pragma once

#include <string>

#include "bake/scene.h"
#include "core/image.h"
#include "core/options.h"

namespace whit {

// Covers every table of the finalized scene that a picture can depend on, but not its name, its own
// size, its cameras and the reasons for its effects: a picture takes these from its options and
// from its camera.
std::string digestOf(const Scene& scene);
// Covers every option that can change a picture, except for the name of the preset, which stands
// for values of the others.
std::string digestOf(const RenderOptions& options);
// Covers size, window and the bits of all pixels.
std::string digestOf(const Image& image);

}  // namespace whit
