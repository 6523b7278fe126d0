// Edits of materials and lights as settings of the scene.
#pragma once

#include <string>
#include <vector>

#include "viewer/traced_frame.h"

namespace whit::view {

// What differs between a scene as it was read and as it was edited, as values of --set: read again
// with these as well, it has the same materials and lights, bit for bit.
std::vector<std::string> editSettings(const ShadingEdit& read, const ShadingEdit& edited);

}  // namespace whit::view
