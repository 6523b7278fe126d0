#include "accuracy/pass_mean.h"

#include <cmath>

namespace whit::accuracy {

namespace {

double meanOf(const RgbD& c) { return (c.x + c.y + c.z) / 3; }

}  // namespace

PassMean::PassMean(const Image& shape)
    : shape_(shape.width, shape.height, shape.window),
      mean_(shape.pixels.size()),
      deviations_(mean_.size()),
      evens_(mean_.size()),
      odds_(mean_.size()) {}

void PassMean::add(const Image& pass) {
  std::vector<RgbD>& half = passes_ % 2 == 0 ? evens_ : odds_;
  ++passes_;
  for (std::size_t i = 0; i < mean_.size(); ++i) {
    const RgbD value(pass.pixels[i]), before = value - mean_[i];
    mean_[i] += before / static_cast<double>(passes_);
    deviations_[i] += before * (value - mean_[i]);
    half[i] += value;
  }
}

Image PassMean::picture(const std::vector<RgbD>& sums, int passes) const {
  Image image = shape_;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    image.pixels[i] = Rgb(sums[i] / static_cast<double>(passes));
  }
  return image;
}

Image PassMean::mean() const { return picture(mean_, 1); }

Image PassMean::half(bool odd) const {
  return odd ? picture(odds_, passes_ / 2) : picture(evens_, (passes_ + 1) / 2);
}

double PassMean::standardError() const {
  double sum = 0;
  for (const RgbD& d : deviations_) sum += meanOf(d);
  const double variance = sum / (static_cast<double>(deviations_.size()) * (passes_ - 1));
  return std::sqrt(variance / passes_);
}

double PassMean::meanRadiance() const {
  double sum = 0;
  for (const RgbD& m : mean_) sum += meanOf(m);
  return sum / static_cast<double>(mean_.size());
}

}  // namespace whit::accuracy
