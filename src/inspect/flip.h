// FLIP, for pictures as they are displayed (LDR-FLIP).
#pragma once

#include <vector>

#include "core/image.h"

namespace whit {

// Computes FLIP for two encoded images of the same size.
std::vector<float> flipOfCodes(const DisplayImage& a, const DisplayImage& b);

}  // namespace whit
