#include "accuracy/reference_cache.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>

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

double meanOf(const RgbD& c) { return (c.x + c.y + c.z) / 3; }

// A picture from a file, with the numbers in its metadata.
class CachedPicture {
 public:
  CachedPicture(const std::string& path, const Image& shape, const std::string& digest) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return;
    try {
      Warnings warnings;
      image_ = readImage(path, ImageLimits(), warnings);
      for (const auto& [name, text] : readExrMetadata(path)) facts_[name] = text;
    } catch (const Error&) {
      return;
    }
    isValid_ = image_.width == shape.width && image_.height == shape.height &&
               image_.window == shape.window && facts_[kDigestKey] == digest;
  }

  // True if the file exists and has the digest.
  bool isValid() const { return isValid_; }
  Image takeImage() { return std::move(image_); }
  double number(const char* key) { return std::strtod(facts_[key].c_str(), nullptr); }

 private:
  bool isValid_ = false;
  Image image_;
  std::map<std::string, std::string> facts_;
};

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

ReferenceCache::ReferenceCache(const Scene& scene, const Camera& camera, std::string folder,
                               const std::string& program)
    : scene_(scene), camera_(camera), folder_(std::move(folder)) {
  Digester d;
  d.text(digestOf(scene));
  d.text(digestOf(camera));
  d.text(program);
  sceneDigest_ = d.hex();
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
  Digester d;
  d.text(sceneDigest_);
  d.text(digestOf(settled));
  return d.hex();
}

const ReferencePicture& ReferenceCache::get(const RenderOptions& options, Progress* progress) {
  const std::string digest = this->digest(options);
  const auto found = pictures_.find(digest);
  if (found != pictures_.end()) return found->second;
  ReferencePicture picture;
  picture.digest = digest;
  Film film = makeFilm(scene_, options);
  film.wantDisplay = false;
  CachedPicture cached(pathOf(digest), film.image, digest);
  if (cached.isValid()) {
    picture.image = cached.takeImage();
    picture.renderMs = cached.number(kTimeKey);
    picture.rays = cached.number(kRaysKey);
    picture.fromFile = true;
  } else {
    Renderer renderer(scene_, options);
    const FrameStats stats = renderer.renderReference(camera_, film, progress);
    picture.renderMs = stats.frameMs;
    picture.rays = static_cast<double>(stats.allRays());
    picture.image = std::move(film.image);
    writeExr(pathOf(digest), picture.image,
             {{kDigestKey, digest},
              {kTimeKey, std::to_string(picture.renderMs)},
              {kRaysKey, std::to_string(picture.rays)}});
  }
  return pictures_.emplace(digest, std::move(picture)).first->second;
}

std::string ReferenceCache::pathOf(const std::string& digest) const {
  return (std::filesystem::path(folder_) / (digest + ".exr")).string();
}

TransportPicture ReferenceCache::transport(const RenderOptions& options, Progress* progress) const {
  TransportPicture picture;
  Digester d;
  d.text(digest(options));
  d.text("passes");
  d.bytes(&kTransportPasses, sizeof kTransportPasses);
  picture.digest = d.hex();
  picture.passes = kTransportPasses;
  picture.samples = kTransportPasses * options.spp;
  Film film = makeFilm(scene_, options);
  film.wantDisplay = false;
  CachedPicture cached(pathOf(picture.digest), film.image, picture.digest);
  if (cached.isValid()) {
    picture.image = cached.takeImage();
    picture.standardError = cached.number(kErrorKey);
    picture.meanRadiance = cached.number(kRadianceKey);
    picture.noiseFlip = cached.number(kNoiseKey);
    picture.renderMs = cached.number(kTimeKey);
    picture.fromFile = true;
    return picture;
  }
  Renderer renderer(scene_, options);
  PassMean passes(film.image);
  for (int pass = 0; pass < kTransportPasses; ++pass) {
    renderer.setSeed(static_cast<std::uint32_t>(pass));
    picture.renderMs += renderer.render(camera_, film).frameMs;
    passes.add(film.image);
    reportProgress(progress, "all transport", static_cast<double>(pass + 1) / kTransportPasses);
  }
  picture.image = passes.mean();
  picture.standardError = passes.standardError();
  picture.meanRadiance = passes.meanRadiance();
  picture.noiseFlip =
      compareImages(passes.half(false), passes.half(true), options.exposure.ev, options.toneCurve)
          .flipMean;
  writeExr(pathOf(picture.digest), picture.image,
           {{kDigestKey, picture.digest},
            {kErrorKey, formatted("%.9g", picture.standardError)},
            {kRadianceKey, formatted("%.9g", picture.meanRadiance)},
            {kNoiseKey, formatted("%.9g", picture.noiseFlip)},
            {kTimeKey, formatted("%.9g", picture.renderMs)}});
  return picture;
}

}  // namespace whit::accuracy
