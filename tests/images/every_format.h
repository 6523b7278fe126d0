// A small picture in each format, whose pixels differ.
#pragma once

#include "foreign_exr.h"
#include "image_samples.h"

namespace whit {

struct FormatSample {
  std::string name;
  Bytes bytes;
  std::uint64_t decoded;  // bytes
};

class EveryFormat : public ImageTest {
 protected:
  std::vector<FormatSample> samples() {
    Bytes codes;
    for (int i = 0; i < 48; ++i) codes.push_back(byteOf(i * 5 + 3));

    Image image(5, 4, {1, 1, 4, 4});
    for (Rgb& pixel : image.pixels) pixel = Rgb(static_cast<float>(&pixel - image.pixels.data()));
    writeExr(path("lines.exr"), image, {{"name", "text"}});
    ForeignFile{.channels = {{"Y", 0.5f}}, .type = Imf::HALF}.writeTiled(path("tiles.exr"));

    // A filter byte, which is 0, begins each of PNG's rows.
    Bytes rows = codes;
    rows[0] = rows[13] = rows[26] = 0;
    return {{"a.tga", tga(4, 4, codes), 48},
            {"a.bmp", bmp(4, 4, codes), 48},
            {"a.png", png(4, 3, 8, 2, slice(rows, 0, 39)), 36},
            {"a.jpg", jpegGray200(), 64},
            {"a.hdr", hdr(4, 3, codes), 144},
            {"b.hdr", hdrRuns(20, 3, {1, 2, 3, 130}), 720},
            {"a.exr", load(path("lines.exr")), 240},
            {"b.exr", load(path("tiles.exr")), 48}};
  }
};

}  // namespace whit
