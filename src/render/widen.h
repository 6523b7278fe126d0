// Single slots of the float columns as the reference's double structures.
#pragma once

#include "reference/intersector.h"
#include "reference/surfel.h"
#include "stages/columns.h"

namespace whit {

template <typename Columns>
Vec3d originOf(const Columns& c, std::size_t i) {
  return {c.orgX[i], c.orgY[i], c.orgZ[i]};
}
template <typename Columns>
Vec3d directionOf(const Columns& c, std::size_t i) {
  return {c.dirX[i], c.dirY[i], c.dirZ[i]};
}
inline RgbD radianceOf(const RadianceColumns& c, std::size_t i) { return {c.r[i], c.g[i], c.b[i]}; }

inline reference::Candidate candidateOf(const HitColumns& c, std::size_t i) {
  reference::Candidate candidate;
  candidate.triangle = c.triangle[i];
  candidate.instance = c.instance ? c.instance[i] : reference::kNoHit;
  candidate.u = static_cast<double>(c.u[i]);
  candidate.v = static_cast<double>(c.v[i]);
  return candidate;
}

// `direction` is that of the ray which found the surfel.
inline reference::Surfel widenSurfel(const SurfelColumns& c, const Vec3d& direction,
                                     std::size_t i) {
  reference::Surfel s;
  s.position = {c.posX[i], c.posY[i], c.posZ[i]};
  s.view = -direction;
  s.geometricNormal = {c.ngX[i], c.ngY[i], c.ngZ[i]};
  s.shadingNormal = {c.nsX[i], c.nsY[i], c.nsZ[i]};
  s.offset = static_cast<double>(c.offset[i]);
  s.entering = c.flags && (c.flags[i] & kEntering) != 0;
  s.material = c.material[i];
  s.diffuse = {c.diffuseR[i], c.diffuseG[i], c.diffuseB[i]};
  if (c.emissionR) s.emission = {c.emissionR[i], c.emissionG[i], c.emissionB[i]};
  if (c.cone) s.cone.width = static_cast<double>(c.cone[i]);
  if (c.liftX) s.lift = {c.liftX[i], c.liftY[i], c.liftZ[i]};
  if (c.specularR) {
    s.specular = {c.specularR[i], c.specularG[i], c.specularB[i]};
    s.alpha = static_cast<double>(c.alpha[i]);
  }
  return s;
}

}  // namespace whit
