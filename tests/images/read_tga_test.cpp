// TGA in each of its forms: the pixels follow from the bytes.
#include "image_samples.h"

namespace whit {
namespace {

class ReadTga : public ImageTest {
 protected:
  struct Form {
    int type = 2, bits = 24, descriptor = 0x20;
    int firstEntry = 0, entries = 0, entryBits = 0;
    int width = 2, height = 2;
  };
  static Bytes tgaOf(const Form& form, const Bytes& data) {
    Bytes file = {3, static_cast<std::uint8_t>(form.entries > 0),
                  static_cast<std::uint8_t>(form.type)};
    append16(file, form.firstEntry);
    append16(file, form.entries);
    file.push_back(static_cast<std::uint8_t>(form.entryBits));
    append32(file, 0);
    append16(file, form.width);
    append16(file, form.height);
    append(file,
           {static_cast<std::uint8_t>(form.bits), static_cast<std::uint8_t>(form.descriptor)});
    append(file, {'i', 'd', '!'});
    append(file, data);
    return file;
  }
  RawImage read(const Form& form, const Bytes& data) {
    return readRawImage(save("a.tga", tgaOf(form, data)), limits_, warnings_);
  }
};

TEST_F(ReadTga, RowsAndColumnsInEitherDirection) {
  const Bytes stored = {1, 2, 3, 4};
  const auto codes = [&](int descriptor) {
    return read({.type = 3, .bits = 8, .descriptor = descriptor}, stored).codes;
  };
  EXPECT_EQ(codes(0x20), (Bytes{1, 2, 3, 4}));
  EXPECT_EQ(codes(0x00), (Bytes{3, 4, 1, 2}));
  EXPECT_EQ(codes(0x30), (Bytes{2, 1, 4, 3}));
  EXPECT_EQ(codes(0x10), (Bytes{4, 3, 2, 1}));
}

// 5 bits a channel, red highest.
TEST_F(ReadTga, PalettesOfEveryDepth) {
  const Bytes indices = {1, 0, 0, 1};
  const Bytes expected = {255, 0, 0, 8, 0, 255, 8, 0, 255, 255, 0, 0};
  const Bytes entries16 = {0x1f, 0x04, 0x00, 0x7c};
  for (const int bits : {15, 16}) {
    Bytes data = entries16;
    append(data, indices);
    const RawImage image = read({.type = 1, .bits = 8, .entries = 2, .entryBits = bits}, data);
    EXPECT_EQ(image.channels, 3);
    EXPECT_EQ(image.codes, expected) << bits;
  }
  Bytes data = {255, 0, 8, 0, 0, 255};
  append(data, indices);
  EXPECT_EQ(read({.type = 1, .bits = 8, .entries = 2, .entryBits = 24}, data).codes, expected);
  data = {3, 2, 1, 9, 6, 5, 4, 10};
  append(data, indices);
  EXPECT_EQ(read({.type = 1, .bits = 8, .entries = 2, .entryBits = 32}, data).codes,
            (Bytes{4, 5, 6, 10, 1, 2, 3, 9, 1, 2, 3, 9, 4, 5, 6, 10}));
}

TEST_F(ReadTga, PalettesMayBeginAnywhereAndHaveLongIndices) {
  Bytes data = {0, 0, 1, 0, 0, 2};  // blue first: reds of 1 and 2
  for (const int index : {301, 300, 300, 301}) append16(data, index);
  EXPECT_EQ(
      read({.type = 1, .bits = 16, .firstEntry = 300, .entries = 2, .entryBits = 24}, data).codes,
      (Bytes{2, 0, 0, 1, 0, 0, 1, 0, 0, 2, 0, 0}));
}

TEST_F(ReadTga, PalettesOfColorImagesArePassedOver) {
  Bytes data(6, 99);
  append(data, {1, 2, 3, 4});
  EXPECT_EQ(read({.type = 3, .bits = 8, .entries = 2, .entryBits = 24}, data).codes,
            (Bytes{1, 2, 3, 4}));
}

TEST_F(ReadTga, RunsGoOnInTheNextRow) {
  EXPECT_EQ(read({.type = 11, .bits = 8}, {0x00, 7, 0x82, 9}).codes, (Bytes{7, 9, 9, 9}));
  EXPECT_EQ(read({.type = 10, .bits = 16}, {0x81, 0x00, 0x7c, 0x01, 0x1f, 0, 0xe0, 0x03}).codes,
            (Bytes{255, 0, 0, 255, 0, 0, 0, 0, 255, 0, 255, 0}));
}

// Whose number the header may not tell, and which many writers then leave 0.
TEST_F(ReadTga, AlphaCountsWhereThereIsAny) {
  const auto codes = [&](int descriptor, std::uint8_t alpha) {
    return read({.bits = 32, .descriptor = descriptor, .width = 2, .height = 1},
                {3, 2, 1, 0, 6, 5, 4, alpha})
        .codes;
  };
  EXPECT_EQ(codes(0x20, 0), (Bytes{1, 2, 3, 255, 4, 5, 6, 255}));
  EXPECT_EQ(codes(0x20, 9), (Bytes{1, 2, 3, 0, 4, 5, 6, 9}));
  EXPECT_EQ(codes(0x28, 0), (Bytes{1, 2, 3, 0, 4, 5, 6, 0}));
}

TEST_F(ReadTga, DamageIsToldWithItsPlace) {
  EXPECT_EQ(errorOf("a.tga", tgaOf({.type = 1, .bits = 8, .entries = 1, .entryBits = 24},
                                   {1, 2, 3, 0, 0, 0, 1})),
            ": byte 28: expected a color of the palette, of which there are 1 from number 0, found "
            "number 1");
  EXPECT_EQ(errorOf("a.tga", tgaOf({.type = 11, .bits = 8}, {0x84, 9})),
            ": byte 22: expected pixels up to the image's end, found more");
  EXPECT_EQ(errorOf("a.tga", tgaOf({.type = 33, .bits = 8}, {})),
            ": byte 3: expected TGA's image type 1, 2, 3, 9, 10 or 11, found 33");
  EXPECT_EQ(errorOf("a.tga", tgaOf({.bits = 12}, {})),
            ": byte 21: expected pixels of 8 to 32 bits, found 12");
  EXPECT_EQ(errorOf("a.tga", tgaOf({.bits = 24}, {1, 2, 3})), ": byte 21: the file is cut short");
}

}  // namespace
}  // namespace whit
