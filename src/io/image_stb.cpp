// stb_image, the only file that sees it.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <stdexcept>

#include "core/error.h"
#include "io/image_decoders.h"

namespace {

// What stb_image allocates for one image, held in the budget. Frees what is left at the end, so
// that exceptions may pass through stb_image, and refuses any single block larger than the image's
// claimed size justifies: a file of a few kilobytes can unpack to gigabytes.
class Arena {
 public:
  Arena(const std::string& path, std::size_t largestBlock, whit::MemoryBudget* budget)
      : path_(path), largestBlock_(largestBlock), budget_(budget) {
    current = this;
  }
  ~Arena() {
    for (const auto& [block, held] : blocks_) std::free(block);
    current = nullptr;
  }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  void* resize(void* block, std::size_t size) {
    if (size > largestBlock_) return nullptr;
    whit::MemoryHold held(budget_, size, 1, path_);
    void* moved = std::realloc(block, size);
    if (moved == nullptr) return nullptr;
    blocks_.erase(block);
    blocks_[moved] = std::move(held);
    return moved;
  }
  void release(void* block) {
    blocks_.erase(block);
    std::free(block);
  }

  static thread_local Arena* current;

 private:
  const std::string& path_;
  std::size_t largestBlock_;
  whit::MemoryBudget* budget_;
  std::map<void*, whit::MemoryHold> blocks_;
};
thread_local Arena* Arena::current = nullptr;

[[noreturn]] void assertionFailed() { throw std::logic_error("inconsistent data"); }

}  // namespace

#define STBI_MALLOC(size) Arena::current->resize(nullptr, size)
#define STBI_REALLOC(block, size) Arena::current->resize(block, size)
#define STBI_FREE(block) Arena::current->release(block)
#define STBI_ASSERT(x) ((x) ? static_cast<void>(0) : assertionFailed())
#define STBI_NO_STDIO
#define STBI_NO_GIF
#define STBI_NO_JPEG
#define STBI_NO_PIC
#define STBI_NO_PNM
#define STBI_NO_PSD
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace whit {

namespace {

struct CutShort {};

// Feeds stb_image, and throws CutShort when it asks for more bytes than there are: left alone, most
// of its decoders go on with zeros and call the result an image, and one never ends.
class Source {
 public:
  explicit Source(const std::vector<std::uint8_t>& file) : file_(file) {}

  static stbi_io_callbacks callbacks() {
    return {
        [](void* self, char* to, int size) { return static_cast<Source*>(self)->read(to, size); },
        [](void* self, int size) { static_cast<Source*>(self)->skip(size); },
        [](void* self) { return static_cast<Source*>(self)->atEnd() ? 1 : 0; }};
  }

 private:
  // The first call fills stb_image's look-ahead buffer, and so does every other one into the same
  // place. Such a read may come back short; it needs a byte only when nothing at all is left. Reads
  // to anywhere else need all they ask for.
  int read(char* to, int size) {
    if (lookAhead_ == nullptr) lookAhead_ = to;
    const std::size_t wanted = static_cast<std::size_t>(std::max(size, 0));
    const std::size_t count = std::min(file_.size() - at_, wanted);
    if (count < wanted && (to != lookAhead_ || count == 0)) throw CutShort();
    std::memcpy(to, file_.data() + at_, count);
    at_ += count;
    return static_cast<int>(count);
  }
  void skip(int size) {
    if (size > 0) at_ += std::min(file_.size() - at_, static_cast<std::size_t>(size));
  }
  bool atEnd() const { return at_ == file_.size(); }

  const std::vector<std::uint8_t>& file_;
  std::size_t at_ = 0;
  const char* lookAhead_ = nullptr;
};

bool startsWith(const std::vector<std::uint8_t>& file, const char* signature, std::size_t size) {
  return file.size() >= size && std::memcmp(file.data(), signature, size) == 0;
}

bool isPng(const std::vector<std::uint8_t>& file) {
  return startsWith(file, "\x89PNG\r\n\x1a\n", 8);
}

// By what the first chunk says of a PNG (PNG specification 11.2.2): stb_image calls an image that
// is too large for it one of an unknown type.
void checkPngSize(const std::string& path, const std::vector<std::uint8_t>& file,
                  const ImageLimits& limits) {
  constexpr std::size_t kWidth = 16, kHeight = 20, kColorType = 25;
  constexpr std::uint64_t kMostBytes = 1 << 30;                 // that stb_image takes
  constexpr std::uint64_t kChannels[] = {1, 0, 3, 4, 2, 0, 4};  // of the color types
  if (file.size() <= kColorType) return;
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) value = value << 8 | file[i];
    return std::int64_t{value};
  };
  const std::int64_t width = number(kWidth), height = number(kHeight);
  const MemoryHold claimed = holdImage(path, width, height, 1, limits);
  const std::size_t type = std::min<std::size_t>(file[kColorType], 6);
  if (static_cast<std::uint64_t>(width * height) * kChannels[type] > kMostBytes) {
    throwLimit(path + ": " + std::to_string(width) + "x" + std::to_string(height) +
               " is more than the " + std::to_string(kMostBytes) + " bytes that a PNG may have");
  }
}

