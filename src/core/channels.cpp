#include "core/channels.h"

#include <algorithm>

#include "core/text.h"

namespace whit {

ChannelSet parseChannels(const std::string& commaSeparated) {
  ChannelSet set;
  for (const std::size_t i : indicesOf(commaSeparated, namesIn(kChannels), "channel")) {
    set = set.with(static_cast<Channel>(i));
  }
  return set;
}

std::string namesOf(ChannelSet channels) {
  std::string names;
  channels.forEach(
      [&](Channel c) { names += (names.empty() ? "" : ",") + std::string(infoOf(c).name); });
  return names;
}

std::size_t ChannelLayers::bytesPerPixel(ChannelSet channels) {
  std::size_t bytes = 0;
  channels.forEach([&](Channel c) { bytes += infoOf(c).components * sizeof(float); });
  return bytes;
}

void ChannelLayers::resize(ChannelSet channels, std::size_t pixels) {
  if (channels == channels_ && pixels == pixels_) return;

  *this = {};
  channels_ = channels;
  pixels_ = pixels;

  // Channels that count or number things hold integers, all others hold floats.
  channels.forEach([&](Channel c) {
    if (infoOf(c).countsThings) {
      numbers_[index(c)].resize(pixels * infoOf(c).components);
    } else {
      floats_[index(c)].resize(pixels * infoOf(c).components);
    }
  });
}

void ChannelLayers::keepOnly(ChannelSet channels) {
  // The loop removes channels from channels_, so it runs over a copy.
  const ChannelSet before = channels_;
  before.forEach([&](Channel c) {
    if (channels.has(c)) return;

    channels_ = channels_.without(c);
    floats_[index(c)].clear();
    numbers_[index(c)].clear();
  });
}

void ChannelLayers::keep(std::size_t pixel, const ChannelValues& v) {
  const auto keepFloats = [&](Channel c, std::initializer_list<float> values) {
    if (channels_.has(c)) std::ranges::copy(values, &floats(c)[pixel * values.size()]);
  };
  const auto keepNumber = [&](Channel c, std::uint32_t number) {
    if (channels_.has(c)) numbers(c)[pixel] = number;
  };

  keepFloats(Channel::depth, {v.z, v.distance});
  keepFloats(Channel::position, {v.position.x, v.position.y, v.position.z});
  keepFloats(Channel::normal, {v.normal.x, v.normal.y, v.normal.z});
  keepFloats(Channel::albedo, {v.albedo.x, v.albedo.y, v.albedo.z});
  keepFloats(Channel::uv, {v.uv.x, v.uv.y});
  keepFloats(Channel::roughness, {v.roughness});
  keepFloats(Channel::metallic, {v.metallic});
  keepFloats(Channel::motion, {v.motion.x, v.motion.y});
  keepNumber(Channel::object, v.object);
  keepNumber(Channel::material, v.material);
  keepNumber(Channel::triangle, v.triangle);
}

}  // namespace whit
