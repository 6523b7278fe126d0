#include "io/gltf/uses.h"

namespace whit {
namespace {

constexpr std::uint64_t kVertexTarget = 34962, kIndexTarget = 34963;

// Views are told apart less finely: animations may mix theirs.
GltfUse useOfView(GltfUse use) { return use == GltfUse::times ? GltfUse::keys : use; }

}  // namespace

GltfUses::GltfUses(const GltfText& text)
    : text_(text),
      accessors_(text.list("accessors").size()),
      views_(text.list("bufferViews").size()),
      sharers_(views_.size()) {
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const std::uint64_t target = text.list("bufferViews").at(i)["target"].wholeOr(0);
    if (target == kVertexTarget) views_[i] = GltfUse::vertices;
    if (target == kIndexTarget) views_[i] = GltfUse::indices;
  }
}

void GltfUses::useAccessor(std::size_t accessor, GltfUse use, const std::string& pointer) {
  const LooseJson source = text_.list("accessors").at(accessor);
  const std::optional<std::size_t> view = source["bufferView"].index(views_.size());
  std::optional<GltfUse>& known = accessors_[accessor];
  if (!known && view && use == GltfUse::vertices) ++sharers_[*view];
  if (known && *known != use) text_.fault("an accessor used as two things", pointer);
  if (!known) known = use;
  if (!view) return;
  useView(*view, use, pointer);
  const bool strided = text_.list("bufferViews").at(*view)["byteStride"].exists();
  if (strided && use != GltfUse::vertices) {
    text_.fault("a stride of what is no data of vertices", pointer);
  }
}

void GltfUses::useView(std::size_t view, GltfUse use, const std::string& pointer) {
  std::optional<GltfUse>& known = views_[view];
  if (known && *known != useOfView(use)) text_.fault("a buffer view used as two things", pointer);
  if (!known) known = useOfView(use);
}

}  // namespace whit
