// Members of a scene that are set between frames give the picture of a scene that was read with
// them.
#include "has_text.h"
#include "io/scene/scene_settings.h"
#include "library_scenes.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

// So many more allocations succeed, and then one fails.
constexpr int kManyAllocations = 1 << 30;
std::atomic<int> allocationsLeft = kManyAllocations;

}  // namespace

void* operator new(std::size_t size) {
  void* const memory = --allocationsLeft == 0 ? nullptr : std::malloc(size > 0 ? size : 1);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return std::malloc(size > 0 ? size : 1);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace whit::api {
namespace {

// Members, and whether they are set without anything being built anew. Some have an effect with an
// option alone.
struct Member {
  const char* pointer;
  const char* value;
  bool inPlace;
  const char *option = "spp", *optionValue = "1";
};
constexpr Member kMembers[] = {
    {"/lights/0/intensity", "40", true},
    {"/lights/0/position", "[2, 3, 4]", true},
    {"/lights/0/type", "\"directional\"", false},  // lacks its direction: an error
    {"/lights/-", R"({"position": [3, 5, 1], "intensity": [9, 2, 2]})", false},
    {"/cameras/main/eye", "[1, 2, 5]", true},
    {"/cameras/main/fov", "60", true},
    {"/cameras/main/aperture", "0.4", true, "spp", "4"},
    {"/sky", R"({"color": [0.3, 0.1, 0.2]})", true},
    {"/sky/zenith", "[0.5, 0, 0]", true},
    {"/ambient", R"({"color": 0.4})", true},
    {"/ambient/fromSky", "0.1", true},
    {"/ambient", R"({"fromSky": 0.5, "occlusion": 2})", true, "ambient-samples", "4"},
    {"/materials/floor/diffuse", "[0.2, 0.9, 0.4]", true},
    {"/materials/floor/mirror", "0.5", true},
    {"/materials/mirror/mirror", "0", true},
    {"/materials/glass/ior", "1.2", true},
    {"/materials/glass/transmission", "0", false},  // casts a shadow from then on
    {"/materials/floor/diffuseMap", "null", false},
    {"/materials/floor/coverage", "0.5", false},
    {"/materials/new", R"({"diffuse": 0.5})", false},
    {"/textures/checker/columns", "4", false},
    {"/scene/1/radius", "0.5", false},
    {"/scene/3/material", "\"glass\"", false},
};

std::string settingOf(const Member& member) {
  return std::string(member.pointer) + "=" + member.value;
}

Renderer whittedWith(const std::vector<std::string>& settings = {}) {
  return smallRenderer("whitted", {.settings = settings});
}

// Notes whether a renderer builds a structure anew for its next frames.
void watchBuilding(Renderer& renderer, bool& built) {
  renderer.setProgress([&](const std::string& phase, double) {
    built |= phase.starts_with("building");
    return true;
  });
}

TEST(SetMember, HasThePictureOfASceneThatWasReadSo) {
  for (const Member& member : kMembers) {
    SCOPED_TRACE(settingOf(member));
    Renderer renderer = whittedWith();
    const Image before = renderer.set(member.option, member.optionValue).render();
    bool built = false;
    watchBuilding(renderer, built);

    const Error error = errorOf([&] { renderer.setMember(member.pointer, member.value); });
    Image expected = before;
    const Error whenRead = errorOf([&] {
      whittedWith({settingOf(member)}).set(member.option, member.optionValue).render(expected);
    });
    EXPECT_EQ(error.status(), whenRead.status());
    EXPECT_EQ(error.place(), whenRead.place());

    const Image after = renderer.render();
    EXPECT_TRUE(samePictures(after, expected));
    const bool isUsed = error.status() == 0 && std::string(member.pointer) != "/materials/new";
    EXPECT_NE(samePictures(before, after), isUsed);
    EXPECT_TRUE(error.status() != 0 || built != member.inPlace);
  }
}

// The renderer's tables are made anew last. Where that fails, the edit is undone.
TEST(SetMember, LeavesTheSceneAsItWasWhereMemoryEnds) {
  Renderer renderer = whittedWith();
  const Image before = renderer.render();
  const auto edit = [&] { renderer.setMember("/materials/floor/mirror", "0.5"); };

  // The allocations of an edit are counted in one that is not refused.
  Renderer other = whittedWith();
  other.render();
  allocationsLeft = kManyAllocations;
  other.setMember("/materials/floor/mirror", "0.5");
  const int count = kManyAllocations - allocationsLeft;

  constexpr int kOfTables = 12;  // at least so many are made for the renderer
  for (int last = 1; last <= kOfTables; ++last) {
    allocationsLeft = count - last;
    const Error error = errorOf(edit);
    allocationsLeft = kManyAllocations;
    ASSERT_EQ(error.status(), 5) << last;
    EXPECT_TRUE(samePictures(renderer, before)) << last;
  }
}

TEST(SetMember, AllOfThemOneAfterTheOther) {
  Renderer renderer = whittedWith();
  std::vector<std::string> settings;
  for (const Member& member : kMembers) {
    if (statusOf([&] { renderer.setMember(member.pointer, member.value); }) != 0) continue;
    settings.push_back(settingOf(member));
    renderer.render();
  }
  EXPECT_GT(settings.size(), 15u);
  EXPECT_TRUE(samePictures(renderer, whittedWith(settings)));
}

// A lens counts only where a pixel has several samples, and occlusion where it is sampled.
TEST(SetMember, AnApertureGoesAsItComesAndOcclusionIsSampled) {
  Renderer renderer = whittedWith();
  const Image sharp = renderer.set("spp", "4").render();
  EXPECT_FALSE(samePictures(renderer.setMember("/cameras/main/aperture", "0.4"), sharp));

  bool built = false;
  watchBuilding(renderer, built);
  EXPECT_TRUE(samePictures(renderer.setMember("/cameras/main/aperture", "0"), sharp));
  EXPECT_FALSE(built);

  const Image open = renderer.setMember("/ambient", R"({"fromSky": 0.5, "occlusion": 2})").render();
  EXPECT_FALSE(samePictures(renderer.set("ambient-samples", "4"), open));
}

TEST(SetMember, TheSameMemberAgainIsOneSetting) {
  std::vector<std::string> settings;
  const auto add = [&](const char* text) { addSceneSetting(text, settings); };
  for (int i = 0; i < 3; ++i) {
    add("/lights/0/intensity=1");
    add("/sky/zenith=[0,0,1]");
    add("/lights/0/intensity=2");
  }

  EXPECT_EQ(settings, (std::vector<std::string>{"/sky/zenith=[0,0,1]", "/lights/0/intensity=2"}));

  // The order counts where one setting lies within another, and appending is done each time.
  settings.clear();
  for (const char* text : {"/sky=1", "/sky/zenith=2", "/sky=3", "/sky/zenith=4", "/lights/-=5",
                           "/lights/-=5", "/sky=6"}) {
    add(text);
  }
  EXPECT_EQ(settings.size(), 7u);
  add("/sky=7");
  EXPECT_EQ(settings.size(), 7u);
  EXPECT_EQ(settings.back(), "/sky=7");
}

TEST(SetMember, WhatWasMovedStaysMoved) {
  LoadOptions options{.moves = true, .movable = {"/scene/3"}};
  const Matrix place = placed({-1, 0.5, 0});
  Renderer renderer = smallRenderer("whitted", options);
  renderer.setTransform("/scene/3", place).setMember("/scene/1/radius", "0.5");

  options.settings = {"/scene/1/radius=0.5"};
  Renderer other = smallRenderer("whitted", options);
  const Image rest = other.render(), moved = renderer.render();
  EXPECT_TRUE(samePictures(moved, other.setTransform("/scene/3", place)));
  EXPECT_FALSE(samePictures(rest, moved));
}

TEST(SetMember, ScenesThatMoveKeepTheirTime) {
  constexpr Member kChanges[] = {{"/lights/1/intensity", "50", true},
                                 {"/cameras/main/fov", "30", true},
                                 {"/materials/brass/diffuse", "0.9", true}};
  LoadOptions options{.moves = true};
  Renderer renderer = smallRenderer("orrery", options);
  renderer.setTime(3.5).render();
  for (const Member& member : kChanges) {
    renderer.setMember(member.pointer, member.value);
    options.settings.push_back(settingOf(member));
    EXPECT_TRUE(samePictures(renderer, smallRenderer("orrery", options).setTime(3.5)))
        << member.pointer;
  }
}

TEST(SetMember, WarningsComeAndGoWithWhatTheyTell) {
  constexpr std::array<const char*, 3> kSums[] = {{"/materials/glass/mirror", "0.9", "1 time,"},
                                                  {"/materials/mirror/diffuse", "0.9", "2 times,"},
                                                  {"/materials/glass/mirror", "0", "1 time,"},
                                                  {"/materials/mirror/diffuse", "0", ""}};
  LoadOptions options;
  Renderer renderer = smallRenderer("whitted");
  for (const auto& [pointer, value, times] : kSums) {
    renderer.setMember(pointer, value);
    options.settings.push_back(std::string(pointer) + "=" + value);

    const std::vector<std::string> warnings = renderer.scene().warnings();
    EXPECT_EQ(warnings, loadScene("whitted", options).warnings()) << pointer;
    EXPECT_EQ(warnings.empty(), *times == 0) << pointer;
    for (const std::string& warning : warnings) EXPECT_TRUE(hasText(warning, times)) << warning;
  }
}

TEST(SetMember, ErrorsSayWhere) {
  struct Wrong {
    const char *pointer, *value;
    int status;
    const char* place;
  };
  constexpr Wrong kWrong[] = {
      {"lights", "4", 2, ""},
      {"/lights/0/intensity", "nan", 2, ""},
      {"/lights/7/intensity", "4", 3, "/lights/7"},
      {"/lights/0/intensity", "\"bright\"", 3, "/lights/0/intensity"},
      {"/lights/0/intensity", "1e30", 3, "/lights/0/intensity"},
      {"/lights/0/intensty", "4", 3, "/lights/0/intensty"},
      {"/nothing", "4", 3, "/nothing"},
      {"/scene/1/radius", "-1", 3, "/scene/1/radius"},
  };
  Renderer renderer = whittedWith();
  for (const Wrong& wrong : kWrong) {
    const Error error = errorOf([&] { renderer.setMember(wrong.pointer, wrong.value); });
    EXPECT_EQ(error.status(), wrong.status) << error.what();
    EXPECT_EQ(error.place(), wrong.place) << error.what();
  }
}

}  // namespace
}  // namespace whit::api
