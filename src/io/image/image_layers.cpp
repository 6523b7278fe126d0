#include "io/image/image_layers.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "core/display.h"
#include "core/error.h"
#include "core/text.h"

namespace whit {

namespace {

std::string manifest(const std::vector<std::string>& names) {
  auto json = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < names.size(); ++i) json[std::to_string(i)] = names[i];
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

constexpr double kWhite16 = 65535;
constexpr double kDepthCodesPerUnit = 1000;

bool isColor(Channel channel) {
  return channel == Channel::normal || channel == Channel::albedo || channel == Channel::uv;
}

// Returns the 16-bit code of a value before it is rounded; it may be out of range.
double codeOf(Channel channel, double value) {
  switch (channel) {
    case Channel::depth:
      return std::isinf(value) ? 0 : value * kDepthCodesPerUnit;
    case Channel::normal:
      return std::clamp((value + 1) / 2, 0.0, 1.0) * kWhite16;
    case Channel::albedo:
      return linearToSrgb(std::clamp(value, 0.0, 1.0)) * kWhite16;
    case Channel::uv:
      return (value - std::floor(value)) * kWhite16;
    case Channel::alpha:
    case Channel::error:
      return value * kWhite16;
    case Channel::rays:
      return value;
    default:  // the largest code says that nothing was hit
      return value == kNoNumber ? kWhite16 : value < kWhite16 ? value : value + 1;
  }
}

// The codes of a pixel are one, or three with 0 for components that the channel lacks.
std::vector<std::uint16_t> codesOf(const std::string& path, const ChannelLayers& channels,
                                   Channel channel) {
  if (channel == Channel::position) {
    throwUsage("'" + path + "': positions do not fit into a PNG: write an EXR");
  }
  const ChannelInfo& info = infoOf(channel);
  std::vector<std::uint16_t> codes;
  for (std::size_t i = 0; i < channels.pixels(); ++i) {
    std::array<double, 3> values{};
    for (std::size_t c = 0; c < info.components; ++c) {
      const std::size_t at = i * info.components + c;
      values[c] = info.countsThings ? static_cast<double>(channels.numbers(channel)[at])
                                    : static_cast<double>(channels.floats(channel)[at]);
    }
    const bool isEmpty = channel == Channel::normal && values == std::array<double, 3>{};
    for (std::size_t c = 0; c < (isColor(channel) ? 3 : 1); ++c) {
      const bool isCoded = c < info.components && !isEmpty;
      const double code = isCoded ? std::round(codeOf(channel, values[c])) : 0;
      if (!(code >= 0 && code <= kWhite16)) {
        throwLimit(formatted("'%s': %s %.10g does not fit into 16 bits: write an EXR", path.c_str(),
                             std::string(info.name).c_str(), values[c]));
      }
      codes.push_back(static_cast<std::uint16_t>(code));
    }
  }
  return codes;
}

}  // namespace

std::vector<float> ImageLayer::floats() const {
  std::vector<float> values;
  values.reserve(words.size());
  for (const std::uint32_t word : words) values.push_back(std::bit_cast<float>(word));
  return values;
}

std::vector<ImageLayer> layersOf(const ChannelLayers& channels) {
  std::vector<ImageLayer> layers;
  channels.channels().forEach([&](Channel channel) {
    const ChannelInfo& info = infoOf(channel);
    for (std::size_t c = 0; c < info.components; ++c) {
      ImageLayer& layer = layers.emplace_back();
      const std::string prefix = channel == Channel::alpha ? "" : std::string(info.name) + ".";
      layer.name = prefix + std::string(info.suffixes[c]);
      layer.countsThings = info.countsThings;
      layer.words.reserve(channels.pixels());
      for (std::size_t at = c; at < channels.pixels() * info.components; at += info.components) {
        layer.words.push_back(info.countsThings
                                  ? channels.numbers(channel)[at]
                                  : std::bit_cast<std::uint32_t>(channels.floats(channel)[at]));
      }
    }
  });
  return layers;
}

ImageMetadata describeChannels(const Scene& scene, ChannelSet channels) {
  if (channels.empty()) return {};
  ImageMetadata said{{"channels", namesOf(channels)}};
  if (channels.has(Channel::object)) said.emplace_back("objects", manifest(scene.items.names));
  if (channels.has(Channel::material)) {
    std::vector<std::string> names;
    for (const Material& material : scene.materials) names.push_back(material.name);
    said.emplace_back("materials", manifest(names));
  }
  return said;
}

void writeChannelPng(const std::string& path, const Image& image, const ChannelLayers& channels,
                     Channel channel, const ImageMetadata& metadata) {
  writePng(path,
           {image.windowWidth(), image.windowHeight(), isColor(channel) ? 3 : 1,
            codesOf(path, channels, channel)},
           channel == Channel::albedo, metadata);
}

}  // namespace whit
