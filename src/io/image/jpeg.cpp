// Reading and writing JPEG, by libjpeg.
#include <cstddef>
#include <cstdio>
// libjpeg's header needs the two above.
#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>
#include <csetjmp>
#include <cstdlib>

#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "io/image/image_decoders.h"
#include "io/image/image_file.h"

namespace whit {

namespace {

// libjpeg reports errors by longjmp, so the functions that it may leave that way hold nothing that
// has a destructor; this object lives outside of them.
struct JpegErrors {
  template <typename Coder>
  void watch(Coder& coder) {
    coder.err = jpeg_std_error(&manager);
    coder.client_data = this;
    manager.error_exit = [](j_common_ptr common) { leave(common); };
  }

  [[noreturn]] static void leave(j_common_ptr common) {
    JpegErrors& self = *static_cast<JpegErrors*>(common->client_data);
    common->err->format_message(common, self.message);
    std::longjmp(self.escape, 1);
  }

  jpeg_error_mgr manager{};
  std::jmp_buf escape{};
  char message[JMSG_LENGTH_MAX] = "out of memory";
};

class JpegReader {
 public:
  JpegReader(const std::string& path, FileBytes file) : path_(path), file_(file) {
    errors_.watch(decoder_);
    errors_.manager.emit_message = onMessage;
  }
  ~JpegReader() { jpeg_destroy_decompress(&decoder_); }
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  // These throw badScene where libjpeg finds an error.
  void readHeader() {
    guarded([this] {
      jpeg_create_decompress(&decoder_);
      jpeg_mem_src(&decoder_, file_.data(), file_.size());
      jpeg_read_header(&decoder_, TRUE);
    });
  }

  // Stores rows of width() * channels() codes.
  void readPixels(std::uint8_t* codes) {
    guarded([this, codes] {
      // libjpeg does not convert CMYK to RGB; printInks() does it afterwards.
      if (channels() == 3) decoder_.out_color_space = JCS_RGB;
      if (channels() == 4) decoder_.out_color_space = JCS_CMYK;
      jpeg_start_decompress(&decoder_);

      const std::size_t stride = std::size_t{decoder_.output_width} * decoder_.output_components;
      while (decoder_.output_scanline < decoder_.output_height) {
        JSAMPROW row = codes + decoder_.output_scanline * stride;
        jpeg_read_scanlines(&decoder_, &row, 1);
      }

      jpeg_finish_decompress(&decoder_);
    });
  }

  int width() const { return static_cast<int>(decoder_.image_width); }
  int height() const { return static_cast<int>(decoder_.image_height); }
  int channels() const {
    if (decoder_.jpeg_color_space == JCS_GRAYSCALE) return 1;
    if (decoder_.num_components == 3) return 3;
    if (decoder_.num_components == 4) return 4;
    refuse(concat("gray, RGB or CMYK, found ", decoder_.num_components, " inks"));
  }

  // Adobe's programs store how much light an ink lets through, others how much of it there is.
  bool isInverted() const { return decoder_.saw_Adobe_marker != 0; }

  // Upper bound on libjpeg's memory for decoding: some rows of each component, and all of its
  // coefficients where they come in more than one scan.
  std::uint64_t workingBytes() {
    constexpr std::uint64_t kRows = 64;
    const bool many = jpeg_has_multiple_scans(&decoder_) != 0;
    std::uint64_t bytes = 0;

    for (int i = 0; i < decoder_.num_components; ++i) {
      const jpeg_component_info& component = decoder_.comp_info[i];
      const std::uint64_t across = component.width_in_blocks + std::uint64_t{8};
      const std::uint64_t down = component.height_in_blocks + std::uint64_t{8};
      bytes += across * DCTSIZE * kRows * sizeof(int);
      if (many) bytes += across * down * DCTSIZE2 * sizeof(JCOEF);
    }

    return bytes;
  }

 private:
  // libjpeg reads ahead of what it decodes by a few bytes at most.
  [[noreturn]] void refuse(const std::string& expected) const {
    const std::size_t left = decoder_.src ? decoder_.src->bytes_in_buffer : 0;
    const std::size_t at = file_.size() - std::min(left, file_.size());
    throwBadScene(concat(path_, ": byte ", at), "expected " + expected);
  }

