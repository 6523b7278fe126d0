// PNG files that are damaged, and forms of them that are rare.
#include "has_text.h"
#include "image_samples.h"

namespace whit {
namespace {

class ReadPng : public ImageTest {
 protected:
  Bytes codesOf(const Bytes& file) { return read("a.png", file).codes; }
};

// The header's chunk ends at byte 33.
Bytes uptoHeader(const Bytes& whole) { return slice(whole, 0, 33); }

// The checksum of each chunk stands behind its data.
TEST_F(ReadPng, WrongChecksumsAreRefused) {
  const Bytes whole = png(2, 1, 8, 0, {0, 7, 8});
  EXPECT_EQ(errorOf("a.png", whole), "");

  // One bit of a checksum is flipped in each damaged file. The last chunk has 12 bytes.
  for (const auto& [at, message] :
       {std::pair{std::size_t{29},
                  ": byte 33: expected valid PNG data, found an error: IHDR: CRC error"},
        {whole.size() - 13, "IDAT: CRC error"},
        {whole.size() - 1, "IEND: CRC error"}}) {
    Bytes damaged = whole;
    damaged[at] ^= 1;
    EXPECT_TRUE(hasText(errorOf("a.png", damaged), message));
  }
}

// The wrong sum is that of the packed data in the chunks, which have checksums of their own.
TEST_F(ReadPng, WrongSumsOfThePixelsAreRefused) {
  Bytes rows = packed({0, 7, 8});
  rows.back() ^= 1;
  Bytes file = uptoHeader(png(2, 1, 8, 0, {}));
  appendPngChunk(file, "IDAT", rows);
  appendPngChunk(file, "IEND", {});
  EXPECT_NE(errorOf("a.png", file), "");
}

TEST_F(ReadPng, PalettesWithAndWithoutAlpha) {
  const Bytes whole = png(2, 1, 1, 3, {0, 0x40});
  Bytes file = uptoHeader(whole);
  appendPngChunk(file, "PLTE", {1, 2, 3, 4, 5, 6});
  Bytes clear = file;
  appendPngChunk(clear, "tRNS", {9});
  for (Bytes* to : {&file, &clear}) append(*to, slice(whole, 33));

  EXPECT_EQ(codesOf(file), (Bytes{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(codesOf(clear), (Bytes{1, 2, 3, 9, 4, 5, 6, 255}));
}

TEST_F(ReadPng, SmallGraysAreSpread) {
  EXPECT_EQ(codesOf(png(4, 1, 2, 0, {0, 0b00011011})), (Bytes{0, 85, 170, 255}));
}

// The rows of Adam7's passes follow one after the other; passes without rows are left out.
TEST_F(ReadPng, InterlacedRows) {
  const Bytes whole = png(3, 3, 8, 0, {0, 1, 0, 3, 0, 7, 9, 0, 2, 0, 8, 0, 4, 5, 6});
  Bytes header = slice(whole, 16, 29);
  header[12] = 1;
  Bytes file = slice(whole, 0, 8);
  appendPngChunk(file, "IHDR", header);
  append(file, slice(whole, 33));
  EXPECT_EQ(codesOf(file), (Bytes{1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

}  // namespace
}  // namespace whit
