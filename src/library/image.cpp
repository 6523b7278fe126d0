#include <utility>

#include "core/error.h"
#include "io/image/image_layers.h"
#include "io/paths.h"
#include "library/internal.h"

namespace whit::api {

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
    channel.components.assign(info.suffixes.begin(),
                              info.suffixes.begin() + static_cast<std::ptrdiff_t>(info.components));
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
    if (extension == ".exr") {
      ImageMetadata said = data_->metadata;
      said.insert(said.end(), data_->aboutChannels.begin(), data_->aboutChannels.end());
      writeExr(path, data_->film.image, said, ExrStorage::zip, 1, layersOf(data_->film.channels));
    } else if (extension == ".png") {
      writePng(path, data_->film.display, data_->metadata);
    } else {
      throwUsage("'" + path + "': expected a name that ends in .exr or .png");
    }
  });
}

std::string Image::png() const {
  return guarded([&] { return encodePng(data_->film.display, data_->metadata); });
}

}  // namespace whit::api
