// Where the bytes of a glTF file lie, and what images, cameras and lights are made of.
#include <algorithm>
#include <string>

#include "io/gltf/elements.h"
#include "io/gltf/uses.h"
#include "io/uri.h"

namespace whit {
namespace {

class LayoutChecker {
 public:
  LayoutChecker(const GltfText& text, GltfUses& uses)
      : text_(text), views_(text.list("bufferViews")), uses_(uses) {}

  void check() {
    forAll("buffers", &LayoutChecker::lookAtBuffer);
    forAll("bufferViews", &LayoutChecker::lookAtView);
    forAll("accessors", &LayoutChecker::lookAtAccessor);
    forAll("images", &LayoutChecker::lookAtImage);
    forAll("textures", &LayoutChecker::lookAtTexture);
    forAll("cameras", &LayoutChecker::lookAtCamera);
    lookAtLights();
  }

 private:
  void forAll(const char* list, void (LayoutChecker::*look)(const LooseJson&, const std::string&)) {
    const LooseJson all = text_.list(list);
    for (std::size_t i = 0; i < all.size(); ++i) (this->*look)(all.at(i), pointerTo(list, i));
  }

  void lookAtBuffer(const LooseJson& buffer, const std::string& pointer) {
    const std::string uri(buffer["uri"].text());
    if (!isDataUri(uri)) return;
    const std::string type = uri.substr(5, uri.find_first_of(";,") - 5);
    if (type == "application/octet-stream" || type == "application/gltf-buffer") return;
    text_.fault("a buffer of another media type than there is for buffers", pointer + "/uri");
  }

  void lookAtView(const LooseJson& view, const std::string& pointer) {
    const LooseJson buffers = text_.list("buffers");
    const LooseJson buffer = buffers.at(view["buffer"].wholeOr(buffers.size()));
    const std::uint64_t length = view["byteLength"].wholeOr(0);
    if (view["byteOffset"].wholeOr(0) + length > buffer["byteLength"].wholeOr(0)) {
      text_.fault("a buffer view that reaches beyond its buffer", pointer);
    }
    constexpr std::uint64_t kIndexTarget = 34963;
    if (!view["byteStride"].exists()) return;
    if (view["byteStride"].wholeOr(0) > length) {
      text_.fault("a stride that is longer than its buffer view", pointer);
    }
    if (view["target"].wholeOr(0) == kIndexTarget) {
      text_.fault("a stride of what is no data of vertices", pointer);
    }
  }

  void lookAtAccessor(const LooseJson& accessor, const std::string& pointer) {
    const std::size_t components = gltfComponents(accessor["type"].text());
    const std::uint64_t type = accessor["componentType"].wholeOr(0);
    if (accessor["normalized"].flag() && gltfBytesOf(type) == 4) {
      text_.fault("an accessor of this type cannot be normalized", pointer);
    }
    for (const char* bound : {"min", "max"}) {
      if (accessor[bound].isList() && accessor[bound].size() != components) {
        text_.fault("a list of another length than it has to be", pointer + "/" + bound);
      }
    }
    lookAtPlace(accessor, gltfBytesOf(type), components, pointer);
  }

  void lookAtPlace(const LooseJson& accessor, std::size_t size, std::size_t components,
                   const std::string& pointer) {
    const std::optional<std::size_t> index = accessor["bufferView"].index(views_.size());
    if (!index && accessor["byteOffset"].exists()) {
      text_.fault("a property that needs another one", pointer + "/byteOffset");
    }
    if (!index || size == 0 || components == 0) return;
    const LooseJson view = views_.at(*index);
    const std::uint64_t offset = accessor["byteOffset"].wholeOr(0), bytes = size * components;
    if ((offset + view["byteOffset"].wholeOr(0)) % size != 0 || offset % size != 0) {
      text_.fault("an offset that is no multiple of the components' size", pointer);
    }
    const std::uint64_t stride = view["byteStride"].wholeOr(bytes);
    if (stride < bytes) text_.fault("a stride that is shorter than an element", pointer);
    const std::uint64_t count = accessor["count"].wholeOr(0);
    const std::uint64_t length = view["byteLength"].wholeOr(0);
    const bool fits = offset <= length && bytes <= length - offset;
    if (count > 0 && (!fits || count - 1 > (length - offset - bytes) / std::max(stride, bytes))) {
      text_.fault("an accessor that reaches beyond its buffer view", pointer);
    }
  }

