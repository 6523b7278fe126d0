// Reading PNG, by libpng.
#include <png.h>

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/image/image_decoders.h"
#include "io/read_file.h"

namespace whit {

namespace {

constexpr std::size_t kSignatureBytes = 8;

// libpng reports errors by longjmp, so the functions that it may leave that way hold nothing that
// has a destructor; this object lives outside of them.
class PngReader {
 public:
  PngReader(const std::string& path, std::span<const std::uint8_t> file)
      : path_(path), file_(file) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, onError, onWarning);
    info_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  // These throw badScene with the byte where reading stopped. First the size ...
  void readHeader() {
    checkChunkLengths();
    guarded([this] {
      png_set_read_fn(png_, this, onRead);
      png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
      png_set_crc_action(png_, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
      png_read_info(png_, info_);
    });
  }
  // ... then how pixels are given out, as 8 bits for each of 1 to 4 channels ...
  void prepare() {
    guarded([this] {
      png_set_expand(png_);
      png_set_strip_16(png_);
      passes_ = png_set_interlace_handling(png_);
      png_read_update_info(png_, info_);
    });
  }
  // ... then these, row behind row or, where `keep` is false, all in one; and the file's end.
  void readPixels(std::uint8_t* codes, bool keep) {
    guarded([this, codes, keep] {
      // More or other data than the image has means that the file is damaged.
      png_set_benign_errors(png_, 0);
      const std::size_t stride = keep ? rowBytes() : 0;
      for (int pass = 0; pass < passes_; ++pass) {
        for (png_uint_32 y = 0; y < height(); ++y) png_read_row(png_, codes + y * stride, nullptr);
      }
      png_set_benign_errors(png_, 1);
      png_read_end(png_, info_);
    });
  }

  png_uint_32 width() const { return png_get_image_width(png_, info_); }
  png_uint_32 height() const { return png_get_image_height(png_, info_); }
  int channels() const { return png_get_channels(png_, info_); }
  std::size_t rowBytes() const { return png_get_rowbytes(png_, info_); }
  ImageMetadata texts() const {
    png_textp texts = nullptr;
    const int count = png_get_text(png_, info_, &texts, nullptr);
    ImageMetadata metadata;
    for (int i = 0; i < count; ++i) {
      metadata.emplace_back(texts[i].key, texts[i].text == nullptr ? "" : texts[i].text);
    }
    return metadata;
  }
  [[noreturn]] void refuse(const char* why) const {
    throwBadScene(path_ + ": byte " + std::to_string(at_),
                  std::string("not a valid PNG image (") + why + ")");
  }

 private:
  // libpng reserves memory for a chunk of text by the length that it claims, before any is read.
  void checkChunkLengths() {
    constexpr std::size_t kBesideData = 12;  // length, name and checksum
    for (std::size_t at = kSignatureBytes; at < file_.size();) {
      at_ = at;
      if (file_.size() - at < kBesideData) refuse("the file is cut short");
      std::size_t length = 0;
      for (std::size_t i = 0; i < 4; ++i) length = length << 8 | file_[at + i];
      const bool last = std::memcmp(&file_[at + 4], "IEND", 4) == 0;
      if (length > file_.size() - at - kBesideData) refuse("the file is cut short");
      if (last) break;
      at += kBesideData + length;
    }
    at_ = 0;
  }

  template <typename Use>
  void guarded(Use use) {
    if (info_ == nullptr) throwLimit(path_ + ": no memory is left to read it");
    if (setjmp(png_jmpbuf(png_)) != 0) refuse(message_);
    use();
  }

  static void onRead(png_structp png, png_bytep to, std::size_t size) {
    auto* self = static_cast<PngReader*>(png_get_io_ptr(png));
    if (size > self->file_.size() - self->at_) png_error(png, "the file is cut short");
    std::memcpy(to, self->file_.data() + self->at_, size);
    self->at_ += size;
  }
  [[noreturn]] static void onError(png_structp png, png_const_charp message) {
    auto* self = static_cast<PngReader*>(png_get_error_ptr(png));
    std::snprintf(self->message_, sizeof self->message_, "%s", message);
    png_longjmp(png, 1);
  }
  static void onWarning(png_structp, png_const_charp) {}

  const std::string& path_;
  std::span<const std::uint8_t> file_;
  std::size_t at_ = 0;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int passes_ = 1;
  char message_[160] = "";
};

}  // namespace

bool isPng(std::span<const std::uint8_t> file) {
  return file.size() >= kSignatureBytes && png_sig_cmp(file.data(), 0, kSignatureBytes) == 0;
}

RawImage decodePng(const std::string& path, std::span<const std::uint8_t> file,
                   const ImageLimits& limits) {
  constexpr std::uint64_t kMostFromOneByte = 1032;  // that deflate can make
  PngReader reader(path, file);
  reader.readHeader();
  checkImageSize(path, reader.width(), reader.height(), 1, limits);
  reader.prepare();
  RawImage image;
  image.width = static_cast<int>(reader.width());
  image.height = static_cast<int>(reader.height());
  image.channels = reader.channels();
  image.held = holdImage(path, image.width, image.height,
                         static_cast<std::uint64_t>(image.channels), limits);
  const std::size_t bytes = reader.rowBytes() * static_cast<std::size_t>(image.height);
  const std::uint64_t pixels = std::uint64_t{reader.width()} * reader.height();
  if (pixels / 8 / kMostFromOneByte > file.size()) reader.refuse("the file is cut short");
  image.codes.resize(bytes);
  reader.readPixels(image.codes.data(), true);
  return image;
}

ImageMetadata readPngMetadata(const std::string& path) {
  const std::string file = readFile(path, ImageLimits().bytes);
  PngReader reader(path, asBytes(file));
  reader.readHeader();
  checkImageSize(path, reader.width(), reader.height(), 1, ImageLimits());
  reader.prepare();
  std::vector<std::uint8_t> row(reader.rowBytes());
  reader.readPixels(row.data(), false);
  return reader.texts();
}

}  // namespace whit
