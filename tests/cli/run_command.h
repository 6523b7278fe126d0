// Runs command lines in a folder of their own, and reads what they have printed and written there.
#pragma once

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>
#include <iomanip>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "has_text.h"
#include "io/image/image_file.h"
#include "run_program.h"

namespace whit::cli {

using Json = nlohmann::json;
using Words = std::vector<std::string>;

// The words of a line, between blanks. A word in quotation marks may hold blanks.
inline Words split(const std::string& line) {
  std::istringstream in(line);
  Words words;
  for (std::string word; in >> std::quoted(word);) words.push_back(word);
  return words;
}

// Expects that a command has ended with this status and with a message that says this.
inline void expectFailed(const Outcome& outcome, int status, const std::string& said) {
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("whit: ")) << outcome.err;
  EXPECT_TRUE(hasText(outcome.err, said));
}

inline void expectMembers(const Json& json, const Json& members) {
  for (const auto& [key, value] : members.items()) EXPECT_EQ(json[key], value) << key;
}

// Gives each test a folder of its own with the tiny scene in it, where its commands run. Names of
// files are names in this folder.
class TinySceneTest : public testing::Test {
 protected:
  // Scenes and glTF files may have ' in place of ".
  void save(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << savedText(name, text);
  }
  // Saves the tiny scene with other words in the place of some.
  void saveTiny(const std::string& name, const std::string& words,
                const std::string& others) const {
    std::string text = bytesOf("tiny.json");
    save(name, text.replace(text.find(words), words.size(), others));
  }

  // Runs `whit LINE`, after `prepare` has been called in the new process.
  Outcome run(
      const std::string& line, const std::function<void()>& prepare = [] {}) const {
    return runWhit(split(line), [&] {
      if (chdir(folder_.path().c_str()) != 0) _exit(1);
      prepare();
    });
  }
  // Runs a command that must succeed.
  Outcome succeed(const std::string& line) const {
    const Outcome outcome = run(line);
    EXPECT_EQ(outcome.status, 0) << line << ": " << outcome.err;
    return outcome;
  }
  // Runs a command that must fail with this status, say this, and print nothing else.
  void expectFailure(const std::string& line, int status, const std::string& said) const {
    SCOPED_TRACE("whit " + line);
    const Outcome outcome = run(line);
    expectFailed(outcome, status, said);
    EXPECT_EQ(outcome.out, "");
  }
  // Runs a command with --json -, and returns what it prints.
  Json jsonOf(const std::string& line) const {
    const std::string out = succeed(line + " --json -").out;
    Json json = Json::parse(out, nullptr, false);
    EXPECT_FALSE(json.is_discarded()) << out;
    return json;
  }

  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  std::string bytesOf(const std::string& name) const { return readFile(folder_ / name); }
  Json jsonIn(const std::string& name) const { return Json::parse(bytesOf(name)); }
  Image imageIn(const std::string& name) const { return readImage(folder_ / name, ImageLimits()); }
  // Codes of a PNG, or values of an EXR, as they are stored.
  RawImage storedIn(const std::string& name) const {
    Warnings warnings;
    return readRawImage(folder_ / name, ImageLimits(), warnings);
  }
  std::map<std::string, std::string> metadataOf(const std::string& name) const {
    const ImageMetadata all =
        name.ends_with(".png") ? readPngMetadata(folder_ / name) : readExrMetadata(folder_ / name);
    return {all.begin(), all.end()};
  }
  // A file that is written anew is another file of its name, with another number.
  ino_t fileNumber(const std::string& name) const {
    struct stat about {};
    EXPECT_EQ(stat((folder_ / name).c_str(), &about), 0) << name;
    return about.st_ino;
  }
  // Runs a command that must succeed, and returns whether this file is the one it was before.
  bool keeps(const std::string& name, const std::string& line) const {
    // The file is held open, so that the file that replaces it does not get the same number.
    const std::ifstream held(folder_ / name);
    const ino_t before = fileNumber(name);
    succeed(line);
    return fileNumber(name) == before;
  }

  const TemporaryFolder folder_;
  const std::string tiny_ = writeTinyScene(folder_);
};

}  // namespace whit::cli
