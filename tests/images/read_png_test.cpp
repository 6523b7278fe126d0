// PNG files that are damaged, and forms of them that are rare.
#include "has_text.h"
#include "image_samples.h"

namespace whit {
namespace {

class ReadPng : public ImageTest {
 protected:
  RawImage read(const Bytes& file) { return readRawImage(save("a.png", file), limits_, warnings_); }
};

// The checksum of each chunk stands behind its data.
TEST_F(ReadPng, WrongChecksumsAreRefused) {
  const Bytes whole = png(2, 1, 8, 0, {0, 7, 8});
  const Bytes header = {'I', 'H', 'D', 'R'}, end = {'I', 'E', 'N', 'D'};
  const auto endAt = std::search(whole.begin(), whole.end(), end.begin(), end.end());

  // One bit of a checksum is flipped in each damaged file.
  Bytes badHeader = whole, badData = whole, badEnd = whole;
  badHeader[8 + 8 + 13] ^= 1;
  badData[static_cast<std::size_t>(endAt - whole.begin()) - 4 - 4] ^= 1;
  badEnd.back() ^= 1;

  EXPECT_EQ(errorOf("a.png", whole), "no error");
  EXPECT_EQ(errorOf("a.png", badHeader),
            ": byte 33: expected valid PNG data, found an error: IHDR: CRC error");
  EXPECT_TRUE(hasText(errorOf("a.png", badData), "IDAT: CRC error"));
  EXPECT_TRUE(hasText(errorOf("a.png", badEnd), "IEND: CRC error"));
}

// The wrong sum is that of the packed data in the chunks, which have checksums of their own.
TEST_F(ReadPng, WrongSumsOfThePixelsAreRefused) {
  Bytes rows = {0, 7, 8};
  uLongf size = compressBound(3);
  Bytes packed(size);
  compress(packed.data(), &size, rows.data(), 3);
  packed.resize(size);
  packed.back() ^= 1;

  const Bytes whole = png(2, 1, 8, 0, rows);
  Bytes file(whole.begin(), whole.begin() + 33);
  appendPngChunk(file, "IDAT", packed);
  appendPngChunk(file, "IEND", {});
  EXPECT_NE(errorOf("a.png", file), "no error");
}

TEST_F(ReadPng, PalettesWithAndWithoutAlpha) {
  const Bytes whole = png(2, 1, 1, 3, {0, 0x40});
  Bytes file(whole.begin(), whole.begin() + 33);
  appendPngChunk(file, "PLTE", {1, 2, 3, 4, 5, 6});
  Bytes clear = file;
  appendPngChunk(clear, "tRNS", {9});
  for (Bytes* to : {&file, &clear}) append(*to, Bytes(whole.begin() + 33, whole.end()));

  EXPECT_EQ(read(file).codes, (Bytes{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(read(clear).codes, (Bytes{1, 2, 3, 9, 4, 5, 6, 255}));
}

TEST_F(ReadPng, SmallGraysAreSpread) {
  EXPECT_EQ(read(png(4, 1, 2, 0, {0, 0b00011011})).codes, (Bytes{0, 85, 170, 255}));
}

// The rows of Adam7's passes follow one after the other; passes without rows are left out.
TEST_F(ReadPng, InterlacedRows) {
  const Bytes rows = {0, 1, 0, 3, 0, 7, 9, 0, 2, 0, 8, 0, 4, 5, 6};
  const Bytes whole = png(3, 3, 8, 0, rows);

  Bytes header(whole.begin() + 16, whole.begin() + 29);
  header[12] = 1;
  Bytes file(whole.begin(), whole.begin() + 8);
  appendPngChunk(file, "IHDR", header);
  append(file, Bytes(whole.begin() + 33, whole.end()));
  EXPECT_EQ(read(file).codes, (Bytes{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

}  // namespace
}  // namespace whit
