#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/channels.h"
#include "core/error.h"
#include "core/text.h"
#include "io/files.h"
#include "io/image/image_layers.h"
#include "io/json_reader.h"
#include "library/internal.h"

namespace whit::api {

namespace {

template <typename T>
Json binary(std::span<const T> values) {
  const auto* const first = reinterpret_cast<const std::uint8_t*>(values.data());
  return Json::binary({first, first + values.size_bytes()});
}

template <typename T>
void takeBinary(const Json& json, std::span<T> values) {
  const Json::binary_t& bytes = json.get_binary();
  if (bytes.size() != values.size_bytes()) {
    throwBadScene("the bytes of an image",
                  concat("expected ", values.size_bytes(), " of them, found ", bytes.size()));
  }

  std::ranges::copy(bytes, reinterpret_cast<std::uint8_t*>(values.data()));
}

}  // namespace

Image::Image() : data_(std::make_unique<Data>()) {}
Image::Image(const Image& other) : data_(std::make_unique<Data>(*other.data_)) {}
// NOLINTNEXTLINE(performance-noexcept-move-constructor): the new image allocates
Image::Image(Image&& other) : Image() { data_.swap(other.data_); }
Image& Image::operator=(Image other) noexcept {
  data_.swap(other.data_);
  return *this;
}
Image::~Image() = default;

int Image::width() const { return data_->film.image.windowWidth(); }
int Image::height() const { return data_->film.image.windowHeight(); }
int Image::left() const { return data_->film.image.window.x0; }
int Image::top() const { return data_->film.image.window.y0; }

std::span<const float> Image::rgb() const {
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  const std::vector<Rgb>& pixels = data_->film.image.pixels;
  return {pixels.empty() ? nullptr : &pixels.front().x, 3 * pixels.size()};
}

std::span<const std::uint8_t> Image::srgb() const { return data_->film.display.rgba; }

std::vector<Image::Channel> Image::channels() const {
  const ChannelLayers& layers = data_->film.channels;
  std::vector<Channel> all;

  layers.channels().forEach([&](whit::Channel c) {
    const ChannelInfo& info = infoOf(c);
    Channel channel{info.name, {}, {}, {}};
    channel.components.assign(info.suffixes.begin(), info.suffixes.begin() + info.components);

    if (info.countsThings) {
      channel.numbers = layers.numbers(c);
    } else {
      channel.values = layers.floats(c);
    }

    all.push_back(std::move(channel));
  });

  return all;
}

Image::Channel Image::channel(std::string_view name) const {
  return guarded([&] {
    for (const Channel& channel : channels()) {
      if (channel.name == name) return channel;
    }
    throwUsage("the image has no channel '" + std::string(name) + "': set(\"channels\", ...)");
  });
}

void Image::write(const std::string& path) const {
  guarded([&] {
    const std::string extension = extensionOf(path);
    if (width() == 0) throwUsage("cannot write '" + path + "': nothing has been rendered");

    const Film& film = data_->film;
    if (const auto named = channelNamedBy(path, film.channels.channels())) {
      const std::string name(infoOf(*named).name);
      channel(name);  // throws if the image lacks it
      ImageMetadata metadata = data_->metadata;
      metadata.emplace_back("channel", name);
      if (extension == ".exr") {
        writeChannelExr(path, film.image, film.channels, *named, metadata, ExrStorage::zip, 1);
      } else {
        writeChannelPng(path, film.image, film.channels, *named, metadata);
      }
    } else if (extension == ".exr") {
      ImageMetadata metadata = data_->metadata;
      metadata.insert(metadata.end(), data_->aboutChannels.begin(), data_->aboutChannels.end());
      writeExr(path, film.image, metadata, ExrStorage::zip, 1, layersOf(film.channels));
    } else if (extension == ".png") {
      writePng(path, film.display, data_->metadata);
    } else if (extension == ".jpg" || extension == ".jpeg") {
      requireNoChannelName(path);
      refuseIf(film.display.hasAlpha, "'" + path + "': a JPEG has no alpha: write a PNG or an EXR");
      writeTextFile(path, encodeJpeg(film.display));
    } else {
      throwUsage("'" + path + "': expected a name that ends in .exr, .png or .jpg");
    }
  });
}

std::string Image::png() const {
  return guarded([&] { return encodePng(data_->film.display, data_->metadata); });
}

std::string Image::bytes() const {
  return guarded([&] {
    const whit::Image& image = data_->film.image;
    const DisplayImage& display = data_->film.display;
    const Crop& w = image.window;
    Json all{{"whit", version()},
             {"size", {image.width, image.height}},
             {"window", {w.x0, w.y0, w.x1, w.y1}},
             {"pixels", binary(rgb())},
             {"rgba", binary(srgb())},
             {"hasAlpha", display.hasAlpha},
             {"metadata", data_->metadata},
             {"aboutChannels", data_->aboutChannels}};

    for (const Channel& c : channels()) {
      all["channels"][c.name] = c.numbers.empty() ? binary(c.values) : binary(c.numbers);
    }

    std::string bytes;
    Json::to_cbor(all, bytes);
    return bytes;
  });
}

Image Image::fromBytes(std::string_view bytes) {
  return guarded([&] {
    const Json all = Json::from_cbor(bytes, true, false);
    if (!all.is_object() || all.value("whit", "") != version()) {
      throwBadScene("the bytes of an image", "expected those of whit " + version());
    }
    Image made;
    Film& film = made.data_->film;

    const auto size = all.at("size").get<std::array<int, 2>>();
    const auto w = all.at("window").get<std::array<int, 4>>();
    film.image = whit::Image(size[0], size[1], {w[0], w[1], w[2], w[3]});

    std::vector<Rgb>& pixels = film.image.pixels;
    takeBinary(all.at("pixels"), std::span(pixels));
    std::vector<std::uint8_t> rgba(4 * pixels.size());
    takeBinary(all.at("rgba"), std::span(rgba));
    film.display = {made.width(), made.height(), std::move(rgba), all.at("hasAlpha").get<bool>()};

    all.at("metadata").get_to(made.data_->metadata);
    all.at("aboutChannels").get_to(made.data_->aboutChannels);

    // The names decide which layers the film has; then the layers are read.
    std::string names;
    const Json channels = all.value("channels", Json::object());
    for (const auto& [name, values] : channels.items()) names += (names.empty() ? "" : ",") + name;
    film.channels.resize(parseChannels(names), pixels.size());

    film.channels.channels().forEach([&](whit::Channel c) {
      const Json& values = channels.at(std::string(infoOf(c).name));
      if (infoOf(c).countsThings) {
        takeBinary(values, film.channels.numbers(c));
      } else {
        takeBinary(values, film.channels.floats(c));
      }
    });

    return made;
  });
}

}  // namespace whit::api
