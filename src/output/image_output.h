// Images as results: checked names, metadata, complete files, frame numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "io/files.h"
#include "io/image/image_file.h"
#include "io/image/image_layers.h"
#include "render/renderer.h"

namespace whit {

// Checks an output before the work starts. Throws Error(usage) unless `path` ends in one of
// `extensions` (none: any name will do), and Error(io) unless its folder exists and can be written
// to.
void requireWritable(const std::string& path, const std::vector<std::string>& extensions);
bool isJpeg(const std::string& path);  // by its extension
// Makes the folder of results if it does not exist. Throws Error(io) if that fails, or if these
// files cannot be written into it.
void makeFolder(const std::string& path, const std::vector<std::string>& files);
// Does the same for the value of --json, which may also be empty or "-".
void requireJsonWritable(const std::string& path);

// The name that stands for standard output in place of a file.
inline constexpr const char* kStandardOutput = "-";

inline constexpr OptionSpec kExrOption{.name = "exr", .words = "zip|none|half|dwaa"};

// How an image is to be written, apart from what is in it.
struct ImageFormat {
  ExrStorage exr = ExrStorage::zip;
  int threads = 1;                      // number of threads that compress it
  std::optional<Channel> channel = {};  // channel that the file holds in place of the picture
  ImageMetadata aboutChannels = {};     // result of describeChannels()
};

// Writes .exr (linear, with the film's channels), .jpg or .png (display), or the format's channel
// alone as .exr or .png, by the name's extension; a PNG to standard output. Throws Error(io), and
// what writeChannelPng() throws.
void writeImage(const std::string& path, const Film& film, const ImageMetadata& metadata,
                const ImageFormat& format = {});
// Returns the metadata that writeImage() adds: for an EXR its channels and its storage unless that
// is usual, for the image of one channel its name.
ImageMetadata ownMetadata(const std::string& path, const ImageFormat& format);

// True if `path` (.exr or .png) is what a render into `image` would write: readable to its last
// byte and, as far as `expected` tells, made with the same options of a scene with the same
// contents. What the options leave to the machine (--simd auto, --packet auto) may differ. Throws
// Error(io) for a file that cannot be read.
bool isWhole(const std::string& path, const Image& image, const ImageMetadata& expected,
             const RenderOptions& options);

// Frames a to b, both included.
struct FrameRange {
  int first = 0, last = 0;
};
FrameRange parseFrameRange(const std::string& text);  // "3" or "0..47"; throws Error(usage)

// Returns the file's name with the frame's number in place of its run of '#', zero-padded to the
// length of the run. Throws Error(usage) if the name has none. Standard output takes all frames.
std::string frameName(const std::string& pattern, int frame);
// Throws Error(usage) when the name is meant for frames: two '#' or more.
void requireNoFrameName(const std::string& name);

}  // namespace whit
