// Reading and writing PNG, by libpng.
#include <png.h>
#include <zlib.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "core/display.h"
#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "io/files.h"
#include "io/image/image_decoders.h"

namespace whit {

namespace {

// libpng allocates what a chunk of text claims to take before it reads any of it.
constexpr png_alloc_size_t kTextBytesLimit = 8u << 20;

// libpng reports errors by longjmp, so the functions that it may leave that way hold nothing that
// has a destructor.
struct Libpng {
  png_structp png = nullptr;
  png_infop info = nullptr;
  char message[160] = "";
};

void onError(png_structp png, png_const_charp message) {
  auto* own = static_cast<Libpng*>(png_get_error_ptr(png));
  std::snprintf(own->message, sizeof own->message, "%s", message);
  png_longjmp(png, 1);
}

// libpng warns of chunks beyond the limit, and then allocates them.
void onWarning(png_structp png, png_const_charp message) {
  if (std::strstr(message, "chunk data is too large") != nullptr) onError(png, message);
}

class PngReader {
 public:
  PngReader(const std::string& path, FileBytes file) : path_(path), file_(file) {
    lib_.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &lib_, onError, onWarning);
    lib_.info = lib_.png != nullptr ? png_create_info_struct(lib_.png) : nullptr;
  }
  ~PngReader() { png_destroy_read_struct(&lib_.png, &lib_.info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  // To be called in this order; each throws badScene with the byte where reading stopped.
  void readHeader() {
    guarded([this] {
      png_set_read_fn(lib_.png, this, onRead);
      png_set_user_limits(lib_.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
      png_set_chunk_malloc_max(lib_.png, kTextBytesLimit);
      png_set_crc_action(lib_.png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
      png_read_info(lib_.png, lib_.info);
    });
  }

  // Sets the output to 8 bits for each of 1 to 4 channels, or to 16 where the file has them.
  void prepare(bool keeps16) {
    guarded([this, keeps16] {
      png_set_expand(lib_.png);
      if (keeps16) {
        png_set_swap(lib_.png);  // PNG stores the most significant byte first
      } else {
        png_set_scale_16(lib_.png);  // rounds, where png_set_strip_16() cuts off
      }
      passes_ = png_set_interlace_handling(lib_.png);
      png_read_update_info(lib_.png, lib_.info);
    });
  }

  // Reads the pixels row after row, and the end of the file.
  void readPixels(std::uint8_t* codes) {
    guarded([this, codes] {
      // More or other data than the image has means that the file is damaged.
      png_set_benign_errors(lib_.png, 0);
      for (int pass = 0; pass < passes_; ++pass) {
        for (png_uint_32 y = 0; y < height(); ++y) {
          png_read_row(lib_.png, codes + y * rowBytes(), nullptr);
        }
      }

      // Behind the pixels, benign errors are only warnings again.
      png_set_benign_errors(lib_.png, 1);
      png_read_end(lib_.png, lib_.info);
    });
  }

  png_uint_32 width() const { return png_get_image_width(lib_.png, lib_.info); }
  png_uint_32 height() const { return png_get_image_height(lib_.png, lib_.info); }
  int channels() const { return png_get_channels(lib_.png, lib_.info); }
  std::size_t rowBytes() const { return png_get_rowbytes(lib_.png, lib_.info); }

  ImageMetadata texts() const {
    png_textp texts = nullptr;
    const int count = png_get_text(lib_.png, lib_.info, &texts, nullptr);
    ImageMetadata metadata;
    for (int i = 0; i < count; ++i) {
      metadata.emplace_back(texts[i].key, texts[i].text == nullptr ? "" : texts[i].text);
    }
    return metadata;
  }

  [[noreturn]] void refuse(const char* why) const {
    throwBadScene(concat(path_, ": byte ", at_),
                  std::string("expected valid PNG data, found an error: ") + why);
  }

 private:
  template <typename Use>
  void guarded(Use use) {
    if (lib_.info == nullptr) throwLimit(path_ + ": no memory is left to read it");
    if (setjmp(png_jmpbuf(lib_.png)) != 0) refuse(lib_.message);
    use();
  }

  static void onRead(png_structp png, png_bytep to, std::size_t size) {
    auto* self = static_cast<PngReader*>(png_get_io_ptr(png));
    if (size > self->file_.size() - self->at_) png_error(png, "the file is cut short");
    std::memcpy(to, self->file_.data() + self->at_, size);
    self->at_ += size;
  }

  const std::string& path_;
  FileBytes file_;
  std::size_t at_ = 0;
  Libpng lib_;
  int passes_ = 1;
};

// The image gets the bytes of its rows as codes, two for each value where a PNG of 16 bits keeps
// them.
RawImage decode(const std::string& path, FileBytes file, const ImageLimits& limits,
                ImageMetadata* texts, bool keeps16 = false) {
  constexpr std::uint64_t kMostFromOneByte = 1032;  // highest ratio of deflate
  PngReader reader(path, file);
  reader.readHeader();
  checkImageSize(path, reader.width(), reader.height(), 1, limits);
  reader.prepare(keeps16);

  RawImage image =
      startImage(path, reader.width(), reader.height(), reader.channels(), false, limits);

  // A file that is too short even at one bit a pixel and deflate's highest ratio is refused before
  // the image takes memory.
  const std::uint64_t pixels = std::uint64_t{reader.width()} * reader.height();
  if (pixels / 8 / kMostFromOneByte > file.size()) reader.refuse("the file is cut short");

  image.codes.resize(reader.rowBytes() * static_cast<std::size_t>(image.height));
  reader.readPixels(image.codes.data());
  if (texts != nullptr) *texts = reader.texts();
  return image;
}

bool isAscii(const std::string& text) {
  return std::ranges::all_of(text, [](unsigned char c) { return c < 127; });
}

// Stores plain text in Latin-1 chunks and the rest in UTF-8 ones. The chunks point into `metadata`,
// which libpng only reads; it cuts the keywords.
std::vector<png_text> textChunks(const ImageMetadata& metadata) {
  std::vector<png_text> chunks;
  for (const auto& [name, text] : metadata) {
    png_text chunk{};
    chunk.compression = isAscii(text) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    chunk.key = const_cast<char*>(name.c_str());
    chunk.text = const_cast<char*>(text.c_str());
    chunk.text_length = text.size();
    chunks.push_back(chunk);
  }
  return chunks;
}

// Rows of values in the form that libpng takes.
struct Rows {
  int width = 0, height = 0, bits = 8;
  int colorType = PNG_COLOR_TYPE_RGB;
  bool isSrgb = true;  // pixels of 8 bits have a fourth value, alpha, if it is written
  const std::uint8_t* first = nullptr;
  std::size_t stride = 0;  // bytes
};

// Appends the bytes of a PNG to `to`. Returns false on an error, which `writer.message` describes.
bool write(Libpng& writer, std::string& to, const Rows& rows, const std::vector<png_text>& texts) {
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, onError, onWarning);
  if (writer.png == nullptr) return false;

  // An error in libpng jumps back to this line.
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  writer.info = png_create_info_struct(writer.png);
  if (writer.info == nullptr) return false;

  const auto append = [](png_structp png, png_bytep bytes, std::size_t size) {
    static_cast<std::string*>(png_get_io_ptr(png))
        ->append(reinterpret_cast<const char*>(bytes), size);
  };
  png_set_write_fn(writer.png, &to, append, nullptr);

  const auto width = static_cast<png_uint_32>(rows.width);
  const auto height = static_cast<png_uint_32>(rows.height);
  png_set_IHDR(writer.png, writer.info, width, height, rows.bits, rows.colorType,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);

  // Films need fast compression. Compared with libpng's defaults, this takes a fourth to a tenth of
  // the time for six shipped scenes at 1280x720, and makes files 1 to 13 % larger (44 % for the
  // flat areas of `matte`). libdeflate at its first level is no faster.
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_strategy(writer.png, Z_RLE);

  if (rows.isSrgb) png_set_sRGB_gAMA_and_cHRM(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_text(writer.png, writer.info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(writer.png, writer.info);

  if (rows.bits == 16) {
    png_set_swap(writer.png);  // PNG stores the most significant byte first
  } else if (rows.colorType == PNG_COLOR_TYPE_RGB) {
    png_set_filler(writer.png, 0, PNG_FILLER_AFTER);
  }

  for (png_uint_32 y = 0; y < height; ++y) png_write_row(writer.png, rows.first + y * rows.stride);
  png_write_end(writer.png, writer.info);
  return true;
}

std::string encode(const Rows& rows, const ImageMetadata& metadata) {
  if (rows.width < 1 || rows.height < 1 || rows.stride < 1)
    throwUsage("cannot write a PNG without pixels");

  const std::vector<png_text> texts = textChunks(metadata);
  Libpng writer;
  std::string bytes;
  const bool written = write(writer, bytes, rows, texts);
  png_destroy_write_struct(&writer.png, &writer.info);
  if (!written) throwIo(std::string("cannot encode a PNG: ") + writer.message);
  return bytes;
}

}  // namespace

RawImage decodePng(const std::string& path, FileBytes file, const ImageLimits& limits) {
  return decode(path, file, limits, nullptr);
}

bool isPng16(FileBytes file) {
  constexpr std::size_t kBitsAt = 24;  // in the header's chunk, which is always the first
  return file.size() > kBitsAt && file[1] == 'P' && file[kBitsAt] == 16;
}

RawImage decodePng16(const std::string& path, FileBytes file, const ImageLimits& limits) {
  const RawImage raw = decode(path, file, limits, nullptr, true);
  RawImage image = startImage(path, raw.width, raw.height, raw.channels, true, limits);
  const std::size_t channels = raw.channels, count = image.pixels() * channels;
  image.values.resize(count);

  const auto share = [&](std::size_t i) {
    std::uint16_t code = 0;
    std::memcpy(&code, &raw.codes[i * sizeof code], sizeof code);
    return code / 65535.0;
  };
  for (const auto i : indices(count)) {
    const std::size_t last = i - i % channels + channels - 1;
    const double alpha = channels % 2 == 0 ? share(last) : 1;
    const bool isAlpha = channels % 2 == 0 && i == last;
    image.values[i] = static_cast<float>(isAlpha ? alpha : srgbToLinear(share(i)) * alpha);
  }
  return image;
}

ImageMetadata readPngMetadata(const std::string& path) {
  const std::string file = readFile(path, ImageLimits().bytes);
  ImageMetadata texts;
  decode(path, asBytes(file), ImageLimits(), &texts);
  return texts;
}

std::string encodePng(const DisplayImage& image, const ImageMetadata& metadata) {
  const int colorType = image.hasAlpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB;
  return encode({image.width, image.height, 8, colorType, true, image.rgba.data(),
                 std::size_t{4} * static_cast<std::size_t>(image.width)},
                metadata);
}

void writePng(const std::string& path, const DisplayImage& image, const ImageMetadata& metadata) {
  writeTextFile(path, encodePng(image, metadata));
}

void writePng(const std::string& path, const Image16& image, bool isSrgb,
              const ImageMetadata& metadata) {
  const int colorType = image.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB;
  const std::size_t stride = sizeof(std::uint16_t) * static_cast<std::size_t>(image.channels) *
                             static_cast<std::size_t>(image.width);
  writeTextFile(path, encode({image.width, image.height, 16, colorType, isSrgb,
                              reinterpret_cast<const std::uint8_t*>(image.values.data()), stride},
                             metadata));
}

}  // namespace whit
