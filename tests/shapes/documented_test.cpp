// scenes/README.md names every shape and pattern, with its parameters and their defaults.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "has_text.h"
#include "io/load_scene.h"
#include "make/shape.h"

namespace whit {
namespace {

// Gives every parameter its default, and records the parameters that were queried.
class RecordingParameters : public ShapeParameters {
 public:
  double number(const std::string& key, double fallback, double, double) override {
    note(key, text(fallback));
    return fallback;
  }
  int integer(const std::string& key, int fallback, int, int) override {
    note(key, std::to_string(fallback));
    return fallback;
  }
  bool flag(const std::string& key, bool fallback) override {
    note(key, fallback ? "true" : "false");
    return fallback;
  }
  Vec3d vector(const std::string& key, const Vec3d& v) override {
    note(key, "[" + text(v.x) + ", " + text(v.y) + ", " + text(v.z) + "]");
    return v;
  }
  std::string word(const std::string& key, const std::string& fallback,
                   const std::vector<std::string>& choices) override {
    std::string others;
    for (const std::string& choice : choices) {
      if (choice != fallback) others += " or " + choice;
    }
    note(key, fallback + others);
    return fallback;
  }

  // Lists the parameters as a row of the table does, in the order in which this compiler evaluates
  // arguments.
  const std::vector<std::string>& listed() const { return listed_; }

 private:
  static std::string text(double value) {
    std::ostringstream out;
    out.precision(6);
    out << value;
    return out.str();
  }
  void note(const std::string& key, const std::string& fallback) {
    listed_.push_back("`" + key + "` " + fallback);
  }

  std::vector<std::string> listed_;
};

std::vector<std::string> lines() {
  const char* source = std::getenv("WHIT_SOURCE_DIR");
  std::ifstream file(std::string(source ? source : ".") + "/scenes/README.md");
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

// Returns the table's row of a shape or pattern, or an empty string.
std::string rowOf(const std::string& name) {
  for (const std::string& line : lines()) {
    if (line.starts_with("| `" + name + "` |")) return line;
  }
  return {};
}

void expectListed(const std::string& row, const std::vector<std::string>& items) {
  for (const std::string& item : items) {
    EXPECT_TRUE(hasText(row, item)) << item << " is not in: " << row;
  }
}

std::vector<std::string> slotsOf(const Shape& shape) {
  std::vector<std::string> slots;
  for (const ShapePart& part : shape.parts) {
    if (part.slot != "surface") slots.push_back("`" + part.slot + "`");
  }
  return slots;
}
std::vector<std::string> slotsOf(const Texture&) { return {}; }

template <typename Generators>
void expectDocumented(const Generators& generators) {
  for (const auto& [name, generate] : generators) {
    RecordingParameters parameters;
    const std::vector<std::string> slots = slotsOf(generate(parameters));
    const std::string row = rowOf(name);
    ASSERT_FALSE(row.empty()) << name;
    expectListed(row, parameters.listed());
    expectListed(row, slots);

    // The row lists nothing else: every name is between two backquotes.
    const auto marks = std::count(row.begin(), row.end(), '`');
    EXPECT_EQ(static_cast<std::size_t>(marks), 2 * (1 + parameters.listed().size() + slots.size()))
        << row;
  }
}

TEST(Documented, EveryShape) { expectDocumented(shapeGenerators()); }
TEST(Documented, EveryPattern) { expectDocumented(patternGenerators()); }

// The example of the page can be loaded as a scene.
TEST(Documented, ExampleCanBeRead) {
  const std::vector<std::string> page = lines();
  const auto begin = std::find(page.begin(), page.end(), "```json");
  const auto end = std::find(begin, page.end(), "```");
  ASSERT_NE(end, page.end());

  const std::string name = testing::TempDir() + "whit-documented-example.json";
  std::ofstream file(name);
  for (auto line = begin + 1; line != end; ++line) file << *line << "\n";
  file.close();
  Warnings warnings;
  const Scene scene = Scene::finalize(loadScene(name, LoadOptions{}, warnings), warnings);

  EXPECT_TRUE(scene.effects.has(Effect::mirror));
  EXPECT_TRUE(scene.effects.has(Effect::absorption));
  EXPECT_EQ(scene.instances.size(), 3u);
  std::remove(name.c_str());
}

}  // namespace
}  // namespace whit
