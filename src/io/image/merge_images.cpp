#include "io/image/merge_images.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/error.h"
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

class Merger {
 public:
  void add(const std::string& path, const Image& part, const std::vector<ImageLayer>& layers,
           Warnings& warnings) {
    if (covered_.empty()) {
      image_ = Image(part.width, part.height);
      covered_.assign(image_.pixels.size(), false);
      firstPath_ = path;
      layers_ = layers;
      for (ImageLayer& layer : layers_) layer.words.assign(image_.pixels.size(), 0);
    } else if (part.width != image_.width || part.height != image_.height) {
      throwUsage(path + ": a part of a " + sizeText(part) + " image, but '" + firstPath_ +
                 "' is of a " + sizeText(image_) + " one");
    }
    requireSameLayers(path, layers);
    std::uint64_t differing = 0;
    std::string first;
    for (int y = part.window.y0; y < part.window.y1; ++y) {
      for (int x = part.window.x0; x < part.window.x1; ++x) {
        const std::size_t i = index(x, y);
        const Rgb& value = part.at(x, y);
        const bool same =
            sameBits(image_.pixels[i], value) && sameLayers(layers, part.index(x, y), i);
        if (covered_[i] && !same && differing++ == 0) first = path + " at " + place(x, y);
        image_.pixels[i] = value;
        for (std::size_t k = 0; k < layers.size(); ++k) {
          layers_[k].words[i] = layers[k].words[part.index(x, y)];
        }
        covered_[i] = true;
      }
    }
    warnings.add("overlapping parts differ, the later one taken", first, differing);
  }

  std::vector<ImageLayer> takeLayers() { return std::move(layers_); }

  Image finish() {
    const auto gap = std::find(covered_.begin(), covered_.end(), false);
    if (gap != covered_.end()) {
      const auto missing = std::count(gap, covered_.end(), false);
      const auto at = gap - covered_.begin();
      throwUsage("the parts leave " + std::to_string(missing) + " pixels of the " +
                 sizeText(image_) + " image open, the first at " +
                 place(static_cast<int>(at % image_.width), static_cast<int>(at / image_.width)));
    }
    return std::move(image_);
  }

 private:
  void requireSameLayers(const std::string& path, const std::vector<ImageLayer>& layers) const {
    const auto require = [](const std::vector<ImageLayer>& all, const ImageLayer& wanted,
                            const std::string& lacks, const std::string& has) {
      const auto isWanted = [&](const ImageLayer& l) {
        return l.name == wanted.name && l.countsThings == wanted.countsThings;
      };
      if (std::any_of(all.begin(), all.end(), isWanted)) return;
      throwUsage(lacks + ": lacks the channel " + wanted.name + ", which '" + has + "' has");
    };
    for (const ImageLayer& layer : layers_) require(layers, layer, path, firstPath_);
    for (const ImageLayer& layer : layers) require(layers_, layer, firstPath_, path);
  }

  // True if the layers have the bits of a part's; both are in the order of their names.
  bool sameLayers(const std::vector<ImageLayer>& part, std::size_t from, std::size_t to) const {
    for (std::size_t k = 0; k < part.size(); ++k) {
      if (part[k].words[from] != layers_[k].words[to]) return false;
    }
    return true;
  }

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
           static_cast<std::size_t>(x);
  }

  Image image_;
  std::vector<ImageLayer> layers_;
  std::vector<bool> covered_;
  std::string firstPath_;
};

// Keeps the entries of `common` that `part` has as well.
void intersect(ImageMetadata& common, const ImageMetadata& part) {
  std::erase_if(common, [&](const auto& entry) {
    return std::find(part.begin(), part.end(), entry) == part.end();
  });
}

}  // namespace

MergedImage mergeImages(const std::vector<std::string>& paths, const ImageLimits& limits,
                        Warnings& warnings) {
  if (paths.empty()) throwUsage("expected at least one part to merge");
  Merger merger;
  MergedImage merged;
  bool first = true;
  for (const std::string& path : paths) {
    merger.add(path, readImage(path, limits, warnings), readLayers(path, limits), warnings);
    if (extensionOf(path) != ".exr") continue;
    if (first)
      merged.metadata = readExrMetadata(path);
    else
      intersect(merged.metadata, readExrMetadata(path));
    first = false;
  }
  std::erase_if(merged.metadata, [](const auto& entry) { return entry.first == "crop"; });
  merged.image = merger.finish();
  merged.layers = merger.takeLayers();
  return merged;
}

}  // namespace whit
