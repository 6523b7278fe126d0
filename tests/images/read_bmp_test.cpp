// BMP in each of its forms: the pixels follow from the bytes.
#include "image_samples.h"

namespace whit {
namespace {

class ReadBmp : public ImageTest {
 protected:
  struct Form {
    int width = 3, height = 2, bits = 8, compression = 0, colors = 0;
  };
  // With the header of 40 bytes; `behind` is a palette or masks.
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
  static Bytes palette(int colors, bool padded = true) {
    Bytes bytes;
    for (int i = 0; i < colors; ++i) {
      append(bytes, {static_cast<std::uint8_t>(20 + i), static_cast<std::uint8_t>(10 + i),
                     static_cast<std::uint8_t>(i)});
      if (padded) bytes.push_back(0);
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

// OS/2's header of 12 bytes; three bytes a color.
TEST_F(ReadBmp, CoreHeadersAndTheirPalettes) {
  const auto core = [](int bits, const Bytes& colors, const Bytes& data) {
    Bytes file = {'B', 'M'};
    append32(file, 0);
    append32(file, 0);
    append32(file, 26 + static_cast<int>(colors.size()));
    append32(file, 12);
    for (const int number : {3, 2, 1, bits}) append16(file, number);
    append(file, colors);
    append(file, data);
    return file;
  };
  const Bytes expected = colorsOf({4, 5, 6, 1, 2, 3});
  EXPECT_EQ(read(core(8, palette(256 - 20, false), {1, 2, 3, 0, 4, 5, 6, 0})).codes, expected);
  EXPECT_EQ(read(core(4, palette(16, false), {0x12, 0x30, 0, 0, 0x45, 0x60, 0, 0})).codes,
            expected);
  EXPECT_EQ(read(core(1, palette(2, false), {0x40, 0, 0, 0, 0xa0, 0, 0, 0})).codes,
            colorsOf({1, 0, 1, 0, 1, 0}));
  EXPECT_EQ(
      read(core(24, {}, {3, 2, 1, 3, 2, 1, 3, 2, 1, 0, 0, 0, 6, 5, 4, 6, 5, 4, 6, 5, 4, 0, 0, 0}))
          .codes,
      (Bytes{4, 5, 6, 4, 5, 6, 4, 5, 6, 1, 2, 3, 1, 2, 3, 1, 2, 3}));
}

TEST_F(ReadBmp, NegativeHeightsBeginAtTheTop) {
  EXPECT_EQ(read(bmpOf({.height = -2}, palette(8), {1, 2, 3, 0, 4, 5, 6, 0})).codes,
            colorsOf({1, 2, 3, 4, 5, 6}));
}

TEST_F(ReadBmp, RunsOfEightBits) {
  // A run, a row's end, three plain pixels and their padding, the end.
  EXPECT_EQ(read(bmpOf({.compression = 1}, palette(8), {3, 1, 0, 0, 0, 3, 4, 5, 6, 0, 0, 1})).codes,
            colorsOf({4, 5, 6, 1, 1, 1}));
  // One to the right and one up; what is passed over has color 0.
  EXPECT_EQ(read(bmpOf({.compression = 1}, palette(8), {0, 2, 1, 1, 2, 7, 0, 1})).codes,
            colorsOf({0, 7, 7, 0, 0, 0}));
}

// As many a writer has it, up to a multiple of four bytes.
TEST_F(ReadBmp, RunsMayFillRowsBeyondTheirEnd) {
  EXPECT_EQ(read(bmpOf({.compression = 1}, palette(8), {4, 1, 0, 0, 0, 4, 4, 5, 6, 7, 0, 1})).codes,
            colorsOf({4, 5, 6, 1, 1, 1}));
}

TEST_F(ReadBmp, RunsOfFourBits) {
  EXPECT_EQ(read(bmpOf({.bits = 4, .compression = 2}, palette(16),
                       {3, 0x12, 0, 0, 0, 3, 0x45, 0x60, 0, 0, 0, 1}))
                .codes,
            colorsOf({4, 5, 6, 1, 2, 1}));
}

TEST_F(ReadBmp, MasksOfAnyWidth) {
  Bytes masks;
  for (const int mask : {0xf800, 0x07e0, 0x001f}) append32(masks, mask);
  Bytes data;
  for (const int pixel : {0xf800, 0x07e0, 0x001f, 0, 0x8410, 0xffff, 0, 0}) append16(data, pixel);
  EXPECT_EQ(read(bmpOf({.height = -2, .bits = 16, .compression = 3}, masks, data)).codes,
            (Bytes{255, 0, 0, 0, 255, 0, 0, 0, 255, 132, 130, 132, 255, 255, 255, 0, 0, 0}));
  masks.clear();
  for (const int mask : {0x3ff, 0xffc00, 0x3ff00000}) append32(masks, mask);
  data.clear();
  append32(data, 0x3ff);
  append32(data, 512 << 10);
  append32(data, 1023 << 20);
  EXPECT_EQ(read(bmpOf({.height = -1, .bits = 32, .compression = 3}, masks, data)).codes,
            (Bytes{255, 0, 0, 0, 128, 0, 0, 0, 255}));
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
  EXPECT_EQ(errorOf("a.bmp", bmpOf({.bits = 16, .compression = 3}, Bytes(12, 5), {})),
            ": byte 58: expected a mask of neighboring bits");
  EXPECT_EQ(errorOf("a.bmp", bmpOf({.bits = 8, .compression = 4}, palette(2), {})),
            ": byte 50: expected 1, 2, 4, 8, 16, 24 or 32 bits a pixel, run lengths of 8 or 4 "
            "bits, or masks of 16 or 32, found 8 bits and compression 4");
  EXPECT_EQ(errorOf("a.bmp", bmpOf({}, palette(2), {0, 1})), ": byte 62: the file is cut short");
}

}  // namespace
}  // namespace whit
