// Writes the binary files of the corpus: make_corpus FOLDER. Files that are text were written by
// hand. What is there under another name stays: inputs that once broke something are kept so.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfTiledOutputFile.h>
#include <half.h>
// libjpeg's header wants this one before it.
#include <cstdio>

#include <jpeglib.h>

#include <cstdlib>
#include <iostream>

#include "images/image_samples.h"
#include "io/gltf_files.h"

namespace whit {
namespace {

namespace fs = std::filesystem;

fs::path corpus;

void put(const std::string& name, const Bytes& bytes) {
  fs::create_directories((corpus / name).parent_path());
  std::ofstream out(corpus / name, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
}
void put(const std::string& name, const std::string& text) {
  put(name, Bytes(text.begin(), text.end()));
}

// `count` codes that differ.
Bytes codes(std::size_t count) {
  Bytes result(count);
  for (std::size_t i = 0; i < count; ++i) result[i] = static_cast<std::uint8_t>(i * 37 + 11);
  return result;
}

// `rows` rows of `bytes` bytes behind filter numbers 0 to 4 in turn.
Bytes filteredRows(std::size_t rows, std::size_t bytes) {
  Bytes result;
  for (std::size_t y = 0; y < rows; ++y) {
    result.push_back(static_cast<std::uint8_t>(y % 5));
    append(result, codes(bytes));
  }
  return result;
}

void putPngs() {
  put("png/rgb.png", png(3, 5, 8, 2, filteredRows(5, 9)));
  put("png/gray.png", png(4, 5, 8, 0, filteredRows(5, 4)));
  put("png/gray1.png", png(9, 5, 1, 0, filteredRows(5, 2)));
  put("png/gray16.png", png(3, 5, 16, 0, filteredRows(5, 6)));
  put("png/grayAlpha.png", png(3, 5, 8, 4, filteredRows(5, 6)));
  put("png/rgba.png", png(3, 5, 8, 6, filteredRows(5, 12)));
  put("png/rgba16.png", png(2, 5, 16, 6, filteredRows(5, 16)));

  // One pixel is all of the first pass of Adam7, and the other passes are empty.
  Bytes interlaced = png(1, 1, 8, 2, filteredRows(1, 3));
  Bytes header(interlaced.begin() + 16, interlaced.begin() + 29);
  header[12] = 1;
  Bytes file(interlaced.begin(), interlaced.begin() + 8);
  appendPngChunk(file, "IHDR", header);
  append(file, Bytes(interlaced.begin() + 33, interlaced.end()));
  put("png/interlaced.png", file);

  Bytes palette = png(4, 5, 4, 3, filteredRows(5, 2));
  Bytes withColors(palette.begin(), palette.begin() + 33);
  appendPngChunk(withColors, "PLTE", codes(48));
  appendPngChunk(withColors, "tRNS", codes(7));
  appendPngChunk(withColors, "tEXt", {'k', 'e', 'y', 0, 't', 'e', 'x', 't'});
  append(withColors, Bytes(palette.begin() + 33, palette.end()));
  put("png/palette.png", withColors);
}

void putJpeg(const std::string& name, int side, int channels, bool progressive, int restart) {
  jpeg_compress_struct encoder{};
  jpeg_error_mgr errors{};
  encoder.err = jpeg_std_error(&errors);
  jpeg_create_compress(&encoder);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;

  jpeg_mem_dest(&encoder, &bytes, &size);
  encoder.image_width = encoder.image_height = static_cast<JDIMENSION>(side);
  encoder.input_components = channels;
  encoder.in_color_space = channels == 3 ? JCS_RGB : JCS_CMYK;
  if (channels == 1) encoder.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&encoder);
  encoder.restart_interval = static_cast<unsigned>(restart);
  if (progressive) jpeg_simple_progression(&encoder);

  jpeg_start_compress(&encoder, TRUE);
  Bytes row = codes(static_cast<std::size_t>(side * channels));
  JSAMPROW rows = row.data();
  for (int y = 0; y < side; ++y) jpeg_write_scanlines(&encoder, &rows, 1);

  jpeg_finish_compress(&encoder);
  put("jpeg/" + name, Bytes(bytes, bytes + size));
  jpeg_destroy_compress(&encoder);
  std::free(bytes);
}

void putJpegs() {
  put("jpeg/gray.jpg", jpegGray200());
  putJpeg("baseline.jpg", 17, 3, false, 0);
  putJpeg("restart.jpg", 17, 3, false, 1);
  putJpeg("progressive.jpg", 17, 3, true, 0);
  putJpeg("progressiveGray.jpg", 9, 1, true, 0);
  putJpeg("inks.jpg", 8, 4, false, 0);
}

void putTgas() {
  using Codes = std::vector<std::vector<int>>;
  put("tga/rgb.tga", tga(3, 2, codes(18)));

  // Type 10 has runs of equal pixels (0x84: five) and of different ones (0x04: five).
  Bytes runs = tga(5, 2, Bytes());
  runs[2] = 10;
  append(runs, {0x84, 1, 2, 3, 0x04});
  append(runs, codes(15));
  put("tga/runs.tga", runs);
  put("tga/gray.tga", tga(3, 2, Codes{{1}, {2}, {3}, {4}, {5}, {6}}));
  put("tga/rgba.tga", tga(1, 2, Codes{{1, 2, 3, 4}, {5, 6, 7, 8}}));
}

// Makes a file with the header of 40 bytes; `behind` is a palette or masks.
Bytes bmpOf(int height, int bits, int compression, const Bytes& behind, const Bytes& data) {
  Bytes file = {'B', 'M'};
  for (const int word : {0, 0, 54 + static_cast<int>(behind.size()), 40, 3, height}) {
    append32(file, word);
  }
  append16(file, 1);
  append16(file, bits);
  for (const int word : {compression, 0, 0, 0, 0, 0}) append32(file, word);
  append(file, behind);
  append(file, data);
  return file;
}

void putBmpsAndHdrs() {
  put("bmp/rgb.bmp", bmp(3, 2, codes(18)));

  // With 32 bits a pixel, a row of two pixels is as long as the padded row of 24 bits.
  Bytes deep = bmp(2, 2, codes(12));
  deep[28] = 32;
  append(deep, codes(4));
  put("bmp/rgba.bmp", deep);

  put("bmp/palette.bmp", bmpOf(2, 8, 0, codes(32), {0, 1, 2, 0, 3, 4, 5, 0}));
  Bytes masks;
  for (const int mask : {0xff0000, 0xff00, 0xff}) append32(masks, mask);
  put("bmp/masks.bmp", bmpOf(-2, 32, 3, masks, codes(24)));

  put("hdr/flat.hdr", hdr(2, 2, codes(16)));
  put("hdr/runs.hdr", hdrRuns(20, 3, {1, 2, 3, 130}));

  // Each plane has three bytes as they are, and a run of five.
  Bytes mixed = hdr(8, 1, {});
  append(mixed, {2, 2, 0, 8});
  for (int plane = 0; plane < 4; ++plane) {
    append(mixed, {3});
    append(mixed, codes(3));
    append(mixed, {128 + 5, 129});
  }
  put("hdr/mixed.hdr", mixed);
}

Imf::Header exrHeader(Imf::PixelType type, Imf::Compression compression,
                      const std::vector<const char*>& channels) {
  Imf::Header header({{-1, 0}, {8, 6}}, {{0, 1}, {9, 6}});
  header.compression() = compression;
  for (const char* name : channels) header.channels().insert(name, Imf::Channel(type));
  return header;
}

// Slices of all channels over one table of values.
Imf::FrameBuffer exrFrame(const Imf::Header& header, Imf::PixelType type,
                          std::vector<char>& values) {
  const std::size_t size = type == Imf::HALF ? 2 : 4;
  const Imath::Box2i& data = header.dataWindow();
  const std::size_t width = static_cast<std::size_t>(data.max.x - data.min.x + 1);

  values.assign(width * 64 * size, 0);
  for (std::size_t i = 0; i < width * 64; ++i) {
    const float value = static_cast<float>(i % 50) / 8;
    const half small(value);
    std::memcpy(values.data() + i * size, size == 2 ? static_cast<const void*>(&small) : &value,
                size);
  }

  Imf::FrameBuffer frame;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    frame.insert(c.name(), Imf::Slice::Make(type, values.data(), data, size, size * width));
  }
  return frame;
}

void putExrLines(const std::string& name, Imf::PixelType type, Imf::Compression compression,
                 const std::vector<const char*>& channels = {"R", "G", "B", "A"}) {
  const Imf::Header header = exrHeader(type, compression, channels);
  std::vector<char> values;
  Imf::OutputFile file((corpus / "exr" / name).c_str(), header);
  file.setFrameBuffer(exrFrame(header, type, values));
  file.writePixels(6);
}

void putExrTiles(const std::string& name, Imf::LevelMode mode, Imf::Compression compression) {
  Imf::Header header = exrHeader(Imf::HALF, compression, {"Y"});
  header.setTileDescription(Imf::TileDescription(4, 4, mode));
  std::vector<char> values;
  Imf::TiledOutputFile file((corpus / "exr" / name).c_str(), header);
  file.setFrameBuffer(exrFrame(header, Imf::HALF, values));
  for (int y = 0; y < file.numYLevels(); ++y) {
    for (int x = 0; x < file.numXLevels(); ++x) {
      if (mode == Imf::MIPMAP_LEVELS && x != y) continue;
      file.writeTiles(0, file.numXTiles(x) - 1, 0, file.numYTiles(y) - 1, x, y);
    }
  }
}

// The second part claims to be a billion lines high, so that its table would take gigabytes.
void putExrParts() {
  const fs::path path = corpus / "exr/second-part-of-a-billion-lines.exr";
  std::vector<Imf::Header> headers(2, exrHeader(Imf::HALF, Imf::NO_COMPRESSION, {"Y"}));
  for (std::size_t i = 0; i < 2; ++i) {
    headers[i].setName(std::to_string(i));
    headers[i].setType(Imf::SCANLINEIMAGE);
  }
  {
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), 2);
    for (int i = 0; i < 2; ++i) {
      std::vector<char> values;
      Imf::OutputPart part(file, i);
      part.setFrameBuffer(exrFrame(headers[0], Imf::HALF, values));
      part.writePixels(6);
    }
  }

  std::string bytes;
  {
    std::ifstream in(path, std::ios::binary);
    bytes.assign(std::istreambuf_iterator<char>(in), {});
  }
  put("exr/parts.exr", bytes);

  const std::size_t window = bytes.rfind(std::string("dataWindow\0box2i\0", 17));
  bytes[window + 17 + 4 + 15] =
      0x3f;  // the highest byte of the last line, behind the attribute's size
  put("exr/" + path.filename().string(), bytes);
}

