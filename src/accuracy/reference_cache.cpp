#include "accuracy/reference_cache.h"

#include <cstdlib>
#include <filesystem>

#include "accuracy/digest.h"
#include "core/error.h"
#include "io/image_file.h"
#include "render/renderer.h"

namespace whit::accuracy {

namespace {

constexpr const char* kDigestKey = "digest";
constexpr const char* kTimeKey = "renderMs";
constexpr const char* kRaysKey = "rays";

// False: there is none, or it is not what it claims to be.
bool readPicture(const std::string& path, const Image& shape, ReferencePicture& picture) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  try {
    Warnings warnings;
    Image image = readImage(path, ImageLimits(), warnings);
    if (image.width != shape.width || image.height != shape.height ||
        image.window != shape.window) {
      return false;
    }
    bool same = false;
    for (const auto& [name, text] : readExrMetadata(path)) {
      if (name == kDigestKey) same = text == picture.digest;
      if (name == kTimeKey) picture.renderMs = std::strtod(text.c_str(), nullptr);
      if (name == kRaysKey) picture.rays = std::strtod(text.c_str(), nullptr);
    }
    if (!same) return false;
    picture.image = std::move(image);
    picture.fromFile = true;
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

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
  // The camera counts as it is, whether it was named or described; the size as it turns out.
  RenderOptions settled = options;
  settled.camera.clear();
  settled.eye.reset(), settled.at.reset(), settled.up.reset(), settled.fov.reset();
  settled.ortho.reset();
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
  const std::string path = (std::filesystem::path(folder_) / (digest + ".exr")).string();
  if (!readPicture(path, film.image, picture)) {
    Renderer renderer(scene_, options);
    const FrameStats stats = renderer.renderReference(camera_, film, progress);
    picture.renderMs = stats.frameMs;
    picture.rays = static_cast<double>(stats.allRays());
    picture.image = std::move(film.image);
    writeExr(path, picture.image,
             {{kDigestKey, digest},
              {kTimeKey, std::to_string(picture.renderMs)},
              {kRaysKey, std::to_string(picture.rays)}});
  }
  return pictures_.emplace(digest, std::move(picture)).first->second;
}

}  // namespace whit::accuracy
