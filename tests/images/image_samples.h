// Small image files made by hand, and a folder to put them in.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/image/image_file.h"
#include "temporary_folder.h"

namespace whit {

using Bytes = std::vector<std::uint8_t>;

// The status of the Error that `run` throws; `done` when it throws none.
template <typename Run>
ExitStatus statusOf(Run&& run) {
  try {
    run();
  } catch (const Error& e) {
    return e.status();
  }
  return ExitStatus::done;
}

// A new folder for each test, removed afterwards.
class ImageTest : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_ + "/" + name; }
  std::string save(const std::string& name, const Bytes& bytes) const {
    // Some file systems wait for the disk when a file that exists is written anew.
    std::filesystem::remove(path(name));
    std::ofstream out(path(name), std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()),
              static_cast<std::streamsize>(bytes.size()));
    return path(name);
  }
  // Returns the message of the error that such a file causes, without the file's name.
  std::string errorOf(const std::string& name, const Bytes& bytes) {
    const std::string file = save(name, bytes);
    try {
      readRawImage(file, limits_, warnings_);
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), ExitStatus::badScene) << error.what();
      return std::string(error.what()).substr(file.size());
    }
    return "no error";
  }
  static Bytes load(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(in), {});
  }
  std::size_t filesInFolder() const {
    return static_cast<std::size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), {}));
  }

  const TemporaryFolder temporary_;
  const std::string folder_ = temporary_.path().string();
  ImageLimits limits_;
  Warnings warnings_;
};

inline void append(Bytes& to, const Bytes& bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}
inline void append16(Bytes& to, int v) {
  append(to, {static_cast<std::uint8_t>(v & 255), static_cast<std::uint8_t>(v >> 8 & 255)});
}
inline void append32(Bytes& to, int v) {
  append16(to, v & 0xffff);
  append16(to, v >> 16 & 0xffff);
}

// Uncompressed, from the top, blue first in the file. `rgb` is 3 codes a pixel.
inline Bytes tga(int width, int height, const Bytes& rgb) {
  Bytes file = {0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  append16(file, width);
  append16(file, height);
  append(file, {24, 0x20});
  for (std::size_t i = 0; i < rgb.size(); i += 3) append(file, {rgb[i + 2], rgb[i + 1], rgb[i]});
  return file;
}

// 24 bits, bottom row first, rows padded to 4 bytes.
inline Bytes bmp(int width, int height, const Bytes& rgb) {
  const int stride = (3 * width + 3) / 4 * 4;
  Bytes file = {'B', 'M'};
  append32(file, 54 + stride * height);
  append32(file, 0);
  append32(file, 54);
  append32(file, 40);
  append32(file, width);
  append32(file, height);
  append16(file, 1);
  append16(file, 24);
  for (int i = 0; i < 6; ++i) append32(file, 0);

  for (int y = height - 1; y >= 0; --y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = static_cast<std::size_t>(3 * (y * width + x));
      append(file, {rgb[i + 2], rgb[i + 1], rgb[i]});
    }
    for (int pad = 3 * width; pad < stride; ++pad) file.push_back(0);
  }

  return file;
}

// Radiance RGBE, flat. `rgbe` is 4 bytes a pixel.
inline Bytes hdr(int width, int height, const Bytes& rgbe) {
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) +
                           " +X " + std::to_string(width) + "\n";
  Bytes file(head.begin(), head.end());
  append(file, rgbe);
  return file;
}

// Radiance RGBE with run lengths: each of the four planes of a row is one run. `width` from 8 to
// 127.
inline Bytes hdrRuns(int width, int height, const std::array<std::uint8_t, 4>& rgbe) {
  Bytes file = hdr(width, height, {});
  for (int y = 0; y < height; ++y) {
    append(file, {2, 2, 0, static_cast<std::uint8_t>(width)});
    for (const std::uint8_t value : rgbe)
      append(file, {static_cast<std::uint8_t>(128 + width), value});
  }
  return file;
}

// A gray baseline JPEG of one 8x8 block whose only coefficient is DC: 8 * (200 - 128) = 576, which
// is 10 bits long, so the entropy-coded data is the only DC code (0), 1001000000, the only AC code,
// end of block (0), and ones up to the byte.
inline Bytes jpegGray200() {
  Bytes file = {0xff, 0xd8, 0xff, 0xdb, 0, 67, 0};
  append(file, Bytes(64, 1));
  append(file, {0xff, 0xc0, 0, 11, 8, 0, 8, 0, 8, 1, 1, 0x11, 0});
  append(file, {0xff, 0xc4, 0, 20, 0x00, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 10});
  append(file, {0xff, 0xc4, 0, 20, 0x10, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  append(file, {0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0});
  append(file, {0b01001000, 0b00001111, 0xff, 0xd9});
  return file;
}

inline void appendPngChunk(Bytes& file, const char* type, const Bytes& data) {
  const auto big = [](std::uint32_t v) {
    return Bytes{static_cast<std::uint8_t>(v >> 24), static_cast<std::uint8_t>(v >> 16),
                 static_cast<std::uint8_t>(v >> 8), static_cast<std::uint8_t>(v)};
  };
  append(file, big(static_cast<std::uint32_t>(data.size())));

  Bytes body(type, type + 4);
  append(body, data);
  append(file, body);
  append(
      file,
      big(static_cast<std::uint32_t>(crc32(0, body.data(), static_cast<unsigned>(body.size())))));
}

// `rows` is what PNG deflates: a filter byte (0) before each row. Color types: 0 gray, 2 RGB,
// 4 gray and alpha, 6 RGBA.
inline Bytes png(int width, int height, int bits, int colorType, const Bytes& rows) {
  Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  const auto byte = [](int v, int shift) { return static_cast<std::uint8_t>(v >> shift & 255); };
  appendPngChunk(file, "IHDR",
                 {byte(width, 24), byte(width, 16), byte(width, 8), byte(width, 0),
                  byte(height, 24), byte(height, 16), byte(height, 8), byte(height, 0),
                  static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(colorType), 0, 0, 0});

  uLongf size = compressBound(static_cast<uLong>(rows.size()));
  Bytes packed(size);
  compress(packed.data(), &size, rows.data(), static_cast<uLong>(rows.size()));
  packed.resize(size);

  appendPngChunk(file, "IDAT", packed);
  appendPngChunk(file, "IEND", {});
  return file;
}

}  // namespace whit
