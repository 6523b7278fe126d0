// Merges crops of an image, which were rendered on several machines or one after the other.
#pragma once

#include <string>
#include <vector>

#include "core/image.h"
#include "core/warnings.h"
#include "io/image/image_file.h"
#include "io/image/image_layers.h"

namespace whit {

struct MergedImage {
  Image image;             // the window is the whole image
  ImageMetadata metadata;  // the text on which all EXR parts agree, without their crop
  std::vector<ImageLayer> layers;
};

// Puts the files' data windows together, layers included. Throws Error(usage) when there are no
// files, when their display windows differ in size, when a part lacks a layer that another one has,
// or when some pixel is in none of them; and what readImage and readLayers throw.
// Where parts overlap, the later one wins; pixels whose bits differ there are counted in
// `warnings`.
MergedImage mergeImages(const std::vector<std::string>& paths, const ImageLimits& limits,
                        Warnings& warnings);

}  // namespace whit
