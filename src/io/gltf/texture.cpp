#include "io/gltf/texture.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace whit {
namespace {

Wrap readWrap(const GltfValue& code) {
  constexpr std::uint64_t kRepeat = 10497, kClampToEdge = 33071, kMirroredRepeat = 33648;
  const std::uint64_t found = code.whole(kRepeat);
  return found == kClampToEdge      ? Wrap::clamp
         : found == kMirroredRepeat ? Wrap::mirror
                                    : Wrap::repeat;
}

std::size_t readSet(const GltfValue& texCoord, std::size_t fallback) {
  constexpr std::uint64_t kLargestSet = 1000;
  return texCoord.whole(fallback, kLargestSet);
}

// KHR_texture_transform: translation * rotation * scale; with v pointing down, counter-clockwise as
// seen.
void readUvTransform(const GltfValue& t, GltfUvMap& uv) {
  const double r = t["rotation"].number(0), c = std::cos(r), s = std::sin(r);
  std::vector<double> scale = t["scale"].numbers(2), offset = t["offset"].numbers(2);
  if (scale.empty()) scale = {1, 1};
  if (offset.empty()) offset = {0, 0};
  uv.uu = c * scale[0];
  uv.uv = s * scale[1];
  uv.u0 = offset[0];
  uv.vu = -s * scale[0];
  uv.vv = c * scale[1];
  uv.v0 = offset[1];
  uv.set = readSet(t["texCoord"], uv.set);
}

}  // namespace

GltfTexture readGltfTexture(const GltfDocument& document, const std::string& where,
                            const GltfValue& info) {
  GltfTexture result;
  if (!info.exists()) return result;
  const GltfValue textures = document.list("textures"), samplers = document.list("samplers");
  const GltfValue texture = textures[info.need("index").index(textures).value_or(0)];
  result.image = texture["source"].index(document.list("images"));
  if (!result.image) {
    document.warnings().add("texture in a format that is not supported left out", where);
    return result;
  }
  if (const auto index = texture["sampler"].index(samplers)) {
    const GltfValue sampler = samplers[*index];
    result.wrapU = readWrap(sampler["wrapS"]);
    result.wrapV = readWrap(sampler["wrapT"]);
    constexpr std::uint64_t kNearest = 9728;
    if (sampler["magFilter"].whole(0) == kNearest) {
      document.warnings().add("texture to be looked up at its nearest texel, interpolated instead",
                              where);
    }
  }
  result.uv.set = readSet(info["texCoord"], 0);
  const GltfValue transform = info["extensions"]["KHR_texture_transform"];
  if (transform.exists()) readUvTransform(transform, result.uv);
  return result;
}

}  // namespace whit
