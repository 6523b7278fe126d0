// The pictures for one page: which tiles are sent, in which format, and when. A stream knows
// neither sockets nor the clock.
//
// In motion the tiles that changed are sent as JPEG, at rest all that are not exact yet as PNG, a
// few at a time. The page acknowledges each message that it has drawn. How long that takes, beyond
// the shortest time so far, tells how full the link is. The number of messages under way, the
// quality and the number of pixels in motion follow from it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "core/image.h"

namespace whit::serve {

inline constexpr int kTileSide = 128;              // pixels
inline constexpr std::size_t kExactBytes = 48000;  // about this many of PNG tiles in a message

// A message for the page: the bytes of its tiles, and a list of their places and sizes.
struct Tiles {
  std::uint32_t number = 0;
  std::string list;  // JSON: [[x, y, bytes], ...]
  std::string bytes;
  bool empty() const { return bytes.empty(); }
};

class PictureStream {
 public:
  // True while the page has acknowledged enough for another message.
  bool ready() const { return underWay_.size() < static_cast<std::size_t>(window_); }

  // Returns the next tiles that bring the page closer to this picture; none if there is nothing to
  // send. With `exact` they are lossless.
  Tiles next(const DisplayImage& picture, bool exact, double nowMs);

  // Notes that the page has drawn the message of this number. Returns false if it was not under
  // way.
  bool acknowledge(std::uint32_t number, double nowMs);
  // Returns for how long the page has acknowledged nothing although messages are under way.
  double waitedMs(double nowMs) const {
    return underWay_.empty() ? 0 : nowMs - std::max(underWay_.front().ms, heardMs_);
  }

  // Returns the largest number of pixels in motion that the link can carry.
  double mostPixels() const { return mostPixels_; }
  int quality() const { return quality_; }

 private:
  struct Sent {
    std::uint32_t number = 0;
    double ms = 0;
  };
  void adapt(double delayMs);

  enum class TileState : std::uint8_t { stale, lossy, exact };  // as the page has it
  DisplayImage last_;                                           // the newest picture
  std::vector<TileState> states_;  // states of its tiles once all messages are drawn
  std::deque<Sent> underWay_;
  double heardMs_ = 0;  // time of the last acknowledgement
  std::uint32_t number_ = 0;
  int window_ = 3;  // messages that may be under way
  int quality_ = 80;
  double mostPixels_ = 1e9, leastMs_ = 1e9;
};

}  // namespace whit::serve
