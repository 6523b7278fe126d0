#include "bake/scene_order.h"

#include <algorithm>

#include "bake/scene.h"

namespace whit {

WrittenPlace SceneOrder::placeOf(const Scene& scene, PlacedTriangleId id) const {
  const std::uint32_t number = triangles[id.triangle];
  const auto meshOf = [&](std::uint32_t geometry) {
    const std::vector<PlacedMesh>& all = meshes[geometry];
    const auto startsBehind = [](std::uint32_t n, const PlacedMesh& m) {
      return n < m.firstTriangle;
    };
    return *(std::upper_bound(all.begin(), all.end(), number, startsBehind) - 1);
  };
  if (id.instance == kNoInstance) {
    const PlacedMesh mesh = meshOf(0);
    return {mesh.rank, mesh.instance, number};
  }
  const InstanceRecord& instance = scene.instances[id.instance];
  return {instances[instance.written] + meshOf(instance.geometry).rank, instance.written, number};
}

}  // namespace whit
