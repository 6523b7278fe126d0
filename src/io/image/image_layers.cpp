#include "io/image/image_layers.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/formatted.h"
#include "core/srgb.h"

namespace whit {

namespace {

template <typename NameOf>
std::string manifest(std::size_t count, NameOf&& nameOf) {
  auto names = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < count; ++i) names[std::to_string(i)] = nameOf(i);
  return names.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

constexpr int kWhite16 = 65535;
constexpr double kCodesPerUnit = 1000;  // for depth

// 1 is white.
std::uint16_t codeOfShare(double share) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * kWhite16));
}

std::uint16_t depthCode(const std::string& path, double z) {
  if (std::isinf(z)) return 0;
  const double code = std::round(z * kCodesPerUnit);
  if (!(code >= 0 && code <= kWhite16)) {
    throwLimit(
        formatted("'%s': a depth of %g does not fit into 16 bits, which hold thousandths of "
                  "a unit up to 65.535: write an EXR",
                  path.c_str(), z));
  }
  return static_cast<std::uint16_t>(code);
}

std::uint16_t numberCode(const std::string& path, Channel channel, std::uint32_t number) {
  const bool counts = channel == Channel::rays;
  if (number == kNoNumber && !counts) return kWhite16;
  if (number > static_cast<std::uint32_t>(counts ? kWhite16 : kWhite16 - 1)) {
    throwLimit(formatted("'%s': %s number %u does not fit into 16 bits: write an EXR", path.c_str(),
                         std::string(infoOf(channel).name).c_str(), number));
  }
  return static_cast<std::uint16_t>(number);
}

// Three codes for each pixel, 0 for components that the channel lacks.
template <typename CodeOf>
std::vector<std::uint16_t> colorCodes(std::span<const float> values, std::size_t components,
                                      CodeOf&& codeOfValue) {
  std::vector<std::uint16_t> codes;
  codes.reserve(values.size() / components * 3);
  for (std::size_t i = 0; i < values.size(); i += components) {
    for (std::size_t c = 0; c < 3; ++c) {
      codes.push_back(c < components ? codeOfValue(double{values[i + c]}) : 0);
    }
  }
  return codes;
}

// A normal of length 0 marks a pixel without a surface; its codes are 0.
std::vector<std::uint16_t> normalCodes(std::span<const float> values) {
  std::vector<std::uint16_t> codes =
      colorCodes(values, 3, [](double n) { return codeOfShare((n + 1) / 2); });
  for (std::size_t i = 0; i < values.size(); i += 3) {
    if (values[i] != 0 || values[i + 1] != 0 || values[i + 2] != 0) continue;
    std::fill_n(codes.begin() + static_cast<std::ptrdiff_t>(i), 3, std::uint16_t{0});
  }
  return codes;
}

std::vector<std::uint16_t> codesOf(const std::string& path, const ChannelLayers& channels,
                                   Channel channel) {
  std::vector<std::uint16_t> codes;
  switch (channel) {
    case Channel::depth: {
      const std::span<const float> depth = channels.floats(channel);
      for (std::size_t i = 0; i < depth.size(); i += 2) {
        codes.push_back(depthCode(path, double{depth[i]}));
      }
      return codes;
    }
    case Channel::normal:
      return normalCodes(channels.floats(channel));
    case Channel::albedo:
      return colorCodes(channels.floats(channel), 3, [](double x) {
        return codeOfShare(linearToSrgb(std::clamp(x, 0.0, 1.0)));
      });
    case Channel::uv:
      return colorCodes(channels.floats(channel), 2,
                        [](double x) { return codeOfShare(x - std::floor(x)); });
    case Channel::position:
      throwUsage("'" + path + "': positions do not fit into a PNG: write an EXR");
    default:
      for (const std::uint32_t number : channels.numbers(channel)) {
        codes.push_back(numberCode(path, channel, number));
      }
      return codes;
  }
}

}  // namespace

std::vector<float> ImageLayer::floats() const {
  std::vector<float> values;
  values.reserve(words.size());
  for (const std::uint32_t word : words) values.push_back(std::bit_cast<float>(word));
  return values;
}

std::vector<LayerView> viewsOf(const std::vector<ImageLayer>& layers) {
  std::vector<LayerView> views;
  views.reserve(layers.size());
  for (const ImageLayer& layer : layers) {
    views.push_back({layer.name, layer.countsThings, layer.words.data(), 1});
  }
  return views;
}

std::vector<LayerView> viewsOf(const ChannelLayers& channels) {
  std::vector<LayerView> views;
  channels.channels().forEach([&](Channel channel) {
    const ChannelInfo& info = infoOf(channel);
    for (std::size_t c = 0; c < info.components; ++c) {
      const void* first = nullptr;
      if (info.countsThings) {
        first = channels.numbers(channel).data() + c;
      } else {
        first = channels.floats(channel).data() + c;
      }
      views.push_back({std::string(info.name) + "." + std::string(info.suffixes[c]),
                       info.countsThings, first, info.components});
    }
  });
  return views;
}

std::vector<ImageLayer> layersOf(const ChannelLayers& channels) {
  std::vector<ImageLayer> layers;
  for (const LayerView& view : viewsOf(channels)) {
    ImageLayer& layer = layers.emplace_back();
    layer.name = view.name;
    layer.countsThings = view.countsThings;
    layer.words.resize(channels.pixels());
    const char* from = static_cast<const char*>(view.first);
    for (std::uint32_t& word : layer.words) {
      std::memcpy(&word, from, sizeof word);
      from += view.stride * sizeof word;
    }
  }
  return layers;
}

ImageMetadata describeChannels(const Scene& scene, ChannelSet channels) {
  ImageMetadata said;
  if (channels.empty()) return said;
  said.emplace_back("channels", namesOf(channels));
  if (channels.has(Channel::object)) {
    const std::vector<std::string>& names = scene.items.names;
    said.emplace_back("whit:objects",
                      manifest(names.size(), [&](std::size_t i) { return names[i]; }));
  }
  if (channels.has(Channel::material)) {
    said.emplace_back("whit:materials", manifest(scene.materials.size(), [&](std::size_t i) {
                        return scene.materials[i].name;
                      }));
  }
  return said;
}

void writeChannelPng(const std::string& path, const Image& image, const ChannelLayers& channels,
                     Channel channel, const ImageMetadata& metadata) {
  const bool isColor =
      channel == Channel::normal || channel == Channel::albedo || channel == Channel::uv;
  writePng(path,
           {image.windowWidth(), image.windowHeight(), isColor ? 3 : 1,
            codesOf(path, channels, channel)},
           channel == Channel::albedo, metadata);
}

}  // namespace whit