void putExrs() {
  fs::create_directories(corpus / "exr");
  putExrLines("none.exr", Imf::FLOAT, Imf::NO_COMPRESSION);
  putExrLines("rle.exr", Imf::HALF, Imf::RLE_COMPRESSION);
  putExrLines("zips.exr", Imf::HALF, Imf::ZIPS_COMPRESSION, {"G"});
  putExrLines("zip.exr", Imf::FLOAT, Imf::ZIP_COMPRESSION);
  putExrLines("piz.exr", Imf::HALF, Imf::PIZ_COMPRESSION);
  putExrLines("pxr24.exr", Imf::FLOAT, Imf::PXR24_COMPRESSION);
  putExrLines("b44.exr", Imf::HALF, Imf::B44_COMPRESSION);
  putExrLines("b44a.exr", Imf::HALF, Imf::B44A_COMPRESSION);
  putExrLines("dwaa.exr", Imf::HALF, Imf::DWAA_COMPRESSION);
  putExrLines("dwab.exr", Imf::HALF, Imf::DWAB_COMPRESSION);

  putExrParts();
  putExrTiles("tiles.exr", Imf::ONE_LEVEL, Imf::ZIP_COMPRESSION);
  putExrTiles("mips.exr", Imf::MIPMAP_LEVELS, Imf::RLE_COMPRESSION);
  putExrTiles("rips.exr", Imf::RIPMAP_LEVELS, Imf::NO_COMPRESSION);

  Imf::RgbaOutputFile chroma((corpus / "exr/chroma.exr").c_str(), 8, 6, Imf::WRITE_YC);
  const std::vector<Imf::Rgba> pixels(48, Imf::Rgba(0.5f, 0.25f, 1));
  chroma.setFrameBuffer(pixels.data(), 1, 8);
  chroma.writePixels(6);
}

