#include "viewer/serve/picture_stream.h"

#include <algorithm>
#include <cstring>

#include "io/image/image_file.h"

namespace whit::serve {

namespace {

constexpr int kLeastQuality = 40, kLargestQuality = 90, kMostUnderWay = 6;
// A link counts as full or as free if messages take this much longer than the fastest one.
constexpr double kFullMs = 90, kFreeMs = 40;
constexpr double kLeastPixels = 160 * 100;
constexpr int kExactWidth = 4 * kTileSide;  // a PNG of this width has about kExactBytes
constexpr double kLeastMsGrows = 0.2;       // with each acknowledgement, because links change

int tilesIn(int pixels) { return (pixels + kTileSide - 1) / kTileSide; }

// A run of tiles in a row, or the whole picture.
struct Part {
  int x = 0, y = 0, width = 0, height = 0;
};

const std::uint8_t* pixelAt(const DisplayImage& image, int x, int y) {
  return image.rgba.data() + 4 * (static_cast<std::size_t>(y) * image.width + x);
}

DisplayImage cut(const DisplayImage& image, const Part& part) {
  DisplayImage result{part.width, part.height, {}, false};
  result.rgba.reserve(std::size_t{4} * part.width * part.height);
  for (int y = 0; y < part.height; ++y) {
    const std::uint8_t* const row = pixelAt(image, part.x, part.y + y);
    result.rgba.insert(result.rgba.end(), row, row + std::size_t{4} * part.width);
  }
  return result;
}

bool differ(const DisplayImage& a, const DisplayImage& b, const Part& part) {
  for (int y = part.y; y < part.y + part.height; ++y) {
    if (std::memcmp(pixelAt(a, part.x, y), pixelAt(b, part.x, y), std::size_t{4} * part.width) != 0)
      return true;
  }
  return false;
}

}  // namespace

Tiles PictureStream::next(const DisplayImage& picture, bool exact, double nowMs) {
  const int across = tilesIn(picture.width), down = tilesIn(picture.height);

  // A new size leaves nothing of the page's picture to build on.
  if (picture.width != last_.width || picture.height != last_.height) {
    states_.assign(static_cast<std::size_t>(across) * down, TileState::stale);
  }

  // Neighboring tiles of a row that the page lacks are joined into one image.
  std::vector<Part> parts;
  std::size_t tiles = 0;
  for (int i = 0; i < across * down; ++i) {
    const int x = i % across * kTileSide, y = i / across * kTileSide;
    const Part part{x, y, std::min(kTileSide, picture.width - x),
                    std::min(kTileSide, picture.height - y)};

    // With `exact` a tile is due until it is exact, otherwise only when it has changed.
    TileState& state = states_[i];
    if (state != TileState::stale && differ(picture, last_, part)) state = TileState::stale;
    if (state == TileState::exact || (state == TileState::lossy && !exact)) continue;

    ++tiles;
    const bool goesOn = !parts.empty() && parts.back().y == y &&
                        parts.back().x + parts.back().width == x &&
                        !(exact && parts.back().width >= kExactWidth);
    if (goesOn) {
      parts.back().width += part.width;
    } else {
      parts.push_back(part);
    }
  }

  // If all tiles are due in motion, one JPEG of the whole picture spares the overhead of many.
  if (tiles == states_.size() && !exact) parts = {{0, 0, picture.width, picture.height}};
  last_ = picture;

  Tiles message;
  for (const Part& part : parts) {
    if (exact && message.bytes.size() > kExactBytes) break;
    const DisplayImage piece = cut(picture, part);
    const std::string bytes = exact ? encodePng(piece) : encodeJpeg(piece, quality_);

    message.list += (message.list.empty() ? "[" : ",[") + std::to_string(part.x) + "," +
                    std::to_string(part.y) + "," + std::to_string(bytes.size()) + "]";
    message.bytes += bytes;

    // The page will have these tiles when it has drawn the message.
    for (int y = part.y / kTileSide; y * kTileSide < part.y + part.height; ++y) {
      for (int x = part.x / kTileSide; x * kTileSide < part.x + part.width; ++x) {
        states_[static_cast<std::size_t>(y) * across + x] =
            exact ? TileState::exact : TileState::lossy;
      }
    }
  }
  if (message.empty()) return message;

  // The delay between this time and the acknowledgement measures the link.
  message.number = ++number_;
  message.list = "[" + message.list + "]";
  underWay_.push_back({message.number, nowMs});
  return message;
}

bool PictureStream::acknowledge(std::uint32_t number, double nowMs) {
  const auto found = std::ranges::find(underWay_, number, &Sent::number);
  if (found == underWay_.end()) return false;
  heardMs_ = nowMs;
  adapt(nowMs - found->ms);
  underWay_.erase(underWay_.begin(), found + 1);  // messages are drawn in order
  return true;
}

void PictureStream::adapt(double delayMs) {
  // The delay beyond the smallest one is time that the message has spent in queues on the way.
  leastMs_ = std::min(delayMs, leastMs_ + kLeastMsGrows);
  const double queued = delayMs - leastMs_;
  const double pixels = static_cast<double>(last_.width) * last_.height;

  // A full link gets fewer messages at a time, then coarser JPEGs, then smaller pictures. A free
  // link gets larger pictures at once, then more messages at a time, then finer JPEGs.
  if (queued > kFullMs) {
    if (window_ > 2) {
      --window_;
    } else if (quality_ > kLeastQuality) {
      quality_ = std::max(quality_ - 8, kLeastQuality);
    } else {
      mostPixels_ = std::max(0.8 * std::min(mostPixels_, pixels), kLeastPixels);
    }
  } else if (queued < kFreeMs) {
    mostPixels_ = std::min(1.1 * mostPixels_, 1e9);
    if (window_ < kMostUnderWay) {
      ++window_;
    } else {
      quality_ = std::min(quality_ + 1, kLargestQuality);
    }
  }
}

}  // namespace whit::serve
