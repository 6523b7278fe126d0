#include "io/image/image_layers.h"

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

std::vector<LayerView> viewsOf(const std::vector<ImageLayer>& layers) {
  std::vector<LayerView> views;
  views.reserve(layers.size());
  for (const ImageLayer& layer : layers) {
    views.push_back({layer.name, layer.countsThings ? nullptr : layer.floats.data(),
                     layer.countsThings ? layer.numbers.data() : nullptr, 1});
  }
  return views;
}

std::vector<LayerView> viewsOf(const ChannelLayers& channels) {
  std::vector<LayerView> views;
  channels.channels().forEach([&](Channel channel) {
    const ChannelInfo& info = infoOf(channel);
    for (std::size_t c = 0; c < info.components; ++c) {
      LayerView view{std::string(info.name) + "." + std::string(info.suffixes[c]), nullptr, nullptr,
                     info.components};
      if (info.countsThings) {
        view.numbers = channels.numbers(channel).data() + c;
      } else {
        view.floats = channels.floats(channel).data() + c;
      }
      views.push_back(std::move(view));
    }
  });
  return views;
}

std::vector<ImageLayer> layersOf(const ChannelLayers& channels) {
  std::vector<ImageLayer> layers;
  for (const LayerView& view : viewsOf(channels)) {
    ImageLayer layer{view.name, view.numbers != nullptr, {}, {}};
    for (std::size_t i = 0; i < channels.pixels(); ++i) {
      if (view.numbers) {
        layer.numbers.push_back(view.numbers[i * view.stride]);
      } else {
        layer.floats.push_back(view.floats[i * view.stride]);
      }
    }
    layers.push_back(std::move(layer));
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
