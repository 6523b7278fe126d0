// Merges crops of an image.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include "core/error.h"
#include "io/image/image_layers.h"
#include "io/paths.h"

namespace whit {

namespace {

bool sameBits(const Rgb& a, const Rgb& b) {
  const auto same = [](float p, float q) {
    return std::bit_cast<std::uint32_t>(p) == std::bit_cast<std::uint32_t>(q);
  };
  return same(a.x, b.x) && same(a.y, b.y) && same(a.z, b.z);
}

std::string place(int x, int y) { return "(" + std::to_string(x) + ", " + std::to_string(y) + ")"; }

std::string sizeText(const Image& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

void requireSameLayers(const std::string& path, const std::vector<ImageLayer>& layers,
                       const std::string& firstPath, const std::vector<ImageLayer>& firstLayers) {
  const auto require = [](const std::vector<ImageLayer>& all, const ImageLayer& wanted,
                          const std::string& lacks, const std::string& has) {
    const auto isWanted = [&](const ImageLayer& l) {
      return l.name == wanted.name && l.countsThings == wanted.countsThings;
    };
    if (std::ranges::any_of(all, isWanted)) return;
    throwUsage(lacks + ": lacks the channel " + wanted.name + ", which '" + has + "' has");
  };
  for (const ImageLayer& layer : firstLayers) require(layers, layer, path, firstPath);
  for (const ImageLayer& layer : layers) require(firstLayers, layer, firstPath, path);
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
      for (std::size_t k = 0; k < layers.size(); ++k) {
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

MergedImage mergeImages(const std::vector<std::string>& paths, const ImageLimits& limits,
                        Warnings& warnings) {
  if (paths.empty()) throwUsage("expected at least one part to merge");
  MergedImage merged;
  Image& image = merged.image;
  std::vector<bool> covered;
  bool isFirstExr = true;
  for (const std::string& path : paths) {
    const Image part = readImage(path, limits, warnings);
    const std::vector<ImageLayer> layers = readLayers(path, limits);
    if (covered.empty()) {
      image = Image(part.width, part.height);
      covered.assign(image.pixels.size(), false);
      merged.layers = layers;
      for (ImageLayer& layer : merged.layers) layer.words.assign(image.pixels.size(), 0);
    } else if (part.width != image.width || part.height != image.height) {
      throwUsage(path + ": a part of a " + sizeText(part) + " image, but '" + paths[0] +
                 "' is of a " + sizeText(image) + " one");
    }
    requireSameLayers(path, layers, paths[0], merged.layers);
    addPart(path, part, layers, merged, covered, warnings);
    if (extensionOf(path) != ".exr") continue;
    const ImageMetadata said = readExrMetadata(path);
    if (std::exchange(isFirstExr, false)) merged.metadata = said;
    std::erase_if(merged.metadata, [&](const auto& entry) {
      return entry.first == "crop" || std::ranges::find(said, entry) == said.end();
    });
  }
  const auto gap = std::ranges::find(covered, false);
  if (gap == covered.end()) return merged;
  const auto at = static_cast<int>(gap - covered.begin());
  throwUsage("the parts leave " + std::to_string(std::count(gap, covered.end(), false)) +
             " pixels of the " + sizeText(image) + " image open, the first at " +
             place(at % image.width, at / image.width));
}

}  // namespace whit