void putModels() {
  GltfBuilder gltf;
  const std::string positions = gltf.positions(kTriangleXyz), uvs = gltf.uvs({0, 0, 1, 0, 0, 1});
  const std::string indices = gltf.indices({0, 1, 2});
  const std::string sparse =
      gltf.accessor(-1, 5126, "VEC3", 3,
                    ",\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":" +
                        std::to_string(gltf.view(std::string(1, '\1'))) +
                        ",\"componentType\":5121},\"values\":{\"bufferView\":0}}");
  const std::string small = gltf.accessor(gltf.view(std::string("\0\1\2\0\3\4\5\0\6\7\1\0", 12), 4),
                                          5121, "VEC3", 3, ",\"normalized\":true");

  const Bytes image = png(1, 1, 8, 6, {0, 200, 100, 50, 128});
  const int view = gltf.view(std::string(image.begin(), image.end()));
  const auto textured = [&](const std::string& xyz, const std::string& rest = "") {
    return primitive(xyz, ",\"NORMAL\":" + xyz + ",\"TEXCOORD_0\":" + uvs,
                     ",\"indices\":" + indices + ",\"material\":0" + rest);
  };

  const std::string members =
      "\"images\":[{\"bufferView\":" + std::to_string(view) +
      ",\"mimeType\":\"image/png\"},{\"uri\":\"t.png\"}],"
      "\"samplers\":[{\"wrapS\":33071}],\"textures\":[{\"source\":0,\"sampler\":0},"
      "{\"source\":1}],\"materials\":[{\"alphaMode\":\"MASK\",\"pbrMetallicRoughness\":"
      "{\"baseColorTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":"
      "{\"scale\":[2,2]}}},\"metallicRoughnessTexture\":{\"index\":1}},\"normalTexture\":"
      "{\"index\":1,\"scale\":0.5},\"emissiveTexture\":{\"index\":0},\"emissiveFactor\":[1,1,1]}],"
      "\"meshes\":[{\"primitives\":[" +
      textured(positions) + "," + textured(sparse, ",\"mode\":5") + "," +
      textured(small, ",\"mode\":6") +
      "]}],\"nodes\":[{\"mesh\":0,\"children\":[1]},{\"mesh\":0,\"scale\":[-1,1,1],"
      "\"rotation\":[0,0,0,1],\"translation\":[2,0,0]}],\"scenes\":[{\"nodes\":[0]}],\"scene\":0";
  put("gltf/all.glb", gltf.glb(members));
  put("gltf/all.gltf", gltf.json(members));

  const std::string head =
      "1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  // A vertex is three floats and a byte of red; the big-endian file has each float reversed.
  std::string little, big;
  for (int i = 0; i < 3; ++i) {
    const std::string xyz =
        bytesOf<float>({kTriangleXyz.begin() + 3 * i, kTriangleXyz.begin() + 3 * i + 3});
    little += xyz + '\7';
    for (std::size_t k = 0; k < 12; k += 4) {
      for (std::size_t b = 4; b-- > 0;) big += xyz[k + b];
    }
    big += '\7';
  }
  put("ply/little.ply", "ply\nformat binary_little_endian " + head + little +
                            std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13));
  put("ply/big.ply", "ply\nformat binary_big_endian " + head + big +
                         std::string("\3\0\0\0\0\0\0\0\1\0\0\0\2", 13));
}

}  // namespace
}  // namespace whit

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "make_corpus FOLDER\n";
    return 2;
  }
  whit::corpus = argv[1];
  whit::putPngs();
  whit::putJpegs();
  whit::putTgas();
  whit::putBmpsAndHdrs();
  whit::putExrs();
  whit::putModels();
}
