#include "io/image/image_layers.h"

#include "image_samples.h"

namespace whit {
namespace {

Rgb pixelAt(int x, int y, float blue = 0) {
  return {static_cast<float>(x), static_cast<float>(y), blue};
}

class MergeImages : public ImageTest {
 protected:
  std::string part(const std::string& name, const Crop& crop, const ImageMetadata& metadata) {
    return part(name, crop, 0, 8, metadata);
  }
  std::string part(const std::string& name, const Crop& crop, float blue = 0, int width = 8,
                   const ImageMetadata& metadata = {}) {
    Image image(width, 6, crop);
    for (int y = crop.y0; y < crop.y1; ++y) {
      for (int x = crop.x0; x < crop.x1; ++x) image.at(x, y) = pixelAt(x, y, blue);
    }
    writeExr(path(name), image, metadata);
    return path(name);
  }
  MergedImage merge(const std::vector<std::string>& paths) {
    return mergeImages(paths, limits_, warnings_);
  }
  ExitStatus statusOf(const std::vector<std::string>& paths) {
    return whit::statusOf([&] { merge(paths); });
  }
};

// Two of the parts overlap, and agree.
TEST_F(MergeImages, PutsCropsInTheirPlaces) {
  const Image image =
      merge({part("c.exr", {3, 1, 8, 6}), part("a.exr", {0, 0, 8, 2}), part("b.exr", {0, 2, 3, 6})})
          .image;

  EXPECT_EQ(image.window, (Crop{0, 0, 8, 6}));
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) EXPECT_EQ(image.at(x, y), pixelAt(x, y));
  }
  EXPECT_TRUE(warnings_.entries().empty());
}

// A file of codes has straight colors, and the merged EXR has premultiplied ones.
TEST_F(MergeImages, AlphaOfCodesIsKept) {
  const std::string codes = save("a.png", png(1, 1, 8, 6, {0, 255, 0, 255, 51}));
  const MergedImage merged = merge({codes});
  EXPECT_EQ(merged.image.at(0, 0), Rgb(0.2f, 0, 0.2f));
  ASSERT_EQ(merged.layers.size(), 1u);
  EXPECT_EQ(merged.layers[0].name, "A");
  EXPECT_EQ(merged.layers[0].floats(), std::vector{0.2f});
}

TEST_F(MergeImages, WhereOverlapsDifferTheLaterWinsAndIsCounted) {
  const Image image = merge({part("a.exr", {0, 0, 8, 4}, 1), part("b.exr", {0, 3, 8, 6}, 2)}).image;
  EXPECT_EQ(image.at(0, 2).z, 1);
  EXPECT_EQ(image.at(0, 3).z, 2);

  const auto entry = warnings_.entries().at("overlapping parts differ, the later one taken");
  EXPECT_EQ(entry.count, 8u);
  EXPECT_EQ(entry.first, path("b.exr") + " at (0, 3)");

  // Strict warnings are errors.
  Warnings strict(true);
  EXPECT_EQ(whit::statusOf([&] {
              mergeImages({path("a.exr"), path("b.exr")}, limits_, strict);
            }),
            ExitStatus::badScene);
}

TEST_F(MergeImages, GapsAreNamed) {
  EXPECT_EQ(refusalOf(ExitStatus::usage,
                      [&] {
                        merge({part("a.exr", {0, 0, 8, 2}), part("b.exr", {0, 2, 7, 6})});
                      }),
            "the parts leave 4 pixels of the 8x6 image open, the first at (7, 2)");
}

TEST_F(MergeImages, SizesMustMatch) {
  const std::string eight = part("a.exr", {0, 0, 8, 6}), nine = part("b.exr", {0, 0, 9, 6}, 0, 9);
  EXPECT_EQ(statusOf({eight, nine}), ExitStatus::usage);
  EXPECT_EQ(statusOf({}), ExitStatus::usage);
  EXPECT_EQ(statusOf({path("absent.exr")}), ExitStatus::io);
}

TEST_F(MergeImages, KeepsTheTextThatAllPartsAgreeOn) {
  const MergedImage merged =
      merge({part("a.exr", {0, 0, 8, 3}, {{"crop", "0,0,8,3"}, {"spp", "4"}, {"simd", "a"}}),
             part("b.exr", {0, 3, 8, 6}, {{"crop", "0,3,8,6"}, {"spp", "4"}, {"simd", "b"}})});
  EXPECT_EQ(merged.metadata, (ImageMetadata{{"spp", "4"}}));

  // The whole is no crop, whatever a part says.
  const std::string all = part("c.exr", {0, 0, 8, 6}, {{"crop", "0,0,8,6"}, {"spp", "4"}});
  EXPECT_EQ(merge({all, all}).metadata, merged.metadata);
}

// Text by which whit describes a picture, and what merging such a part with one of kText says;
// empty if it merges.
struct OtherText {
  const char *key, *value, *refusal;
};
const ImageMetadata kText{{"software", "whit 1"}, {"scene", "tiny"},    {"spp", "4"},
                          {"simd", "a"},          {"packet", "4"},      {"exposure", "0"},
                          {"exr", "half"},        {"sceneDigest", "12"}};

TEST_F(MergeImages, RefusesPartsOfOtherPictures) {
  constexpr OtherText kOthers[] = {{"spp", "16", "spp"},
                                   {"disable", "shadows", "disable"},
                                   {"sceneDigest", "34", "sceneDigest"},
                                   {"sceneDigest", "", "sceneDigest"},
                                   {"crop", "0,3,8,6", ""},
                                   {"simd", "b", ""},
                                   {"packet", "8", ""},
                                   {"exposure", "2", ""},
                                   {"camera", "front", "camera"},
                                   {"exr", "", ""},
                                   {"scene", "copy", "scene"},
                                   {"software", "whit 2", ""}};
  const std::string first = part("a.exr", {0, 0, 8, 3}, kText);

  for (const OtherText& other : kOthers) {
    ImageMetadata text = kText;
    std::erase_if(text, [&](const auto& entry) { return entry.first == other.key; });
    if (*other.value != 0) text.emplace_back(other.key, other.value);
    const std::string second = part("b.exr", {0, 3, 8, 6}, text);

    const std::string expected = "'" + second + "' and '" + first +
                                 "' are parts of different pictures: they differ in " +
                                 other.refusal;
    EXPECT_EQ(refusalOf(ExitStatus::usage,
                        [&] {
                          merge({first, second});
                        }),
              *other.refusal == 0 ? "" : expected)
        << other.key << " " << other.value;
  }

  // Parts that say nothing, as other programs write them, are merged.
  const std::string bare = part("c.exr", {0, 3, 8, 6});
  EXPECT_EQ(statusOf({first, bare}), ExitStatus::done);

  // Their place in the list does not hide that others differ.
  const std::string other = part("d.exr", {0, 3, 8, 6}, {{"spp", "16"}});
  EXPECT_EQ(statusOf({first, bare, other}), ExitStatus::usage);
  EXPECT_EQ(statusOf({bare, first, other}), ExitStatus::usage);
}

}  // namespace
}  // namespace whit
