// Digests of everything that a picture depends on: 128 bits of XXH3 as 32 hexadecimal digits.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "bake/scene.h"
#include "core/image.h"
#include "core/options.h"

namespace whit::accuracy {

// Covers every table of the finalized scene that a picture can depend on, but not its name, its own
// size, its cameras and the reasons for its effects: a picture takes these from its options and
// from its camera.
std::string digestOf(const Scene& scene);
// Covers every option that can change a picture, except for the name of the preset, which stands
// for values of the others.
std::string digestOf(const RenderOptions& options);
std::string digestOf(const Camera& camera);
// Covers the texts and their lengths.
std::string digestOf(std::initializer_list<std::string_view> texts);
// Covers size, window and the bits of all pixels.
std::string digestOf(const Image& image);
// The digest of the file of the running program; "unknown" if it cannot be read.
std::string digestOfProgram();

}  // namespace whit::accuracy
