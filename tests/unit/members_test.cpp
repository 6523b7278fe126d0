// The tables of members in scene/members.h are complete, and scenes/README.md describes their
// members.
#include <gtest/gtest.h>

#include "has_text.h"
#include "scene/members.h"
#include "source_files.h"

namespace whit {
namespace {

struct Anything {
  template <typename T>
  operator T() const;  // NOLINT(google-explicit-constructor): stands for a field of any type
};

// Counts the fields of an aggregate.
template <typename Noun, typename... Fields>
consteval std::size_t countFields() {
  if constexpr (requires { Noun{Fields{}..., Anything{}}; }) {
    return countFields<Noun, Fields..., Anything>();
  } else {
    return sizeof...(Fields);
  }
}

template <typename Noun>
constexpr std::size_t kListed = std::tuple_size_v<decltype(kMembers<Noun>)>;

static_assert(countFields<Camera>() == kListed<Camera> + 1, "all but the name");
static_assert(countFields<Material>() == kListed<Material> + 2, "all but name and pointer");
static_assert(countFields<Light>() + 1 == kListed<Light> + 2, "the same; intensity has two names");
static_assert(countFields<Sky>() == kListed<Sky> + 3, "all but name, kind and image");
static_assert(countFields<Ambient>() == kListed<Ambient> + 1, "all but ofSky");

template <typename Noun>
void expectDocumented(const std::string& page) {
  forEachMember<Noun>([&](const auto& member) {
    if (!member.rules.inFiles) return;
    const std::string name = std::string("`") + member.name + "`";
    EXPECT_TRUE(hasText(page, name)) << name;
  });
}

TEST(Members, AreInTheReadme) {
  const std::string page = sourceText("scenes/README.md");
  expectDocumented<Camera>(page);
  expectDocumented<Material>(page);
  expectDocumented<Light>(page);
  expectDocumented<Sky>(page);
  expectDocumented<Ambient>(page);
}

}  // namespace
}  // namespace whit
