// Reads, makes and merges the channels of an image beside its colors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "core/channels.h"
#include "core/image.h"
#include "core/warnings.h"
#include "io/image/image_file.h"

namespace whit {

// Reads all channels of an EXR's first part except the colors (R, G, B, or Y, RY, BY), in the
// order of their names, for the part of the data window that lies inside the display window, as
// readImage() does. Half floats become floats. Other formats have at most alpha, "A". Throws as
// readImage() does, and badScene for a subsampled channel.
std::vector<ImageLayer> readLayers(const std::string& path, const ImageLimits& limits);

// Copies the channels that are wanted; the layers are named as in a file.
std::vector<ImageLayer> layersOf(const ChannelLayers& channels,
                                 ChannelSet wanted = ChannelSet::all());

// Attributes of an EXR that describe its channels: the list of channels ("channels"), and the names
// of objects ("whit:objects", by their numbers, for the first kNamedItems) and materials
// ("whit:materials") as JSON objects. Empty without channels.
ImageMetadata describeChannels(const Scene& scene, ChannelSet channels);

// Returns the channel that a PNG or EXR of this name holds in place of the picture, by the last
// part of the name, in any case, before its extension, apart from a frame's number:
// "out.depth.png", "a.normal-####.exr", "a####.normal.exr". A PNG whose name has no other part, as
// "depth.png", holds a channel that is kept.
std::optional<Channel> channelNamedBy(const std::string& path, ChannelSet kept);
// Throws Error(usage) if the name of a JPEG or a film asks for a channel, which only a PNG or an
// EXR holds.
void requireNoChannelName(const std::string& file);

// Writes a channel as an EXR that programs without knowledge of channels read: normals, positions,
// albedo and texture coordinates as R, G, B, of others the first component as Y. Numbers become
// floats, exact below 2^24, and -1 where nothing was hit.
void writeChannelExr(const std::string& path, const Image& image, const ChannelLayers& channels,
                     Channel channel, const ImageMetadata& metadata, ExrStorage storage,
                     int threads);

// Writes a channel as a 16-bit PNG with the metadata as text chunks. The codes are: depth along the
// camera's axis in thousandths of a unit, 0 without a hit; normals as (n + 1) / 2, 0 without a hit;
// albedo as sRGB; the fractions of u and v, and 0; numbers as they are, 65535 without a hit. Throws
// Error(usage) for positions, Error(limit) where a value does not fit into 16 bits.
void writeChannelPng(const std::string& path, const Image& image, const ChannelLayers& channels,
                     Channel channel, const ImageMetadata& metadata);

// Merges crops of an image, which were rendered on several machines or one after the other.
struct MergedImage {
  Image image;             // the window is the whole image
  ImageMetadata metadata;  // the text on which all EXR parts agree, without their crop
  std::vector<ImageLayer> layers;
};

// Puts the files' data windows together, layers included. Throws Error(usage) when there are no
// files, when their display windows differ in size, when a part lacks a layer that another one has,
// when the text of two EXR parts is of different scenes or options, or when some pixel is in none
// of them; and what readImage and readLayers throw. Where parts overlap, the later one wins; pixels
// whose bits differ there are counted in `warnings`.
MergedImage mergeImages(const std::vector<std::string>& paths, const ImageLimits& limits,
                        Warnings& warnings);

}  // namespace whit
