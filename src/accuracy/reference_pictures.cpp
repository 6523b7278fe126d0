#include "accuracy/reference_pictures.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "inspect/reference_frame.h"
#include "output/digest.h"

namespace whit::accuracy {

RenderOptions transportOptions(const RenderOptions& options, int samples) {
  RenderOptions exact = referenceOptions(options, samples, kTransportCutoff);
  exact = exactIn(exact, Cause::transport, kTransportCutoff);
  exact.mode = Mode::packets;
  return exact;
}

std::vector<RgbD> PassMean::means(std::size_t first, std::size_t step) const {
  std::vector<RgbD> sums(passes_[0].pixels.size());
  double count = 0;
  for (std::size_t i = first; i < passes_.size(); i += step, ++count) {
    for (const auto k : indices(sums)) sums[k] += RgbD(passes_[i].pixels[k]);
  }

  for (RgbD& sum : sums) sum = sum / count;
  return sums;
}

Image PassMean::picture(std::size_t first, std::size_t step) const {
  Image image = passes_[0];
  std::ranges::transform(means(first, step), image.pixels.begin(),
                         [](const RgbD& mean) { return Rgb(mean); });
  return image;
}

double PassMean::standardError() const {
  const std::vector<RgbD> mean = means(0, 1);
  double sum = 0;

  for (const Image& pass : passes_) {
    for (const auto k : indices(mean)) {
      const RgbD off = RgbD(pass.pixels[k]) - mean[k];
      sum += dot(off, off) / 3;
    }
  }

  // The variance of the passes about their mean, divided by their number, is the variance of the
  // mean.
  const auto passes = static_cast<double>(passes_.size());
  return std::sqrt(sum / (static_cast<double>(mean.size()) * (passes - 1)) / passes);
}

double PassMean::meanRadiance() const {
  const std::vector<RgbD> mean = means(0, 1);
  double sum = 0;
  for (const RgbD& m : mean) sum += (m.x + m.y + m.z) / 3;
  return sum / static_cast<double>(mean.size());
}

const ReferencePicture& ReferenceCache::get(const RenderOptions& options, Progress* progress) {
  const std::string digest = digestOf(options);
  const auto found = pictures_.find(digest);
  if (found != pictures_.end()) return found->second;

  Film film = makeFilm(scene_, options);
  film.wantDisplay = false;
  Renderer renderer(scene_, options);
  const FrameStats stats = renderReference(renderer, camera_, film, progress);

  ReferencePicture picture{std::move(film.image), stats.frameMs,
                           static_cast<double>(stats.allRays())};
  return pictures_.emplace(digest, std::move(picture)).first->second;
}

TransportPicture renderTransport(const Scene& scene, const Camera& camera,
                                 const RenderOptions& options, Progress* progress) {
  Film film = makeFilm(scene, options);
  film.wantDisplay = false;
  Renderer renderer(scene, options);
  PassMean passes;
  double ms = 0;

  for (int pass = 0; pass < kTransportPasses; ++pass) {
    renderer.setSeed(pass);
    ms += renderer.render(camera, film).frameMs;
    passes.add(film.image);
    reportProgress(progress, "all transport", static_cast<double>(pass + 1) / kTransportPasses);
  }

  // The even and the odd passes are independent, so they differ by their noise alone.
  const ImageDifference halves =
      compareImages(passes.half(false), passes.half(true), options.exposure.ev, options.toneCurve);
  return {{kTransportPasses, kTransportPasses * options.spp, passes.standardError(),
           passes.meanRadiance(), halves.flipMean, ms},
          passes.mean()};
}

}  // namespace whit::accuracy
