#include "io/gltf/texture.h"

#include <algorithm>
#include <cmath>

#include "io/gltf/document.h"

namespace whit {
namespace {

constexpr char kTransform[] = "KHR_texture_transform";

Wrap wrapOf(int code) {
  return code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::clamp
         : code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror
                                                         : Wrap::repeat;
}

double elementOf(const tinygltf::Value& object, const char* key, int i, double fallback) {
  return object.Has(key) ? object.Get(key).Get(i).GetNumberAsDouble() : fallback;
}

// Translation * rotation * scale; with v pointing down, counter-clockwise as seen.
void readUvTransform(const tinygltf::Value& t, GltfUvMap& uv) {
  const double r = numberOf(t, "rotation", 0), c = std::cos(r), s = std::sin(r);
  const double su = elementOf(t, "scale", 0, 1), sv = elementOf(t, "scale", 1, 1);
  uv.uu = c * su;
  uv.uv = s * sv;
  uv.u0 = elementOf(t, "offset", 0, 0);
  uv.vu = -s * su;
  uv.vv = c * sv;
  uv.v0 = elementOf(t, "offset", 1, 0);
  uv.set =
      static_cast<std::size_t>(std::max(numberOf(t, "texCoord", static_cast<double>(uv.set)), 0.0));
}

}  // namespace

GltfTexture readGltfTexture(const GltfDocument& document, const std::string& where, int index,
                            int texCoord, const tinygltf::ExtensionMap& extensions) {
  GltfTexture result;
  if (index < 0) return result;
  const tinygltf::Texture& texture = document.model().textures[static_cast<std::size_t>(index)];
  if (texture.source < 0) {
    document.warnings().add("texture in a format that is not supported left out", where);
    return result;
  }
  result.image = texture.source;
  if (texture.sampler >= 0) {
    const tinygltf::Sampler& sampler =
        document.model().samplers[static_cast<std::size_t>(texture.sampler)];
    result.wrapU = wrapOf(sampler.wrapS);
    result.wrapV = wrapOf(sampler.wrapT);
    if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) {
      document.warnings().add("texture to be looked up at its nearest texel, interpolated instead",
                              where);
    }
  }
  result.uv.set = static_cast<std::size_t>(std::max(texCoord, 0));
  if (const tinygltf::Value* t = findExtension(extensions, kTransform))
    readUvTransform(*t, result.uv);
  return result;
}

GltfTexture readGltfTexture(const GltfDocument& document, const std::string& where,
                            const tinygltf::Value& info) {
  tinygltf::ExtensionMap extensions;
  if (info.Has("extensions") && info.Get("extensions").Has(kTransform)) {
    extensions[kTransform] = info.Get("extensions").Get(kTransform);
  }
  return readGltfTexture(document, where, static_cast<int>(numberOf(info, "index", -1)),
                         static_cast<int>(numberOf(info, "texCoord", 0)), extensions);
}

}  // namespace whit
