// Members of a scene that are set between frames give the picture of a scene that was read with
// them.
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

// Members, and whether they are set without anything being built anew.
struct Member {
  const char* pointer;
  const char* value;
  bool inPlace;
};
constexpr Member kMembers[] = {
    {"/lights/0/intensity", "40", true},
    {"/lights/0/position", "[2, 3, 4]", true},
    {"/lights/0/type", "\"directional\"", false},  // lacks its direction: an error
    {"/lights/-", R"({"position": [3, 5, 1], "intensity": [9, 2, 2]})", false},
    {"/cameras/main/eye", "[1, 2, 5]", true},
    {"/cameras/main/fov", "60", true},
    {"/sky", R"({"color": [0.3, 0.1, 0.2]})", true},
    {"/sky/zenith", "[0.5, 0, 0]", true},
    {"/ambient", R"({"color": 0.4})", true},
    {"/ambient/fromSky", "0.1", true},
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

Scene whittedWith(const std::vector<std::string>& settings) {
  LoadOptions options;
  options.settings = settings;
  return loadScene("whitted", options);
}

// Watches whether a renderer builds a structure anew for its next frames.
class BuildWatch {
 public:
  explicit BuildWatch(Renderer& renderer) {
    renderer.setProgress([this](const std::string& phase, double) {
      built_ |= phase.starts_with("building");
      return true;
    });
  }
  bool built() const { return built_; }

 private:
  bool built_ = false;
};

TEST(SetMember, HasThePictureOfASceneThatWasReadSo) {
  for (const Member& member : kMembers) {
    SCOPED_TRACE(settingOf(member));
    Renderer renderer = smallRenderer(loadScene("whitted"));
    const Image before = renderer.render();
    BuildWatch watch(renderer);

    const Error error = errorOf([&] { renderer.setMember(member.pointer, member.value); });
    const Error expected = errorOf([&] { whittedWith({settingOf(member)}); });
    EXPECT_EQ(error.status(), expected.status());
    EXPECT_EQ(error.place(), expected.place());

    const Image after = renderer.render();
    if (expected.status() != 0) {
      EXPECT_TRUE(samePictures(before, after));
      continue;
    }
    EXPECT_EQ(watch.built(), !member.inPlace);
    EXPECT_TRUE(samePictures(after, smallRenderer(whittedWith({settingOf(member)})).render()));

    const bool isUsed = std::string(member.pointer) != "/materials/new";
    EXPECT_NE(samePictures(before, after), isUsed);
  }
}

// The renderer's tables are made anew last. Where that fails, the edit is undone.
TEST(SetMember, LeavesTheSceneAsItWasWhereMemoryEnds) {
  Renderer renderer = smallRenderer(loadScene("whitted"));
  const Image before = renderer.render();
  const auto edit = [&] { renderer.setMember("/materials/floor/mirror", "0.5"); };

  // The allocations of an edit are counted in one that is not refused.
  Renderer other = smallRenderer(loadScene("whitted"));
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
    EXPECT_TRUE(samePictures(renderer.render(), before)) << last;
  }
}

TEST(SetMember, AllOfThemOneAfterTheOther) {
  Renderer renderer = smallRenderer(loadScene("whitted"));
  std::vector<std::string> settings;
  for (const Member& member : kMembers) {
    if (errorOf([&] { renderer.setMember(member.pointer, member.value); }).status() != 0) continue;
    settings.push_back(settingOf(member));
    renderer.render();
  }
  EXPECT_GT(settings.size(), 15u);
  EXPECT_TRUE(samePictures(renderer.render(), smallRenderer(whittedWith(settings)).render()));
}

TEST(SetMember, AnApertureComesAndGoesBetweenFrames) {
  Renderer renderer = smallRenderer(loadScene("whitted"));
  const Image sharp = renderer.set("spp", "4").render();

  BuildWatch watch(renderer);
  const Image blurred = renderer.setMember("/cameras/main/aperture", "0.4").render();
  EXPECT_FALSE(samePictures(blurred, sharp));

  Renderer read = smallRenderer(whittedWith({"/cameras/main/aperture=0.4"}));
  EXPECT_TRUE(samePictures(read.set("spp", "4").render(), blurred));
  EXPECT_TRUE(samePictures(renderer.setMember("/cameras/main/aperture", "0").render(), sharp));
  EXPECT_FALSE(watch.built());
}

