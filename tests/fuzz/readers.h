// The readers of all files from outside, one for each kind of file, to which tests give hostile
// bytes.
// The same functions serve libFuzzer (fuzz_target.cpp) and the tests that replay the corpus.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace whit::fuzz {

struct Reader {
  std::string name;       // also the name of the folder of its corpus
  std::string extension;  // extension of the file that it reads
  void (*read)(const std::filesystem::path& file) = nullptr;
};

const std::vector<Reader>& readers();
const Reader& readerNamed(const std::string& name);

enum class Answer { read, refused };

// Saves the bytes as a file and reads it, the whole way to what renderers are given. The answer is
// `refused` for an Error that a bad file may cause: badScene, limit, or io (it names another file
// that is not there). Throws std::logic_error when the reader fails in any other way, or succeeds
// with what renderers must never see: numbers that are not finite, indices out of range.
Answer give(const Reader& reader, std::span<const std::uint8_t> bytes);

// The folder of all corpora, and a reader's files in order of their names.
std::filesystem::path corpusFolder();
std::vector<std::filesystem::path> corpusOf(const Reader& reader);
std::vector<std::uint8_t> bytesOfFile(const std::filesystem::path& file);

}  // namespace whit::fuzz
