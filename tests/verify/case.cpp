#include "verify/case.h"

#include <algorithm>

#include "core/text.h"
#include "simd/kernels.h"

namespace whit::verify {

void Finding::merge(const Finding& other) {
  seen_ += other.seen_;
  if (worst_ == 0) input_ = other.input_;
  worst_ += other.worst_;
}

int Case::number() const {
  int n = 0;
  for (const char c : name) {
    if (c >= '0' && c <= '9') n = 10 * n + (c - '0');
  }
  return n;
}

std::vector<Family> families() {
  return {{"leaving a surface", leavingSurfaceCases()},
          {"gaps and contacts", thinPlaceCases()},
          {"watertightness", watertightnessCases()},
          {"odd directions", oddDirectionCases()},
          {"degenerate geometry", degenerateGeometryCases()},
          {"random scenes", randomSceneCases()},
          {"shading normals", shadingNormalCases()},
          {"refraction", refractionCases()},
          {"nested dielectrics", nestedDielectricCases()},
          {"vectors and ranges", rangeCases()},
          {"exact laws", invarianceCases()},
          {"recursion", recursionCases()},
          {"lights, textures, film, camera", lightAndFilmCases()},
          {"coplanar faces", coplanarFaceCases()},
          {"exact spheres", sphereCases()},
          {"paths through spheres", spherePathCases()}};
}

std::vector<Setup> setupsOf(Runs runs) {
  if (runs == Runs::once) return {Setup{}};

  std::vector<Setup> setups;
  for (const std::string& target : simd::availableTargets()) {
    if (runs == Runs::targets) {
      setups.push_back({target, 0});
      continue;
    }
    for (const int packet : {1, 4, 8, 16}) setups.push_back({target, packet});
  }

  return setups;
}

Finding runCase(const Case& c, const Setup& setup) {
  simd::chooseTarget(setup.simd);
  Finding finding = c.run(setup);
  simd::chooseTarget("auto");
  return finding;
}

std::string hexText(double value) { return formatted("%a", value); }

std::string hexText(const Vec3f& v) {
  return hexText(double{v.x}) + " " + hexText(double{v.y}) + " " + hexText(double{v.z});
}

std::string hexText(const Vec3f& origin, const Vec3f& direction) {
  return "from " + hexText(origin) + " along " + hexText(direction);
}

}  // namespace whit::verify
