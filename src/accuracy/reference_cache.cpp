#include "accuracy/reference_cache.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "accuracy/digest.h"
#include "core/error.h"
#include "core/formatted.h"
#include "inspect/metrics.h"
#include "io/image/image_file.h"
#include "render/renderer.h"
#include "scene/members.h"

namespace whit::accuracy {

namespace {

constexpr const char* kDigestKey = "digest";
constexpr const char* kTimeKey = "renderMs";
constexpr const char* kRaysKey = "rays";
constexpr const char* kErrorKey = "standardError";
constexpr const char* kRadianceKey = "meanRadiance";
constexpr const char* kNoiseKey = "noiseFlip";

using Numbers = std::map<std::string, double>;

// A picture with the numbers in the metadata of its file.
struct KeptPicture {
  Image image;
  Numbers numbers;
  bool fromFile = false;
};

// The picture in a file, if it can be read and has the shape and the digest.
std::optional<KeptPicture> readKept(const std::string& path, const Image& shape,
                                    const std::string& digest) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  try {
    Warnings warnings;
    KeptPicture kept{readImage(path, ImageLimits(), warnings), {}, true};
    bool isRight = kept.image.width == shape.width && kept.image.height == shape.height &&
                   kept.image.window == shape.window;
    for (const auto& [name, text] : readExrMetadata(path)) {
      if (name == kDigestKey) isRight &= text == digest;
      kept.numbers[name] = std::strtod(text.c_str(), nullptr);
    }
    if (isRight && kept.numbers.contains(kDigestKey)) return kept;
  } catch (const Error&) {
    return std::nullopt;
  }
  return std::nullopt;
}

// The picture in the file, or the one that `render` makes, which is written there. `render` takes a
// film and returns numbers.
template <typename Render>
KeptPicture readOrRender(const std::string& path, Film film, const std::string& digest,
                         Render&& render) {
  if (auto kept = readKept(path, film.image, digest)) return std::move(*kept);
  film.wantDisplay = false;
  const Numbers numbers = render(film);
  ImageMetadata metadata{{kDigestKey, digest}};
  for (const auto& [name, value] : numbers) metadata.emplace_back(name, formatted("%.17g", value));
  writeExr(path, film.image, metadata);
  return {std::move(film.image), numbers};
}

}  // namespace

std::vector<RgbD> PassMean::means(std::size_t first, std::size_t step) const {
  std::vector<RgbD> sums(passes_[0].pixels.size());
  double count = 0;
  for (std::size_t i = first; i < passes_.size(); i += step, ++count) {
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += RgbD(passes_[i].pixels[k]);
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
    for (std::size_t k = 0; k < mean.size(); ++k) {
      const RgbD off = RgbD(pass.pixels[k]) - mean[k];
      sum += dot(off, off) / 3;
    }
  }
  const auto passes = static_cast<double>(passes_.size());
  return std::sqrt(sum / (static_cast<double>(mean.size()) * (passes - 1)) / passes);
}

double PassMean::meanRadiance() const {
  const std::vector<RgbD> mean = means(0, 1);
  double sum = 0;
  for (const RgbD& m : mean) sum += (m.x + m.y + m.z) / 3;
  return sum / static_cast<double>(mean.size());
}

ReferenceCache::ReferenceCache(const Scene& scene, const Camera& camera, std::string folder,
                               const std::string& program)
    : scene_(scene), camera_(camera), folder_(std::move(folder)) {
  sceneDigest_ = digestOf({digestOf(scene), digestOf(camera), program});
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throwIo("cannot make the folder '" + folder_ + "': " + error.message());
}

std::string ReferenceCache::digest(const RenderOptions& options) const {
  // The digest of the camera is in sceneDigest_, however the options choose it. The size is that of
  // the film.
  RenderOptions settled = options;
  settled.camera.clear();
  forEachCameraOption([&](auto option, auto /*member*/) { (settled.*option).reset(); });
  const Film film = makeFilm(scene_, options);
  settled.size = ImageSize{film.image.width, film.image.height};
  settled.crop = film.image.window;
  return digestOf({sceneDigest_, digestOf(settled)});
}

const ReferencePicture& ReferenceCache::get(const RenderOptions& options, Progress* progress) {
  const std::string digest = this->digest(options);
  const auto found = pictures_.find(digest);
  if (found != pictures_.end()) return found->second;
  KeptPicture kept =
      readOrRender(pathOf(digest), makeFilm(scene_, options), digest, [&](Film& film) {
        Renderer renderer(scene_, options);
        const FrameStats stats = renderer.renderReference(camera_, film, progress);
        return Numbers{{kTimeKey, stats.frameMs}, {kRaysKey, static_cast<double>(stats.allRays())}};
      });
  ReferencePicture picture{std::move(kept.image), digest, kept.numbers[kTimeKey],
                           kept.numbers[kRaysKey], kept.fromFile};
  return pictures_.emplace(digest, std::move(picture)).first->second;
}

std::string ReferenceCache::pathOf(const std::string& digest) const {
  return (std::filesystem::path(folder_) / (digest + ".exr")).string();
}

TransportPicture ReferenceCache::transport(const RenderOptions& options, Progress* progress) const {
  const std::string digest =
      digestOf({this->digest(options), "passes", std::to_string(kTransportPasses)});
  KeptPicture kept =
      readOrRender(pathOf(digest), makeFilm(scene_, options), digest, [&](Film& film) {
        Renderer renderer(scene_, options);
        PassMean passes;
        double ms = 0;
        for (int pass = 0; pass < kTransportPasses; ++pass) {
          renderer.setSeed(static_cast<std::uint32_t>(pass));
          ms += renderer.render(camera_, film).frameMs;
          passes.add(film.image);
          reportProgress(progress, "all transport",
                         static_cast<double>(pass + 1) / kTransportPasses);
        }
        film.image = passes.mean();
        const ImageDifference halves = compareImages(passes.half(false), passes.half(true),
                                                     options.exposure.ev, options.toneCurve);
        return Numbers{{kTimeKey, ms},
                       {kErrorKey, passes.standardError()},
                       {kRadianceKey, passes.meanRadiance()},
                       {kNoiseKey, halves.flipMean}};
      });
  Numbers& n = kept.numbers;
  return {{kTransportPasses, kTransportPasses * options.spp, n[kErrorKey], n[kRadianceKey],
           n[kNoiseKey], n[kTimeKey], kept.fromFile, digest},
          std::move(kept.image)};
}

}  // namespace whit::accuracy
