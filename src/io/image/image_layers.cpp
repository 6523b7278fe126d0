#include "io/image/image_layers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "core/display.h"
#include "core/edit_distance.h"
#include "core/error.h"
#include "core/index.h"
#include "core/text.h"
#include "io/files.h"

namespace whit {
namespace {

std::string manifest(const std::vector<std::string>& names) {
  auto json = nlohmann::ordered_json::object();
  for (const auto i : indices(names)) json[std::to_string(i)] = names[i];
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

constexpr double kWhite16 = 65535;
constexpr double kDepthCodesPerUnit = 1000;

// True for channels that images show as three colors; others are gray.
bool isColor(Channel channel) {
  return channel == Channel::normal || channel == Channel::albedo || channel == Channel::uv ||
         needsFloats(channel);
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
    case Channel::roughness:
    case Channel::metallic:
      return value * kWhite16;
    case Channel::rays:
      return value;
    default:  // the largest code says that nothing was hit
      if (value == kNoNumber) return kWhite16;
      return value < kWhite16 ? value : value + 1;
  }
}

// Each pixel has one code, or three codes that are 0 for components which the channel lacks.
std::vector<std::uint16_t> codesOf(const std::string& path, const ChannelLayers& channels,
                                   Channel channel) {
  if (needsFloats(channel)) {
    throwUsage("'" + path + "': " + std::string(infoOf(channel).name) +
               "s do not fit into a PNG: write an EXR");
  }

  const ChannelInfo& info = infoOf(channel);
  std::vector<std::uint16_t> codes;
  for (const auto i : indices(channels.pixels())) {
    std::array<double, 3> values{};
    for (const auto c : indices(info.components)) {
      const std::size_t at = i * info.components + c;
      values[c] = info.countsThings ? static_cast<double>(channels.numbers(channel)[at])
                                    : static_cast<double>(channels.floats(channel)[at]);
    }

    // A normal of zero means that nothing was hit. Its code is 0, although a component of 0 has
    // another.
    const bool isEmpty = channel == Channel::normal && values == std::array<double, 3>{};
    for (const auto c : indices((isColor(channel) ? 3 : 1))) {
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

bool sameBits(const Rgb& a, const Rgb& b) {
  using Bits = std::array<std::uint32_t, 3>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

std::string place(int x, int y) { return concat("(", x, ", ", y, ")"); }

std::string sizeText(const Image& image) { return concat(image.width, "x", image.height); }

// Throws if a part lacks a layer that another one has.
void requireLayers(const std::string& path, const std::vector<ImageLayer>& layers,
                   const std::string& otherPath, const std::vector<ImageLayer>& others) {
  for (const ImageLayer& wanted : others) {
    const auto isWanted = [&](const ImageLayer& l) {
      return l.name == wanted.name && l.countsThings == wanted.countsThings;
    };
    if (std::ranges::any_of(layers, isWanted)) continue;
    throwUsage(path + ": lacks the channel " + wanted.name + ", which '" + otherPath + "' has");
  }
}

// Text that may differ between parts of one picture: it follows from other text or from the layers,
// or it is about the part, the machine, or the display of the picture.
constexpr std::array kMayDiffer{"software", "effectsUsed", "crop",     "quality",  "packet",
                                "simd",     "effects",     "exposure", "tonemap",  "strict",
                                "exr",      "channels",    "objects",  "materials"};

// Throws if two parts say that they show different scenes or were made with different options. A
// part without text, as other programs write, says nothing.
void requireSamePicture(const std::string& path, const ImageMetadata& own,
                        const std::string& firstPath, const ImageMetadata& first) {
  if (own.empty() || first.empty()) return;

  std::set<std::string> differing;
  for (const ImageMetadata* text : {&own, &first}) {
    for (const auto& entry : *text) {
      const bool isShared = contains(own, entry) && contains(first, entry);
      if (!isShared && !contains(kMayDiffer, entry.first)) differing.insert(entry.first);
    }
  }

  if (differing.empty()) return;
  throwUsage("'" + path + "' and '" + firstPath +
             "' are parts of different pictures: they differ in " +
             joined({differing.begin(), differing.end()}));
}

// Copies the part's window, layers included, which are in the order of their names.
void addPart(const std::string& path, const Image& part, const std::vector<ImageLayer>& layers,
             MergedImage& to, std::vector<bool>& covered, Warnings& warnings) {
  std::uint64_t differing = 0;
  std::string first;

  for (int y = part.window.y0; y < part.window.y1; ++y) {
    for (int x = part.window.x0; x < part.window.x1; ++x) {
      const std::size_t i = to.image.index(x, y), from = part.index(x, y);
      bool same = sameBits(to.image.pixels[i], part.pixels[from]);
      to.image.pixels[i] = part.pixels[from];
      for (const auto k : indices(layers)) {
        std::uint32_t& word = to.layers[k].words[i];
        same = same && word == layers[k].words[from];
        word = layers[k].words[from];
      }

      if (covered[i] && !same && differing++ == 0) first = path + " at " + place(x, y);
      covered[i] = true;
    }
  }

  warnings.add("overlapping parts differ, the later one taken", first, differing);
}

}  // namespace

std::vector<float> ImageLayer::floats() const {
  std::vector<float> values;
  values.reserve(words.size());
  for (const std::uint32_t word : words) values.push_back(std::bit_cast<float>(word));
  return values;
}

std::vector<ImageLayer> layersOf(const ChannelLayers& channels, ChannelSet wanted) {
  std::vector<ImageLayer> layers;
  channels.channels().forEach([&](Channel channel) {
    if (!wanted.has(channel)) return;
    const ChannelInfo& info = infoOf(channel);
    for (const auto c : indices(info.components)) {
      ImageLayer& layer = layers.emplace_back();
      const std::string prefix = channel == Channel::alpha ? "" : std::string(info.name) + ".";
      layer.name = prefix + std::string(info.suffixes[c]);
      layer.countsThings = info.countsThings;
      layer.words.reserve(channels.pixels());

      // The components of a pixel are interleaved in `channels`, and each layer takes one of them.
      for (std::size_t at = c; at < channels.pixels() * info.components; at += info.components) {
        layer.words.push_back(info.countsThings
                                  ? channels.numbers(channel)[at]
                                  : std::bit_cast<std::uint32_t>(channels.floats(channel)[at]));
      }
    }
  });

  return layers;
}

namespace {

// A word that is one letter off the name of a channel is taken for a misspelling. More would refuse
// names such as "room.mirror.png", which is two letters off "error".
void requireNoMisspelling(const std::string& path, const std::string& word) {
  constexpr std::size_t kLeastLetters = 5;  // shorter words have too many neighbors
  if (word.size() < kLeastLetters) return;

  for (const ChannelInfo& info : kChannels) {
    const std::string name(info.name);
    if (editDistance(word, name) > 1) continue;
    throwUsage("'" + path + "': no channel is called '" + word + "'; did you mean '" + name + "'?");
  }
}

}  // namespace

std::optional<Channel> channelNamedBy(const std::string& path, ChannelSet kept) {
  if (extensionOf(path) != ".png" && extensionOf(path) != ".exr") return std::nullopt;

  std::string name = inLowerCase(std::filesystem::path(path).stem().string());
  // The frame's number and the separators at the end are no part of the channel's name.
  std::erase(name, '#');
  while (!name.empty() && std::string_view("-_.").find(name.back()) != std::string_view::npos) {
    name.pop_back();
  }

  const std::string last = name.substr(name.rfind('.') + 1);
  const bool isOnlyPart = last == name;
  const auto found = std::ranges::find(kChannels, last, &ChannelInfo::name);
  if (found == kChannels.end()) {
    if (!isOnlyPart) requireNoMisspelling(path, last);
    return std::nullopt;
  }

  const auto channel = static_cast<Channel>(found - kChannels.begin());
  if (isOnlyPart && (extensionOf(path) == ".exr" || !kept.has(channel))) return std::nullopt;
  return channel;
}

void requireNoChannelName(const std::string& file) {
  const std::string asPng = std::filesystem::path(file).replace_extension(".png").string();
  if (!channelNamedBy(asPng, ChannelSet())) return;
  const bool isFilm = extensionOf(file) == ".mp4";
  throwUsage("'" + file + "': a " + (isFilm ? "film" : "JPEG") + " holds no channel: write '" +
             asPng + "'");
}

void writeChannelExr(const std::string& path, const Image& image, const ChannelLayers& channels,
                     Channel channel, const ImageMetadata& metadata, ExrStorage storage,
                     int threads) {
  constexpr const char* kColors[] = {"R", "G", "B"};
  std::vector<ImageLayer> layers = layersOf(channels, {channel});
  layers.resize(isColor(channel) ? 3 : 1);

  for (const auto c : indices(layers)) {
    layers[c].name = isColor(channel) ? kColors[c] : "Y";
    layers[c].words.resize(channels.pixels());  // texture coordinates have no third component
    if (!std::exchange(layers[c].countsThings, false)) continue;

    for (std::uint32_t& word : layers[c].words) {
      word = std::bit_cast<std::uint32_t>(word == kNoNumber ? -1.0f : static_cast<float>(word));
    }
  }

  Image noColors(image.width, image.height, Crop{});
  noColors.window = image.window;
  writeExr(path, noColors, metadata, storage, threads, layers);
}

ImageMetadata describeChannels(const Scene& scene, ChannelSet channels) {
  if (channels.empty()) return {};
  ImageMetadata metadata{{"channels", namesOf(channels)}};
  if (channels.has(Channel::object)) metadata.emplace_back("objects", manifest(scene.items.names));

  if (channels.has(Channel::material)) {
    metadata.emplace_back("materials", manifest(namesIn(scene.materials)));
  }

  return metadata;
}

void writeChannelPng(const std::string& path, const Image& image, const ChannelLayers& channels,
                     Channel channel, const ImageMetadata& metadata) {
  writePng(path,
           {image.windowWidth(), image.windowHeight(), isColor(channel) ? 3 : 1,
            codesOf(path, channels, channel)},
           channel == Channel::albedo, metadata);
}

MergedImage mergeImages(const std::vector<std::string>& paths, const ImageLimits& limits,
                        Warnings& warnings) {
  if (paths.empty()) throwUsage("expected at least one part to merge");

  MergedImage merged;
  Image& image = merged.image;
  std::vector<bool> covered;
  bool hasExr = false;
  std::string firstPath;  // the first part that says what it shows, and what it says
  ImageMetadata first;

  for (const std::string& path : paths) {
    const Image part = readImage(path, limits);
    const bool isExr = extensionOf(path) == ".exr";
    const std::vector<ImageLayer> layers = readLayers(path, limits);

    // The first part determines the size of the image and its layers.
    if (covered.empty()) {
      image = Image(part.width, part.height);
      covered.assign(image.pixels.size(), false);
      merged.layers = layers;
      for (ImageLayer& layer : merged.layers) layer.words.assign(image.pixels.size(), 0);
    } else if (part.width != image.width || part.height != image.height) {
      throwUsage(path + ": a part of a " + sizeText(part) + " image, but '" + paths[0] +
                 "' is of a " + sizeText(image) + " one");
    }

    requireLayers(path, layers, paths[0], merged.layers);
    requireLayers(paths[0], merged.layers, path, layers);
    addPart(path, part, layers, merged, covered, warnings);

    // Only metadata on which all EXR parts agree are kept.
    if (!isExr) continue;
    const ImageMetadata own = readExrMetadata(path);
    if (!std::exchange(hasExr, true)) merged.metadata = own;
    if (first.empty()) {
      firstPath = path;
      first = own;
    }
    requireSamePicture(path, own, firstPath, first);
    std::erase_if(merged.metadata, [&](const auto& entry) {
      return entry.first == "crop" || !contains(own, entry);
    });
  }

  // Every pixel of the image must lie in some part.
  const auto gap = std::ranges::find(covered, false);
  if (gap == covered.end()) return merged;
  const auto at = static_cast<int>(gap - covered.begin());
  throwUsage(concat("the parts leave ", std::count(gap, covered.end(), false), " pixels of the ",
                    sizeText(image), " image open, the first at ",
                    place(at % image.width, at / image.width)));
}

}  // namespace whit
