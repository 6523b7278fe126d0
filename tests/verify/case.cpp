#include "verify/case.h"

#include "core/text.h"
#include "simd/kernels.h"

namespace whit::verify {

const std::vector<Family>& families() {
  static const std::vector<Family> all{
      kLeavingSurfaceCases,     kThinPlaceCases,    kWatertightnessCases, kOddDirectionCases,
      kDegenerateGeometryCases, kRandomSceneCases,  kShadingNormalCases,  kRefractionCases,
      kNestedDielectricCases,   kRangeCases,        kInvarianceCases,     kRecursionCases,
      kLightAndFilmCases,       kCoplanarFaceCases, kSphereCases,         kSpherePathCases};
  return all;
}

std::vector<Setup> setupsOf(Runs runs) {
  if (runs == Runs::once) return {Setup{}};

  std::vector<Setup> setups;
  for (const std::string& target : simd::availableTargets()) {
    const bool anyPacket = runs == Runs::targets;
    for (const int packet : anyPacket ? std::vector{0} : std::vector{1, 4, 8, 16}) {
      setups.push_back({target, packet});
    }
  }

  return setups;
}

Finding runCase(const Case& c, const Setup& setup) {
  simd::chooseTarget(setup.simd);
  Run run(setup);
  c.run(run);
  simd::chooseTarget("auto");
  return run;
}

std::string textOf(double value) { return formatted("%a", value); }

}  // namespace whit::verify
