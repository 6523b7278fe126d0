// Reading the text of a PNG.
#include <png.h>

#include <cerrno>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "io/image_file.h"

namespace whit {

namespace {

constexpr png_uint_32 kSideLimit = kImageSideLimit;

// Nothing here has a destructor, because libpng reports errors by longjmp.
struct PngTextReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  int passes = 1;
  char message[160] = "";
};

void onReadError(png_structp png, png_const_charp message) {
  auto* reader = static_cast<PngTextReader*>(png_get_error_ptr(png));
  std::snprintf(reader->message, sizeof reader->message, "%s", message);
  png_longjmp(png, 1);
}
void onReadWarning(png_structp, png_const_charp) {}

// False: `reader.message` says why.
bool readHeader(PngTextReader& reader, std::FILE* file) {
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, onReadError, onReadWarning);
  if (reader.png == nullptr) return false;
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  reader.info = png_create_info_struct(reader.png);
  if (reader.info == nullptr) return false;
  png_init_io(reader.png, file);
  png_set_user_limits(reader.png, kSideLimit, kSideLimit);
  png_read_info(reader.png, reader.info);
  reader.passes = png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

bool readRows(PngTextReader& reader, png_bytep row) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  const png_uint_32 height = png_get_image_height(reader.png, reader.info);
  for (int pass = 0; pass < reader.passes; ++pass) {
    for (png_uint_32 y = 0; y < height; ++y) png_read_row(reader.png, row, nullptr);
  }
  png_read_end(reader.png, reader.info);
  return true;
}

}  // namespace

ImageMetadata readPngMetadata(const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) throwIo("cannot open '" + path + "': " + std::strerror(errno));
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> closing(file, &std::fclose);
  PngTextReader reader;
  const auto release = [](PngTextReader* r) {
    png_destroy_read_struct(&r->png, &r->info, nullptr);
  };
  const std::unique_ptr<PngTextReader, decltype(release)> releasing(&reader, release);
  if (!readHeader(reader, file)) throwBadScene(path, std::string("no PNG: ") + reader.message);
  std::vector<png_byte> row(png_get_rowbytes(reader.png, reader.info));
  if (!readRows(reader, row.data())) {
    throwBadScene(path, std::string("expected a whole PNG: ") + reader.message);
  }
  png_textp texts = nullptr;
  const int count = png_get_text(reader.png, reader.info, &texts, nullptr);
  ImageMetadata metadata;
  for (int i = 0; i < count; ++i) {
    metadata.emplace_back(texts[i].key, texts[i].text == nullptr ? "" : texts[i].text);
  }
  return metadata;
}

}  // namespace whit
