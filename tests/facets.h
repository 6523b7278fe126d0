// The lobe of GGX by brute force.
#pragma once

namespace whit::test {

// The share of even light that the lobe sends to the viewer, by the midpoint rule over the facets'
// distribution: Walter et al. 2007 for the facets, Heitz 2014 for the masking, Schlick 1994 with
// the reflectances f0 and f90.
double albedoByFacets(double f0, double f90, double roughness, double nv);

}  // namespace whit::test
