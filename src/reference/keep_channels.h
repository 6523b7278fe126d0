// The channels of a picture's pixels, the way kernels keep them (core/channels.h).
#pragma once

#include "reference/reference.h"

namespace whit::reference {

// Stores the channels of image.window: the first hits of the rays through the sample nearest to the
// center of each pixel, or through the center itself with adaptive sampling.
void keepChannels(const Scene& scene, const Intersector& intersector, const Camera& camera,
                  const Settings& settings, const Image& image, ChannelLayers& layers);

}  // namespace whit::reference
