#include "io/gltf/faults.h"

#include "io/gltf/elements.h"
#include "io/gltf/uses.h"

namespace whit {

void countGltfFaults(const GltfText& text) {
  const GltfElements elements(text);
  GltfUses uses(text);
  countPropertyFaults(text);
  countExtensionFaults(text);
  countLayoutFaults(text, uses);
  countNodeFaults(text);
  countMeshFaults(text, elements, uses);
  countSkinFaults(text, elements, uses);
  countAnimationFaults(text, elements, uses);
  countValueFaults(text, elements);
}

}  // namespace whit
