// The headers of OpenEXR files; for the files of this folder that link OpenEXR.
#pragma once

#include <ImfHeader.h>

#include <cstdint>
#include <string>
#include <vector>

namespace whit {

// The headers of all parts, before the library opens the file: it would allocate whatever the
// attributes and the tables of chunks claim to take. Throws Error(badScene) where they claim more
// than the file holds, and what OpenEXR throws.
std::vector<Imf::Header> readExrHeaders(const std::string& path);

// Upper bound on the library's memory for the chunks of a file with this header that it processes
// at a time: stored, decoded, and twice that again while it undoes the compression.
std::uint64_t exrChunkBytes(const Imf::Header& header);

}  // namespace whit
