// TGA in each of its forms: the pixels follow from the bytes.
#include "image_samples.h"

namespace whit {
namespace {

class ReadTga : public ImageTest {
 protected:
  struct Form {
    int type = 2, bits = 24, descriptor = 0x20;
    int entries = 0, entryBits = 0;
    int width = 2, height = 2;
  };
  static Bytes tgaOf(const Form& form, const Bytes& data) {
    Bytes file = {3, static_cast<std::uint8_t>(form.entries > 0),
                  static_cast<std::uint8_t>(form.type)};
    append16(file, 0);
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

TEST_F(ReadTga, RowsFromTheTopOrTheBottom) {
  const Bytes stored = {1, 2, 3, 4};
  EXPECT_EQ(read({.type = 3, .bits = 8, .descriptor = 0x20}, stored).codes, stored);
  EXPECT_EQ(read({.type = 3, .bits = 8, .descriptor = 0x00}, stored).codes, (Bytes{3, 4, 1, 2}));
}

TEST_F(ReadTga, PalettesOfColorImagesArePassedOver) {
  Bytes data(6, 99);
  append(data, {1, 2, 3, 4});
  EXPECT_EQ(read({.type = 3, .bits = 8, .entries = 2, .entryBits = 24}, data).codes,
            (Bytes{1, 2, 3, 4}));
}

TEST_F(ReadTga, RunsGoOnInTheNextRow) {
  EXPECT_EQ(read({.type = 11, .bits = 8}, {0x00, 7, 0x82, 9}).codes, (Bytes{7, 9, 9, 9}));
  EXPECT_EQ(read({.type = 10}, {0x81, 3, 2, 1, 0x01, 6, 5, 4, 9, 8, 7}).codes,
            (Bytes{1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

// The header may not state the number of alpha bits, and many writers leave the alpha 0 then.
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
  const auto refused = [](int type, int bits) {
    return ": byte 18: expected TGA's image type 2 or 10 of 24 or 32 bits, or 3 or 11 of 8, found "
           "type " +
           std::to_string(type) + " of " + std::to_string(bits) + " bits";
  };

  EXPECT_EQ(errorOf("a.tga", tgaOf({.type = 33, .bits = 8}, {})), refused(33, 8));
  EXPECT_EQ(errorOf("a.tga", tgaOf({.bits = 16}, {})), refused(2, 16));
  EXPECT_EQ(errorOf("a.tga", tgaOf({.descriptor = 0x30}, {})),
            ": byte 18: expected rows in order and from the left");
  EXPECT_EQ(errorOf("a.tga", tgaOf({.type = 11, .bits = 8}, {0x84, 9})),
            ": byte 23: expected pixels up to the image's end, found more");
  EXPECT_EQ(errorOf("a.tga", tgaOf({.bits = 24}, {1, 2, 3})), ": byte 21: the file is cut short");
}

}  // namespace
}  // namespace whit
