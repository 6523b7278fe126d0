// Images as results: checked names, what they say about themselves, frame numbers.
#pragma once

#include <string>
#include <vector>

#include "core/options.h"
#include "io/image_file.h"
#include "io/paths.h"
#include "render/renderer.h"

namespace whit::cli {

// Before the work starts: Error(usage) unless `path` ends in one of `extensions`, Error(io) unless
// its folder is there and can be written to. No extensions: any name will do.
void requireWritable(const std::string& path, const std::vector<std::string>& extensions);
// Makes the folder of results if it is not there. Throws Error(io).
void makeFolder(const std::string& path);
// As requireWritable() for the value of --json: empty and "-" are fine.
void requireJsonWritable(const std::string& path);

// Says with which settings of LoadOptions the scene was read; nothing without any.
void addSettings(const std::vector<std::string>& settings, const std::string& sky,
                 ImageMetadata& metadata);

// Writes .exr (linear) or .png (display) by the name's extension.
void writeImage(const std::string& path, const Film& film, const RenderOptions& options,
                const ImageMetadata& metadata);

// Frames a to b, both included.
struct FrameRange {
  int first = 0, last = 0;
};
FrameRange parseFrameRange(const std::string& text);  // "3" or "0..47"; throws Error(usage)

// The run of '#' in the file's name becomes the frame's number, zero-padded to its length; throws
// Error(usage) when the name has none.
std::string frameName(const std::string& pattern, int frame);
// Throws Error(usage) when the name is meant for frames: two '#' or more.
void requireNoFrameName(const std::string& name);

}  // namespace whit::cli
