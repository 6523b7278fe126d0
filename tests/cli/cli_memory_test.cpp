// Images that claim or take more than --max-memory, in whole scenes.
#include <sys/resource.h>

#include "cli/run_command.h"
#include "images/image_samples.h"
#include "sanitized.h"

namespace whit::cli {
namespace {

// Returns the peak memory of all programs that this one has waited for, in bytes.
std::uint64_t peakOfPrograms() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

class MemoryLimit : public ImageTest {
 protected:
  // Writes a scene with a floor for each image.
  std::string sceneOf(const std::vector<std::string>& images) {
    std::string textures, materials, floors;
    for (std::size_t i = 0; i < images.size(); ++i) {
      const std::string comma = i > 0 ? "," : "", name = "\"m" + std::to_string(i) + "\"";
      textures += comma + name + ":{\"image\":\"" + images[i] + "\"}";
      materials += comma + name + ":{\"diffuseMap\":" + name + "}";
      floors += comma + "{\"shape\":\"quad\",\"material\":" + name + "}";
    }

    const std::string text = "{\"whit\":1,\"textures\":{" + textures + "},\"materials\":{" +
                             materials + "},\"scene\":[" + floors + "]}";
    save("scene.json", Bytes(text.begin(), text.end()));
    return path("scene.json");
  }
  // Loads a scene of these images.
  Outcome loadAll(const std::vector<std::string>& images, const std::string& gigabytes,
                  const std::string& threads = "2") {
    return runWhit({"info", sceneOf(images), "--max-memory", gigabytes, "--threads", threads});
  }
  // The peak memory of the program for a small image, in bytes.
  std::uint64_t peakOfASmallOne() {
    save("small.tga", tga(1, 1, {1, 2, 3}));
    EXPECT_EQ(loadAll({"small.tga"}, "0.1").status, 0);
    return peakOfPrograms();
  }

  static void setSize(Bytes& file, std::size_t at, std::initializer_list<int> bytes) {
    for (const int byte : bytes) file.at(at++) = static_cast<std::uint8_t>(byte);
  }
  // Writes images that claim 30000 x 30000 pixels, of which the files hold next to nothing.
  std::vector<std::string> hugeClaims() {
    // Only the sizes in the headers are changed, to 30000 = 0x7530.
    Bytes pixel = bmp(1, 1, {1, 2, 3});
    setSize(pixel, 18, {0x30, 0x75, 0, 0, 0x30, 0x75, 0, 0});

    Bytes frame = jpegGray200();
    setSize(frame, 2 + 69 + 5, {0x75, 0x30, 0x75, 0x30});

    writeExr(path("a.exr"), Image(2, 2), {});
    Bytes window = load(path("a.exr"));
    for (const std::string name : {"dataWindow", "displayWindow"}) {
      const std::string key = name + '\0' + "box2i" + '\0';
      const auto found = std::search(window.begin(), window.end(), key.begin(), key.end());
      setSize(window, static_cast<std::size_t>(found - window.begin()) + key.size() + 12,
              {0x2f, 0x75, 0, 0, 0x2f, 0x75, 0, 0});
    }
    window.resize(1 << 16);  // as long as a table of its lines would be

    save("a.png", png(30000, 30000, 8, 2, {0}));
    save("a.tga", tga(30000, 30000, {}));
    save("a.hdr", hdr(30000, 30000, {}));
    save("a.bmp", pixel);
    save("a.jpg", frame);
    save("a.exr", window);
    return {"a.png", "a.tga", "a.hdr", "a.bmp", "a.jpg", "a.exr"};
  }
};

// What the program itself takes varies by some pages.
constexpr std::uint64_t kPages = 4 << 20;

TEST_F(MemoryLimit, HugeClaimsAreRefusedBeforeMemoryIsTaken) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
  // The peak of all programs so far is compared with the peak after those with huge images.
  const std::uint64_t before = peakOfASmallOne();

  for (const std::string& name : hugeClaims()) {
    expectFailed(loadAll({name}, "0.1"), 5, name + ": 30000x30000");
    EXPECT_LT(peakOfPrograms(), before + kPages) << name;
  }
}

// The image takes 90 MB of pixels and as much again while it is decoded.
TEST_F(MemoryLimit, WhatDecodingTakesIsWithinTheLimit) {
  if (kSanitized) GTEST_SKIP() << "sanitizers take memory of their own";
  const std::uint64_t before = peakOfASmallOne();
  save("a.png", png(6000, 5000, 8, 2, Bytes(5000 * 18001, 0)));
  expectFailed(loadAll({"a.png"}, "0.15"), 5, "a.png");
  EXPECT_LT(peakOfPrograms(), before + 150'000'000 + kPages);
}

// The six images take 12 MB of texels each, and some 30 MB while one is decoded: too much for all
// of them at a time.
TEST_F(MemoryLimit, ImagesWaitForEachOther) {
  std::vector<std::string> names;
  for (int i = 0; i < 6; ++i) {
    names.push_back(std::to_string(i) + ".png");
    save(names.back(), png(2000, 1500, 8, 2, Bytes(1500 * 6001, 0)));
  }

  for (const char* threads : {"1", "6"}) {
    const Outcome outcome = loadAll(names, "0.11", threads);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
  }
  EXPECT_EQ(loadAll(names, "0.07").status, 5);
}

}  // namespace
}  // namespace whit::cli
