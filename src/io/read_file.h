// Files, read whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace whit {

// Throws Error(io) if it cannot be read, limit beyond maxBytes, badScene where a Git LFS pointer
// stands in for it.
std::string readFile(const std::filesystem::path& path, std::uint64_t maxBytes);
// Reads text without the mark that some editors put before UTF-8. Refuses UTF-16.
std::string readTextFile(const std::filesystem::path& path, std::uint64_t maxBytes);
// At most so many bytes.
std::string readBeginning(const std::filesystem::path& path, std::uint64_t bytes);

inline std::span<const std::uint8_t> asBytes(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace whit
