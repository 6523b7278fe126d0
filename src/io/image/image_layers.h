// The channels of an EXR beside its colors, with names of their own: "depth.Z".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "core/channels.h"
#include "core/image.h"
#include "io/image/image_file.h"

namespace whit {

// A value for each pixel of the data window, row by row from the top.
struct ImageLayer {
  std::string name;
  bool countsThings = false;         // 32-bit unsigned numbers, otherwise floats
  std::vector<std::uint32_t> words;  // numbers, or the bits of floats

  std::vector<float> floats() const;
};

// Reads all channels of an EXR's first part that are no colors (R, G, B, A, or Y, RY, BY), in the
// order of their names, for the part of the data window that lies inside the display window, as
// readImage() has it. Half floats become floats. Returns none for another format. Throws as
// readImage() does; badScene for a subsampled channel.
std::vector<ImageLayer> readLayers(const std::string& path, const ImageLimits& limits);

// Copies, named as in a file.
std::vector<ImageLayer> layersOf(const ChannelLayers& channels);

// As writeExr() takes them; what they view must outlive it.
std::vector<LayerView> viewsOf(const std::vector<ImageLayer>& layers);
std::vector<LayerView> viewsOf(const ChannelLayers& channels);

// The attributes of an EXR about its channels: the list of channels ("channels"), and the names of
// objects ("whit:objects", by their numbers, for the first kNamedItems) and materials
// ("whit:materials") as JSON objects. Empty without channels.
ImageMetadata describeChannels(const Scene& scene, ChannelSet channels);

// A channel as a 16-bit PNG, its metadata as text chunks: the distance along the camera's axis in
// thousandths of a unit, 0 where nothing is met; normals, (n + 1) / 2 a component, else 0; albedo
// as sRGB; u and v without their whole parts, and 0; numbers as they are, 65535 where nothing is
// met. Throws Error(usage) for positions, which have no such picture, Error(limit) where a value
// does not fit into 16 bits.
void writeChannelPng(const std::string& path, const Image& image, const ChannelLayers& channels,
                     Channel channel, const ImageMetadata& metadata);

}  // namespace whit
