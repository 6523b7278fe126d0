// Reading files into memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/error.h"

namespace whit {

// Throws Error(io) if the file cannot be read, limit if it has more than `maxBytes`, badScene if it
// is a Git LFS pointer.
std::string readFile(const std::filesystem::path& path, std::uint64_t maxBytes);
// Reads text without a byte order mark of UTF-8. Refuses UTF-16.
std::string readTextFile(const std::filesystem::path& path, std::uint64_t maxBytes);
// Reads at most `bytes` bytes of the file.
std::string readBeginning(const std::filesystem::path& path, std::uint64_t bytes);

// The beginning of a text that an error quotes.
inline std::string excerpt(const std::string& text) {
  constexpr std::size_t kShown = 60;
  return text.size() > kShown ? text.substr(0, kShown) + "..." : text;
}

// Calls `read`, which opens a file that the place `where` names ("": the user): an Error(io) names
// that place as well.
template <typename Read>
auto readNamedAt(const std::string& where, const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    if (error.status() != ExitStatus::io || where.empty()) throw;
    throw Error(ExitStatus::io, where + ": " + error.what(), error.place());
  }
}

inline std::span<const std::uint8_t> asBytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace whit
