// What is in the pictures that the program has written.
#pragma once

#include <map>
#include <string>

#include "io/image/image_file.h"

namespace whit::cli {

// Codes of a PNG, or values of an EXR, as they are stored.
inline RawImage storedIn(const std::string& path) {
  Warnings warnings;
  return readRawImage(path, ImageLimits(), warnings);
}

inline std::map<std::string, std::string> metadataOf(const std::string& path) {
  std::map<std::string, std::string> all;
  for (const auto& [name, text] :
       path.ends_with(".png") ? readPngMetadata(path) : readExrMetadata(path)) {
    all[name] = text;
  }
  return all;
}

}  // namespace whit::cli
