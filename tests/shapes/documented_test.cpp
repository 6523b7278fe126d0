// scenes/README.md names every shape and pattern, with its parameters and their defaults.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "core/option_table.h"
#include "core/text.h"
#include "has_text.h"
#include "io/load_scene.h"
#include "make/shape.h"
#include "source_files.h"
#include "temporary_folder.h"

namespace whit {
namespace {

using Texts = std::vector<std::string>;

// Gives every parameter its default, and records the parameters that were queried.
class RecordingParameters : public ShapeParameters {
 public:
  double number(const std::string& key, double fallback, double low, double high) override {
    EXPECT_TRUE(fallback >= low && fallback <= high) << key;
    note(key, text(fallback));
    return fallback;
  }
  int integer(const std::string& key, int fallback, int low, int high) override {
    return static_cast<int>(number(key, fallback, low, high));
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
                   const Texts& choices) override {
    EXPECT_TRUE(contains(choices, fallback)) << key;
    std::string others;
    for (const std::string& choice : choices) {
      if (choice != fallback) others += " or " + choice;
    }
    note(key, fallback + others);
    return fallback;
  }

  // Lists the parameters as a row of the table does, in the order in which this compiler evaluates
  // arguments.
  const Texts& listed() const { return listed_; }

 private:
  static std::string text(double value) { return formatted("%g", value); }
  void note(const std::string& key, const std::string& fallback) {
    listed_.push_back("`" + key + "` " + fallback);
  }

  Texts listed_;
};

Texts lines() { return split(sourceText("scenes/README.md"), '\n'); }

// Returns the table's row of a shape or pattern, or an empty string.
std::string rowOf(const std::string& name) {
  for (const std::string& line : lines()) {
    if (line.starts_with("| `" + name + "` |")) return line;
  }
  return {};
}

void noteSlots(const Shape& shape, Texts& items) {
  for (const ShapePart& part : shape.parts) {
    if (part.slot != "surface") items.push_back("`" + part.slot + "`");
  }
}
void noteSlots(const Texture&, Texts&) {}

template <typename Generators>
void expectDocumented(const Generators& generators) {
  for (const auto& [name, generate] : generators) {
    RecordingParameters parameters;
    const auto made = generate(parameters);
    Texts items = parameters.listed();
    noteSlots(made, items);

    const std::string row = rowOf(name);
    ASSERT_FALSE(row.empty()) << name;
    for (const std::string& item : items) EXPECT_TRUE(hasText(row, item));

    // The row lists nothing else: every name is between two backquotes.
    EXPECT_EQ(std::ranges::count(row, '`'), std::ssize(items) * 2 + 2) << row;
  }
}

TEST(Documented, EveryShape) { expectDocumented(shapeGenerators()); }
TEST(Documented, EveryPattern) { expectDocumented(patternGenerators()); }

// The example of the page can be loaded as a scene.
TEST(Documented, ExampleCanBeRead) {
  const Texts page = lines();
  const auto begin = std::find(page.begin(), page.end(), "```json");
  const auto end = std::find(begin, page.end(), "```");
  ASSERT_NE(end, page.end());

  const TemporaryFolder folder;
  const std::string name = folder / "example.json";
  std::ofstream(name) << joined({begin + 1, end}, "\n");
  Warnings warnings;
  const Scene scene = Scene::finalize(loadScene(name, LoadOptions{}, warnings), warnings);

  EXPECT_TRUE(scene.effects.has(Effect::mirror));
  EXPECT_TRUE(scene.effects.has(Effect::absorption));
  EXPECT_EQ(scene.instances.size(), 3u);
}

}  // namespace
}  // namespace whit
