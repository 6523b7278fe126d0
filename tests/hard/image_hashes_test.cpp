// Pictures of the shipped scenes have the published hashes with every SIMD target of this machine,
// two of the packet widths each, with one thread and with many:
// Hard/HashTest.IsThePublishedOne/matte.
#include "verify/image_hashes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/error.h"
#include "sanitized.h"
#include "simd/kernels.h"

namespace whit::verify {

// Prints the names that ctest shows.
void PrintTo(const PublishedHash& picture, std::ostream* out) { *out << picture.scene; }

namespace {

std::vector<PublishedHash> smallPictures() {
  std::vector<PublishedHash> pictures;
  for (const PublishedHash& picture : publishedHashes()) {
    if (picture.size == "48x30") pictures.push_back(picture);
  }
  return pictures;
}

class HashTest : public testing::TestWithParam<PublishedHash> {};

TEST_P(HashTest, IsThePublishedOne) {
  if (kSanitized) GTEST_SKIP() << "other tests watch the same kernels";
  const PublishedHash& picture = GetParam();
  std::unique_ptr<HashedScene> scene;
  try {
    scene = std::make_unique<HashedScene>(picture);
  } catch (const Error& error) {
    if (error.status() != ExitStatus::io) throw;
    GTEST_SKIP() << error.what();
  }

  RenderOptions options = scene->options();
  bool odd = false;
  for (const std::string& target : simd::availableTargets()) {
    options.simd = target;
    odd = !odd;
    for (const int packet : odd ? std::array{1, 16} : std::array{4, 8}) {
      options.packet = packet;
      options.threads = packet == 1 || packet == 8 ? 1 : 8;
      EXPECT_EQ(scene->hash(options), picture.hashWith(target))
          << target << ", packets of " << packet << ", " << options.threads << " threads";
    }
  }
  simd::chooseTarget("auto");
}

INSTANTIATE_TEST_SUITE_P(Hard, HashTest, testing::ValuesIn(smallPictures()), [](const auto& info) {
  std::string name(info.param.scene.substr(0, info.param.scene.find(' ')));
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace whit::verify
