// BMP in each of its forms: the pixels follow from the bytes.
#include "image_samples.h"

namespace whit {
namespace {

class ReadBmp : public ImageTest {
 protected:
  struct Form {
    int width = 3, height = 2, bits = 8, compression = 0, colors = 0;
  };
  // Makes a file with the header of 40 bytes; `behind` is a palette or masks.
  static Bytes bmpOf(const Form& form, const Bytes& behind, const Bytes& data) {
    Bytes file = {'B', 'M'};
    append32(file, 0);
    append32(file, 0);
    append32(file, 54 + static_cast<int>(behind.size()));
    append32(file, 40);
    append32(file, form.width);
    append32(file, form.height);
    append16(file, 1);
    append16(file, form.bits);
    append32(file, form.compression);
    for (int i = 0; i < 3; ++i) append32(file, 0);
    append32(file, form.colors);
    append32(file, 0);

    append(file, behind);
    append(file, data);
    return file;
  }
  RawImage read(const Bytes& file) { return readRawImage(save("a.bmp", file), limits_, warnings_); }
  // Color i of a palette is (i, 10 + i, 20 + i).
  static Bytes palette(int colors) {
    Bytes bytes;
    for (int i = 0; i < colors; ++i) {
      append(bytes, {static_cast<std::uint8_t>(20 + i), static_cast<std::uint8_t>(10 + i),
                     static_cast<std::uint8_t>(i), 0});
    }
    return bytes;
  }
  static Bytes colorsOf(const Bytes& indices) {
    Bytes codes;
    for (const std::uint8_t i : indices) {
      append(codes, {i, static_cast<std::uint8_t>(10 + i), static_cast<std::uint8_t>(20 + i)});
    }
    return codes;
  }
};

TEST_F(ReadBmp, RowsBeginAtTheBottomAndArePadded) {
  EXPECT_EQ(read(bmpOf({}, palette(8), {1, 2, 3, 0, 4, 5, 6, 0})).codes,
            colorsOf({4, 5, 6, 1, 2, 3}));
  EXPECT_EQ(read(bmpOf({.width = 1, .bits = 24}, {}, {3, 2, 1, 0, 6, 5, 4})).codes,
            (Bytes{4, 5, 6, 1, 2, 3}));
}

TEST_F(ReadBmp, NegativeHeightsBeginAtTheTop) {
  EXPECT_EQ(read(bmpOf({.height = -2}, palette(8), {1, 2, 3, 0, 4, 5, 6, 0})).codes,
            colorsOf({1, 2, 3, 4, 5, 6}));
}

TEST_F(ReadBmp, MasksInTheUsualOrder) {
  Bytes masks;
  for (const int mask : {0xff0000, 0xff00, 0xff}) append32(masks, mask);
  EXPECT_EQ(
      read(bmpOf({.width = 1, .height = -1, .bits = 32, .compression = 3}, masks, {3, 2, 1, 9}))
          .codes,
      (Bytes{1, 2, 3, 9}));
}

TEST_F(ReadBmp, AlphaCountsWhereThereIsAny) {
  const Form form{.width = 1, .height = 2, .bits = 32};
  EXPECT_EQ(read(bmpOf(form, {}, {3, 2, 1, 0, 6, 5, 4, 0})).codes,
            (Bytes{4, 5, 6, 255, 1, 2, 3, 255}));
  EXPECT_EQ(read(bmpOf(form, {}, {3, 2, 1, 9, 6, 5, 4, 0})).codes, (Bytes{4, 5, 6, 0, 1, 2, 3, 9}));
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
