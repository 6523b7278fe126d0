// TGA in each of its forms: the pixels follow from the bytes.
#include "image_samples.h"

namespace whit {
namespace {

class ReadTga : public ImageTest {
 protected:
  static Bytes fileOf(const TgaForm& form, const Bytes& data) {
    return tgaOf(form, data, {'i', 'd', '!'});
  }
  Bytes codesOf(const TgaForm& form, const Bytes& data) {
    return read("a.tga", fileOf(form, data)).codes;
  }
};

TEST_F(ReadTga, RowsFromTheTopOrTheBottom) {
  const Bytes stored = {1, 2, 3, 4};
  EXPECT_EQ(codesOf({.type = 3, .bits = 8}, stored), stored);
  EXPECT_EQ(codesOf({.type = 3, .bits = 8, .descriptor = 0x00}, stored), (Bytes{3, 4, 1, 2}));
}

TEST_F(ReadTga, PalettesOfColorImagesArePassedOver) {
  for (const auto& [entryBits, bytes] : {std::pair{24, 6}, {15, 4}}) {
    Bytes data(static_cast<std::size_t>(bytes), 99);
    append(data, {1, 2, 3, 4});
    EXPECT_EQ(codesOf({.type = 3, .bits = 8, .entries = 2, .entryBits = entryBits}, data),
              (Bytes{1, 2, 3, 4}));
  }
}

TEST_F(ReadTga, RunsGoOnInTheNextRow) {
  EXPECT_EQ(codesOf({.type = 11, .bits = 8}, {0x00, 7, 0x82, 9}), (Bytes{7, 9, 9, 9}));
  EXPECT_EQ(codesOf({.type = 10}, {0x81, 3, 2, 1, 0x01, 6, 5, 4, 9, 8, 7}),
            (Bytes{1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

// The header may not state the number of alpha bits, and many writers leave the alpha 0 then.
TEST_F(ReadTga, AlphaCountsWhereThereIsAny) {
  const auto codes = [&](int descriptor, std::uint8_t alpha) {
    return codesOf({.bits = 32, .descriptor = descriptor, .height = 1},
                   {3, 2, 1, 0, 6, 5, 4, alpha});
  };

  EXPECT_EQ(codes(0x20, 0), (Bytes{1, 2, 3, 255, 4, 5, 6, 255}));
  EXPECT_EQ(codes(0x20, 9), (Bytes{1, 2, 3, 0, 4, 5, 6, 9}));
  EXPECT_EQ(codes(0x28, 0), (Bytes{1, 2, 3, 0, 4, 5, 6, 0}));
}

TEST_F(ReadTga, DamageIsToldWithItsPlace) {
  const std::string refused =
      ": byte 18: expected TGA's image type 2 or 10 of 24 or 32 bits, or 3 or 11 of 8, found type ";
  EXPECT_EQ(errorOf("a.tga", fileOf({.type = 33, .bits = 8}, {})), refused + "33 of 8 bits");
  EXPECT_EQ(errorOf("a.tga", fileOf({.bits = 16}, {})), refused + "2 of 16 bits");
  EXPECT_EQ(errorOf("a.tga", fileOf({.descriptor = 0x30}, {})),
            ": byte 18: expected rows in order and from the left");
  EXPECT_EQ(errorOf("a.tga", fileOf({.type = 11, .bits = 8}, {0x84, 9})),
            ": byte 23: expected pixels up to the image's end, found more");
  EXPECT_EQ(errorOf("a.tga", fileOf({}, {1, 2, 3})), ": byte 21: the file is cut short");
}

}  // namespace
}  // namespace whit
