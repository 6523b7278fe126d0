#include "io/image/image_layers.h"

#include <bit>
#include <cstring>

#include <nlohmann/json.hpp>

namespace whit {

namespace {

template <typename NameOf>
std::string manifest(std::size_t count, NameOf&& nameOf) {
  auto names = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < count; ++i) names[std::to_string(i)] = nameOf(i);
  return names.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
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

}  // namespace whit
