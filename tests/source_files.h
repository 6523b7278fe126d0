// Files of the sources: pages, scenes and the fuzzers' corpus.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace whit {

inline std::string sourceFile(const std::string& path) {
  const char* folder = std::getenv("WHIT_SOURCE_DIR");
  return std::string(folder ? folder : ".") + "/" + path;
}

// Returns the bytes of the file.
inline std::string sourceText(const std::string& path) {
  std::ifstream file(sourceFile(path), std::ios::binary);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace whit
