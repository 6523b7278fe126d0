// The extra output channels of a picture (AOVs, --channels): properties of the first hit of each
// pixel's ray; alpha, what surfaces cover in the mean of its samples; and the error of the picture:
// the standard error of its mean over them, and a bound of what --depth and --cutoff left out.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/enum_set.h"
#include "core/index.h"
#include "core/vec3.h"

namespace whit {

enum class Channel : std::uint8_t {
  depth,
  position,
  normal,
  albedo,
  uv,
  object,
  material,
  triangle,
  rays,
  alpha,
  error,
  roughness,
  metallic,
  motion
};
inline constexpr int kChannelCount = 14;

struct ChannelInfo {
  std::string_view name;
  bool countsThings = false;  // values are 32-bit unsigned numbers; else floats
  std::size_t components = 1;
  std::array<std::string_view, 3> suffixes;  // suffixes of its layers in a file: "depth.Z"
};
inline constexpr std::array<ChannelInfo, kChannelCount> kChannels{
    {{"depth", false, 2, {"Z", "distance"}},
     {"position", false, 3, {"X", "Y", "Z"}},
     {"normal", false, 3, {"X", "Y", "Z"}},
     {"albedo", false, 3, {"R", "G", "B"}},
     {"uv", false, 2, {"U", "V"}},
     {"object", true, 1, {"id"}},
     {"material", true, 1, {"id"}},
     {"triangle", true, 1, {"id"}},
     {"rays", true, 1, {"count"}},
     {"alpha", false, 1, {"A"}},
     {"error", false, 2, {"standard", "ended"}},
     {"roughness", false, 1, {"Y"}},
     {"metallic", false, 1, {"Y"}},
     {"motion", false, 2, {"X", "Y"}}}};
inline constexpr const ChannelInfo& infoOf(Channel channel) { return entryOf(kChannels, channel); }

// True for channels whose values have no fixed range, so that they do not fit into a PNG.
inline constexpr bool needsFloats(Channel channel) {
  return channel == Channel::position || channel == Channel::motion;
}

using ChannelSet = EnumSet<Channel, kChannelCount>;

// Parses "depth,normal"; throws a usage Error that names the nearest channel for an unknown one.
ChannelSet parseChannels(const std::string& commaSeparated);
std::string namesOf(ChannelSet channels);  // joined by commas

// The number of objects, materials and triangles where the ray hit nothing.
inline constexpr std::uint32_t kNoNumber = 0xffffffffu;

// All channels of a pixel but the count of its rays, its alpha and its error. The defaults are
// those of a ray without a hit.
struct ChannelValues {
  // Along the camera's axis, and along the ray.
  float z = kInfinity;
  float distance = kInfinity;
  Vec3f position, normal;
  Rgb albedo;
  Vec2f uv, motion;
  float roughness = 0, metallic = 0;
  std::uint32_t object = kNoNumber, material = kNoNumber, triangle = kNoNumber;
};

// The channels of a picture, in the order of its pixels; the components of a pixel's channel lie
// side by side.
class ChannelLayers {
 public:
  ChannelLayers() = default;

  // Makes room for `pixels` pixels. A change of size or channels clears all values.
  void resize(ChannelSet channels, std::size_t pixels);
  ChannelSet channels() const { return channels_; }
  std::size_t pixels() const { return pixels_; }

  // Memory of the channels for one pixel.
  static std::size_t bytesPerPixel(ChannelSet channels);

  // The channel must exist and have this type.
  std::span<float> floats(Channel channel) { return floats_[index(channel)]; }
  std::span<const float> floats(Channel channel) const { return floats_[index(channel)]; }
  std::span<std::uint32_t> numbers(Channel channel) { return numbers_[index(channel)]; }
  std::span<const std::uint32_t> numbers(Channel channel) const { return numbers_[index(channel)]; }

  // Forgets the channels that are not in the set.
  void keepOnly(ChannelSet channels);

  // Stores the values of all existing channels for the pixel with this index.
  void keep(std::size_t pixel, const ChannelValues& values);

 private:
  static std::size_t index(Channel channel) { return static_cast<std::size_t>(channel); }

  ChannelSet channels_;
  std::size_t pixels_ = 0;
  std::array<std::vector<float>, kChannelCount> floats_;
  std::array<std::vector<std::uint32_t>, kChannelCount> numbers_;
};

}  // namespace whit