bool isTgaName(const std::string& path) {
  if (path.size() < 4) return false;
  std::string end = path.substr(path.size() - 4);
  for (char& c : end) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return end == ".tga";
}

bool isKnown(const std::string& path, const std::vector<std::uint8_t>& file) {
  return isPng(file) || startsWith(file, "BM", 2) || startsWith(file, "#?RADIANCE", 10) ||
         startsWith(file, "#?RGBE", 6) || isTgaName(path);
}

// Calls use(callbacks, source) with memory to work in, and translates what can go wrong. `use`
// tells failure by a result that converts to false.
template <typename Use>
auto withSource(const std::string& path, const std::vector<std::uint8_t>& file,
                std::size_t largestBlock, MemoryBudget* budget, Use&& use) {
  const Arena arena(path, largestBlock, budget);
  const stbi_io_callbacks callbacks = Source::callbacks();
  Source source(file);
  try {
    auto result = use(&callbacks, static_cast<void*>(&source));
    if (result) return result;
  } catch (const CutShort&) {
    throwBadScene(path, "the file is cut short");
  } catch (const std::logic_error& e) {
    throwBadScene(path, std::string("not a valid image (") + e.what() + ")");
  }
  const std::string reason = stbi_failure_reason() ? stbi_failure_reason() : "no reason";
  if (reason == "too large" || reason == "outofmem")
    throwLimit(path + ": takes more memory than is allowed (" + reason + ")");
  throwBadScene(path, "not a valid image (" + reason + ")");
}

// 16-bit or float channels, a packed copy, doubling while it grows.
std::size_t justifiedBlock(const RawImage& image, std::size_t fileSize) {
  return (static_cast<std::size_t>(image.width) + 128) *
             (static_cast<std::size_t>(image.height) + 128) * 32 +
         fileSize * 2 + (1u << 20);
}

// Decodes as `Value`s with stb_image's function for them.
template <typename Value, typename Load>
std::vector<Value> load(const std::string& path, const std::vector<std::uint8_t>& file,
                        const RawImage& claimed, MemoryBudget* budget, Load&& function) {
  const std::size_t block = justifiedBlock(claimed, file.size());
  auto values = withSource(path, file, block, budget, [&](auto callbacks, void* source) {
    int width = 0, height = 0, inFile = 0;
    const Value* decoded = function(callbacks, source, &width, &height, &inFile, claimed.channels);
    if (decoded != nullptr && (width != claimed.width || height != claimed.height))
      throw std::logic_error("its headers disagree about its size");
    const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                              static_cast<std::size_t>(claimed.channels);
    return decoded ? std::optional(std::vector<Value>(decoded, decoded + count)) : std::nullopt;
  });
  return std::move(*values);
}

}  // namespace

RawImage decodeWithStb(const std::string& path, const std::vector<std::uint8_t>& file,
                       const ImageLimits& limits) {
  if (!isKnown(path, file))
    throwBadScene(path, "expected a PNG, JPEG, TGA, BMP, Radiance HDR or OpenEXR image");
  if (isPng(file)) checkPngSize(path, file, limits);
  constexpr std::size_t kHeaderBlock = 1u << 20;
  RawImage image;
  withSource(path, file, kHeaderBlock, limits.budget, [&](auto callbacks, void* source) {
    return stbi_info_from_callbacks(callbacks, source, &image.width, &image.height,
                                    &image.channels);
  });
  image.linear = startsWith(file, "#?", 2);
  if (image.channels < 1 || image.channels > 4)
    throwBadScene(path, "expected 1 to 4 channels, found " + std::to_string(image.channels));
  image.held = holdImage(path, image.width, image.height,
                         static_cast<std::uint64_t>(image.channels) *
                             (image.linear ? sizeof(float) : sizeof(std::uint8_t)),
                         limits);
  if (image.linear)
    image.values = load<float>(path, file, image, limits.budget, stbi_loadf_from_callbacks);
  else
    image.codes = load<std::uint8_t>(path, file, image, limits.budget, stbi_load_from_callbacks);
  return image;
}

}  // namespace whit
