// BMP in each of its forms: the pixels follow from the bytes.
#include "image_samples.h"

namespace whit {
namespace {

class ReadBmp : public ImageTest {
 protected:
  Bytes codesOf(const BmpForm& form, const Bytes& behind, const Bytes& data) {
    return read("a.bmp", bmpOf(form, behind, data)).codes;
  }
  // Color i of a palette is (i, 10 + i, 20 + i).
  static Bytes colorsOf(const Bytes& indices) {
    Bytes codes;
    for (const std::uint8_t i : indices) append(codes, {i, byteOf(10 + i), byteOf(20 + i)});
    return codes;
  }
  static Bytes palette(int colors) {
    Bytes bytes;
    for (int i = 0; i < colors; ++i) {
      append(bytes, {byteOf(20 + i), byteOf(10 + i), byteOf(i), 0});
    }
    return bytes;
  }
};

TEST_F(ReadBmp, RowsBeginAtTheBottomAndArePadded) {
  EXPECT_EQ(codesOf({}, palette(8), {1, 2, 3, 0, 4, 5, 6, 0}), colorsOf({4, 5, 6, 1, 2, 3}));
  Bytes file = bmpOf({.width = 1, .bits = 24}, {}, {3, 2, 1, 0, 6, 5, 4});
  const Bytes codes{4, 5, 6, 1, 2, 3};
  EXPECT_EQ(read("a.bmp", file).codes, codes);

  // With a negative height they begin at the top.
  EXPECT_EQ(codesOf({.height = -2}, palette(8), {1, 2, 3, 0, 4, 5, 6, 0}),
            colorsOf({1, 2, 3, 4, 5, 6}));

  // Some programs leave the length of the file at 0.
  std::fill_n(file.begin() + 2, 4, std::uint8_t{0});
  EXPECT_EQ(read("a.bmp", file).codes, codes);
}

TEST_F(ReadBmp, MasksInTheUsualOrder) {
  Bytes masks;
  for (const int mask : {0xff0000, 0xff00, 0xff}) append32(masks, mask);
  EXPECT_EQ(codesOf({.width = 1, .height = -1, .bits = 32, .compression = 3}, masks, {3, 2, 1, 9}),
            (Bytes{1, 2, 3, 9}));
}

TEST_F(ReadBmp, AlphaCountsWhereThereIsAny) {
  const BmpForm form{.width = 1, .bits = 32};
  EXPECT_EQ(codesOf(form, {}, {3, 2, 1, 0, 6, 5, 4, 0}), (Bytes{4, 5, 6, 255, 1, 2, 3, 255}));
  EXPECT_EQ(codesOf(form, {}, {3, 2, 1, 9, 6, 5, 4, 0}), (Bytes{4, 5, 6, 0, 1, 2, 3, 9}));
}

TEST_F(ReadBmp, DamageIsToldWithItsPlace) {
  EXPECT_EQ(errorOf("a.bmp", bmpOf({}, palette(2), {0, 1, 2, 0, 0, 0, 0, 0})),
            ": byte 65: expected one of the palette's 2 colors, found number 2");
  EXPECT_EQ(errorOf("a.bmp", bmpOf({.bits = 32, .compression = 3}, Bytes(12, 5), {})),
            ": byte 58: expected uncompressed pixels of 8, 24 or 32 bits, found 32 bits and "
            "compression 3");
  EXPECT_EQ(errorOf("a.bmp", bmpOf({.bits = 8, .compression = 1}, palette(2), {})),
            ": byte 54: expected uncompressed pixels of 8, 24 or 32 bits, found 8 bits and "
            "compression 1");

  Bytes core = bmpOf({}, palette(2), {});
  core[14] = 12;
  EXPECT_EQ(errorOf("a.bmp", core),
            ": byte 18: expected a header of 40 to 124 bytes, found one of 12");

  EXPECT_EQ(errorOf("a.bmp", bmpOf({}, palette(2), {0, 1})), ": byte 62: the file is cut short");
}

}  // namespace
}  // namespace whit