  template <typename Use>
  void guarded(Use use) {
    if (setjmp(errors_.escape) != 0) {
      refuse(std::string("valid JPEG data, found an error: ") + errors_.message);
    }
    use();
  }

  // libjpeg only warns of missing and damaged data, and makes up pixels. Its other warnings are
  // about oddities that every viewer ignores.
  static void onMessage(j_common_ptr common, int level) {
    constexpr int kDamage[] = {JWRN_JPEG_EOF, JWRN_HIT_MARKER, JWRN_HUFF_BAD_CODE,
                               JWRN_MUST_RESYNC};
    const int code = common->err->msg_code;
    if (level < 0 && contains(kDamage, code)) JpegErrors::leave(common);
  }

  const std::string& path_;
  FileBytes file_;
  jpeg_decompress_struct decoder_{};
  JpegErrors errors_;
};

struct JpegWriter {
  jpeg_compress_struct encoder{};
  JpegErrors errors;
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
};

// Returns false on an error, which `writer.errors` describes.
bool write(JpegWriter& writer, const DisplayImage& image, int quality,
           std::vector<std::uint8_t>& row) {
  jpeg_compress_struct& encoder = writer.encoder;
  writer.errors.watch(encoder);

  // An error in libjpeg jumps back to this line.
  if (setjmp(writer.errors.escape) != 0) return false;

  jpeg_create_compress(&encoder);
  jpeg_mem_dest(&encoder, &writer.bytes, &writer.size);

  encoder.image_width = static_cast<JDIMENSION>(image.width);
  encoder.image_height = static_cast<JDIMENSION>(image.height);
  encoder.input_components = 3;
  encoder.in_color_space = JCS_RGB;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, quality, TRUE);
  jpeg_start_compress(&encoder, TRUE);

  // libjpeg takes rows of RGB, so alpha is dropped.
  while (encoder.next_scanline < encoder.image_height) {
    const std::uint8_t* pixel =
        image.rgba.data() + std::size_t{encoder.next_scanline} * row.size() / 3 * 4;
    for (std::size_t i = 0; i < row.size(); i += 3, pixel += 4) std::copy_n(pixel, 3, &row[i]);
    JSAMPROW first = row.data();
    jpeg_write_scanlines(&encoder, &first, 1);
  }

  jpeg_finish_compress(&encoder);
  return true;
}

// Converts CMYK to RGB in place: light passes through an ink and then through black.
void printInks(RawImage& image, bool isInverted) {
  for (const auto i : indices(image.pixels())) {
    const std::uint8_t* const inks = &image.codes[4 * i];
    const auto light = [&](std::size_t k) { return isInverted ? inks[k] : 255 - inks[k]; };
    for (const auto k : indices(3)) {
      image.codes[3 * i + k] = static_cast<std::uint8_t>((light(k) * light(3) + 127) / 255);
    }
  }

  image.channels = 3;
  image.codes.resize(3 * image.pixels());
}

}  // namespace

RawImage decodeJpeg(const std::string& path, FileBytes file, const ImageLimits& limits) {
  JpegReader reader(path, file);
  reader.readHeader();
  RawImage image =
      startImage(path, reader.width(), reader.height(), reader.channels(), false, limits);

  const MemoryHold working(limits.budget, reader.workingBytes(), 1, path);
  image.codes.resize(image.pixels() * static_cast<std::size_t>(image.channels));
  reader.readPixels(image.codes.data());
  if (image.channels == 4) printInks(image, reader.isInverted());
  return image;
}

std::string encodeJpeg(const DisplayImage& image, int quality) {
  std::vector<std::uint8_t> row(std::size_t{3} * static_cast<std::size_t>(image.width));
  JpegWriter writer;

  const bool written = write(writer, image, quality, row);
  std::string bytes(reinterpret_cast<const char*>(writer.bytes), written ? writer.size : 0);
  jpeg_destroy_compress(&writer.encoder);
  std::free(writer.bytes);

  if (!written) throwIo(std::string("cannot encode a JPEG: ") + writer.errors.message);
  return bytes;
}

}  // namespace whit
