#include "viewer/comparison.h"

#include <algorithm>

namespace whit::view {

namespace {

std::ptrdiff_t rowBytes(const DisplayImage& image) { return std::ptrdiff_t{4} * image.width; }

// Removes the scale that heatMap() draws below the map, which panels would cover.
DisplayImage withoutScale(const DisplayImage& map, int width, int height) {
  DisplayImage image{width, height, {}};
  image.rgba.resize(static_cast<std::size_t>(rowBytes(image)) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    const auto row = map.rgba.begin() + y * rowBytes(map);
    std::copy(row, row + rowBytes(image), image.rgba.begin() + y * rowBytes(image));
  }
  return image;
}

}  // namespace

void finishComparison(const Film& frame, float exposure, ToneCurve curve, Comparison& comparison) {
  const Image& reference = comparison.reference.image;
  comparison.heatMap =
      withoutScale(heatMap(frame.image, reference), reference.width, reference.height);
  comparison.difference = compareImages(frame.image, reference, exposure, curve);
}

DisplayImage splitPicture(const DisplayImage& frame, const Comparison& comparison, int split) {
  DisplayImage picture = frame;
  const DisplayImage& reference = comparison.reference.display;
  if (reference.width != frame.width || reference.height != frame.height) return picture;
  const std::ptrdiff_t left = std::ptrdiff_t{4} * std::clamp(split, 0, frame.width);
  for (int y = 0; y < comparison.rows; ++y) {
    const auto row = reference.rgba.begin() + y * rowBytes(reference);
    std::copy(row + left, row + rowBytes(reference),
              picture.rgba.begin() + y * rowBytes(picture) + left);
  }
  return picture;
}

}  // namespace whit::view
