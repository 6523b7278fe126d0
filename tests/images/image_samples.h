// Small image files made by hand, and a folder to put them in.
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
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

// The message of the Error of this status that `run` throws; empty when it throws none.
template <typename Run>
std::string refusalOf(ExitStatus status, Run&& run) {
  try {
    run();
  } catch (const Error& e) {
    EXPECT_EQ(e.status(), status) << e.what();
    return e.what();
  }
  return {};
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
  RawImage read(const std::string& file) { return readRawImage(file, limits_, warnings_); }
  RawImage read(const std::string& name, const Bytes& bytes) { return read(save(name, bytes)); }
  ExitStatus readStatus(const std::string& file) {
    return statusOf([&] { read(file); });
  }
  ExitStatus readStatus(const std::string& name, const Bytes& bytes) {
    return readStatus(save(name, bytes));
  }
  // Returns the message of the error that such a file causes, without the file's name.
  std::string errorOf(const std::string& name, const Bytes& bytes) {
    const std::string file = save(name, bytes);
    const std::string message = refusalOf(ExitStatus::badScene, [&] { read(file); });
    return message.substr(std::min(file.size(), message.size()));
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
inline std::uint8_t byteOf(int v) { return static_cast<std::uint8_t>(v & 255); }
inline void append16(Bytes& to, int v) { append(to, {byteOf(v), byteOf(v >> 8)}); }
inline void append32(Bytes& to, int v) {
  append16(to, v);
  append16(to, v >> 16);
}
// The same with the highest byte first.
inline void appendBig32(Bytes& to, int v) {
  for (const int shift : {24, 16, 8, 0}) to.push_back(byteOf(v >> shift));
}
// The bytes from one place up to another one, by default up to the end.
inline Bytes slice(const Bytes& bytes, std::size_t from, std::size_t to = std::string::npos) {
  const auto whole = std::span(bytes).first(std::min(to, bytes.size()));
  return Bytes(whole.begin() + static_cast<std::ptrdiff_t>(from), whole.end());
}

// The blue of each pixel first, as TGA and BMP have it. `rgb` is 3 codes a pixel.
inline Bytes blueFirst(Bytes rgb) {
  for (std::size_t i = 0; i < rgb.size(); i += 3) std::swap(rgb[i], rgb[i + 2]);
  return rgb;
}

struct TgaForm {
  int type = 2, bits = 24, descriptor = 0x20;
  int entries = 0, entryBits = 0;
  int width = 2, height = 2;
};
inline Bytes tgaOf(const TgaForm& form, const Bytes& data, const Bytes& id = {}) {
  Bytes file = {byteOf(static_cast<int>(id.size())), form.entries > 0, byteOf(form.type)};
  append16(file, 0);
  append16(file, form.entries);
  file.push_back(byteOf(form.entryBits));
  append32(file, 0);
  append16(file, form.width);
  append16(file, form.height);
  append(file, {byteOf(form.bits), byteOf(form.descriptor)});
  append(file, id);
  append(file, data);
  return file;
}

// Uncompressed, from the top.
inline Bytes tga(int width, int height, const Bytes& rgb) {
  return tgaOf({.width = width, .height = height}, blueFirst(rgb));
}

struct BmpForm {
  int width = 3, height = 2, bits = 8, compression = 0;
};
// With the header of 40 bytes; `behind` is a palette or masks.
inline Bytes bmpOf(const BmpForm& form, const Bytes& behind, const Bytes& data) {
  const int offset = 54 + static_cast<int>(behind.size());
  Bytes file = {'B', 'M'};
  for (const int word :
       {offset + static_cast<int>(data.size()), 0, offset, 40, form.width, form.height}) {
    append32(file, word);
  }
  append16(file, 1);
  append16(file, form.bits);
  for (const int word : {form.compression, 0, 0, 0, 0, 0}) append32(file, word);
  append(file, behind);
  append(file, data);
  return file;
}

// 24 bits, bottom row first, rows padded to 4 bytes.
inline Bytes bmp(int width, int height, const Bytes& rgb) {
  Bytes data;
  const std::size_t row = static_cast<std::size_t>(3 * width);
  for (std::size_t end = rgb.size(); end > 0; end -= row) {
    append(data, blueFirst(slice(rgb, end - row, end)));
    data.resize((data.size() + 3) / 4 * 4);
  }
  return bmpOf({.width = width, .height = height, .bits = 24}, {}, data);
}

inline Bytes hdrOf(const std::string& head, const Bytes& rgbe) {
  Bytes file(head.begin(), head.end());
  append(file, rgbe);
  return file;
}

// Radiance RGBE, flat. `rgbe` is 4 bytes a pixel.
inline Bytes hdr(int width, int height, const Bytes& rgbe) {
  return hdrOf("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
                   std::to_string(width) + "\n",
               rgbe);
}

// Radiance RGBE with run lengths: each of the four planes of a row is one run. `width` from 8 to
// 127.
inline Bytes hdrRuns(int width, int height, const std::array<std::uint8_t, 4>& rgbe) {
  Bytes file = hdr(width, height, {});
  for (int y = 0; y < height; ++y) {
    append(file, {2, 2, 0, byteOf(width)});
    for (const std::uint8_t value : rgbe) append(file, {byteOf(128 + width), value});
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
  // Tables of one code, which is a bit long.
  for (const auto& [table, code] : {std::pair{0x00, 10}, {0x10, 0}}) {
    append(file, {0xff, 0xc4, 0, 20, byteOf(table), 1});
    append(file, Bytes(15));
    file.push_back(byteOf(code));
  }
  append(file, {0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0});
  append(file, {0b01001000, 0b00001111, 0xff, 0xd9});
  return file;
}

inline void appendPngChunk(Bytes& file, const char* type, const Bytes& data) {
  appendBig32(file, static_cast<int>(data.size()));
  Bytes body(type, type + 4);
  append(body, data);
  append(file, body);
  appendBig32(file, static_cast<int>(crc32(0, body.data(), static_cast<unsigned>(body.size()))));
}

// The bytes as PNG deflates them.
inline Bytes packed(const Bytes& bytes) {
  uLongf size = compressBound(bytes.size());
  Bytes result(size);
  compress(result.data(), &size, bytes.data(), bytes.size());
  result.resize(size);
  return result;
}

// `rows` is what PNG deflates: a filter byte (0) before each row. Color types: 0 gray, 2 RGB,
// 3 palette, 4 gray and alpha, 6 RGBA.
inline Bytes png(int width, int height, int bits, int colorType, const Bytes& rows) {
  Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'}, header;
  appendBig32(header, width);
  appendBig32(header, height);
  append(header, {byteOf(bits), byteOf(colorType), 0, 0, 0});
  appendPngChunk(file, "IHDR", header);
  appendPngChunk(file, "IDAT", packed(rows));
  appendPngChunk(file, "IEND", {});
  return file;
}

}  // namespace whit