TEST(SetMember, AmbientLightFromTheSkyKeepsItsOcclusion) {
  const Member member{"/ambient", R"({"fromSky": 0.5, "occlusion": 2})", true};
  Renderer renderer = smallRenderer(loadScene("whitted"));
  renderer.set("ambient-samples", "4").setMember(member.pointer, member.value);
  Renderer read = smallRenderer(whittedWith({settingOf(member)}));
  read.set("ambient-samples", "4");
  EXPECT_TRUE(samePictures(renderer.render(), read.render()));

  // The occlusion makes a difference to the picture.
  read.set("ambient-samples", "0");
  EXPECT_FALSE(samePictures(renderer.render(), read.render()));
}

TEST(SetMember, TheSameMemberAgainIsOneSetting) {
  std::vector<std::string> settings;
  const auto add = [&](const char* text) { addSceneSetting(text, settings); };
  for (int i = 0; i < 3; ++i) {
    add("/lights/0/intensity=1");
    add("/sky/zenith=[0,0,1]");
    add("/lights/0/intensity=2");
  }

  const std::vector<std::string> once{"/sky/zenith=[0,0,1]", "/lights/0/intensity=2"};
  EXPECT_EQ(settings, once);

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

TEST(SetMember, LeavesTheSceneOfOthersAlone) {
  const Scene scene = loadScene("whitted");
  Renderer one = smallRenderer(scene), other = smallRenderer(scene);
  const Image before = other.render();
  one.setMember("/lights/0/intensity", "4");
  EXPECT_FALSE(samePictures(before, one.render()));
  EXPECT_TRUE(samePictures(before, other.render()));
  EXPECT_TRUE(samePictures(before, smallRenderer(scene).render()));
}

TEST(SetMember, WhatWasMovedStaysMoved) {
  LoadOptions options;
  options.movable = {"/scene/3"};
  options.moves = true;
  constexpr Matrix kPlace{1, 0, 0, -1, 0, 1, 0, 0.5, 0, 0, 1, 0};
  Renderer renderer = smallRenderer(loadScene("whitted", options));
  renderer.setTransform("/scene/3", kPlace).setMember("/scene/1/radius", "0.5");

  options.settings = {"/scene/1/radius=0.5"};
  Renderer other = smallRenderer(loadScene("whitted", options));
  const Image rest = other.render();
  EXPECT_TRUE(samePictures(renderer.render(), other.setTransform("/scene/3", kPlace).render()));
  EXPECT_FALSE(samePictures(rest, renderer.render()));
}

TEST(SetMember, ScenesThatMoveKeepTheirTime) {
  LoadOptions options;
  options.moves = true;
  const char* const settings[] = {"/lights/1/intensity=50", "/cameras/main/fov=30",
                                  "/materials/brass/diffuse=0.9"};

  Renderer renderer = smallRenderer(loadScene("orrery", options));
  renderer.setTime(3.5).render();
  for (const std::string setting : settings) {
    options.settings.push_back(setting);
    const std::size_t sign = setting.find('=');
    renderer.setMember(setting.substr(0, sign), setting.substr(sign + 1));
    Renderer other = smallRenderer(loadScene("orrery", options));
    EXPECT_TRUE(samePictures(renderer.render(), other.setTime(3.5).render())) << setting;
  }
}

TEST(SetMember, ErrorsSayWhere) {
  Renderer renderer = smallRenderer(loadScene("whitted"));
  const auto errorAt = [&](const char* pointer, const char* value) {
    return errorOf([&] { renderer.setMember(pointer, value); });
  };

  EXPECT_EQ(errorAt("lights", "4").status(), 2);
  EXPECT_EQ(errorAt("/lights/0/intensity", "nan").status(), 2);
  EXPECT_EQ(errorAt("/lights/7/intensity", "4").place(), "/lights/7");
  EXPECT_EQ(errorAt("/lights/0/intensity", "\"bright\"").place(), "/lights/0/intensity");
  EXPECT_EQ(errorAt("/lights/0/intensity", "1e30").status(), 3);
  EXPECT_EQ(errorAt("/lights/0/intensty", "4").place(), "/lights/0/intensty");
  EXPECT_EQ(errorAt("/nothing", "4").status(), 3);
  EXPECT_EQ(errorAt("/scene/1/radius", "-1").place(), "/scene/1/radius");
}

}  // namespace
}  // namespace whit::api