  void lookAtImage(const LooseJson& image, const std::string& pointer) {
    const std::optional<std::size_t> view = image["bufferView"].index(views_.size());
    if (image["bufferView"].exists() == image["uri"].exists()) {
      text_.fault("exactly one of two properties has to be there", pointer);
    }
    if (!view) return;
    if (!image["mimeType"].exists()) text_.fault("a property that needs another one", pointer);
    uses_.useView(*view, GltfUse::image, pointer);
    if (views_.at(*view)["byteStride"].exists()) {
      text_.fault("a stride of what is no data of vertices", pointer);
    }
    const std::string_view type = image["mimeType"].text(), found = typeOfData(views_.at(*view));
    if (!type.empty() && !found.empty() && type != found) {
      text_.fault("an image of another media type than its data has", pointer);
    }
  }

  // Empty: neither of the two that the specification has.
  std::string_view typeOfData(const LooseJson& view) const {
    const std::optional<std::size_t> buffer = view["buffer"].index(text_.buffers.size());
    const std::uint64_t offset = view["byteOffset"].wholeOr(0);
    if (!buffer || offset > text_.buffers[*buffer].size()) return "";
    const std::string_view data = std::string_view(text_.buffers[*buffer]).substr(offset);
    if (data.starts_with("\x89PNG")) return "image/png";
    return data.starts_with("\xff\xd8\xff") ? "image/jpeg" : "";
  }

  void lookAtTexture(const LooseJson& texture, const std::string& pointer) {
    const LooseJson images = text_.list("images");
    const LooseJson image = images.at(texture["source"].wholeOr(images.size()));
    const std::string_view type = image["mimeType"].text();
    if (type.empty() || type == "image/png" || type == "image/jpeg") return;
    text_.fault("a texture of an image that is neither PNG nor JPEG", pointer + "/source");
  }

  void lookAtCamera(const LooseJson& camera, const std::string& pointer) {
    if (camera["perspective"].exists() == camera["orthographic"].exists()) {
      text_.fault("exactly one of two properties has to be there", pointer);
    }
    for (const char* kind : {"perspective", "orthographic"}) {
      const std::optional<double> near = camera[kind]["znear"].number();
      const std::optional<double> far = camera[kind]["zfar"].number();
      if (near && far && *far <= *near) text_.fault("a camera with zfar before znear", pointer);
    }
    for (const char* size : {"xmag", "ymag"}) {
      if (camera["orthographic"][size].number() == 0.0) {
        text_.fault("a camera that shows nothing", pointer);
      }
    }
  }

  void lookAtLights() {
    const LooseJson lights = LooseJson(text_.root)["extensions"]["KHR_lights_punctual"]["lights"];
    for (std::size_t i = 0; i < lights.size(); ++i) {
      if (lights.at(i)["type"].text() != "spot") continue;
      const std::string pointer = pointerTo("extensions/KHR_lights_punctual/lights", i);
      const LooseJson spot = lights.at(i)["spot"];
      if (!spot.exists()) text_.fault("a required property is missing", pointer);
      constexpr double kDefaultOuter = 0.7853981633974483;
      const double inner = spot["innerConeAngle"].number().value_or(0);
      const double outer = spot["outerConeAngle"].number().value_or(kDefaultOuter);
      if (outer <= inner) text_.fault("a spot light's cones that are not one in another", pointer);
    }
  }

  const GltfText& text_;
  LooseJson views_;
  GltfUses& uses_;
};

}  // namespace

void countLayoutFaults(const GltfText& text, GltfUses& uses) { LayoutChecker(text, uses).check(); }

}  // namespace whit
