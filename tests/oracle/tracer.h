// The oracle: Whitted's recursion in double precision, written from the formulas and from
// scenes/README.md. It shares no code with what it judges.
#pragma once

#include <map>
#include <utility>

#include "oracle/geometry.h"
#include "oracle/media.h"
#include "oracle/mip_chain.h"
#include "oracle/random_parts.h"
#include "oracle/scene.h"
#include "oracle/sight.h"

namespace oracle {

struct Arrival;

class Tracer {
 public:
  // Both outlive the tracer.
  Tracer(const Scene& scene, const Options& options);

  // Through the image position (x, y), in pixels from the top left. All of a pixel are sampled
  // alike.
  Sight look(double x, double y) const;
  // Returns an unbiased estimate of the pixel's mean radiance: the ray goes through a random point
  // of the pixel and of the lens, and each integral on its path gets one sample.
  Color sample(int x, int y, Random& random) const;
  // What lies there.
  const Face* nearest(double x, double y) const;

 private:
  struct Surface;
  struct Impulse;
  // Where a ray is in the tree of them.
  struct Branch {
    int depth = 0;
    double weight = 1;     // of the pixel
    bool sampled = false;  // one of many of its kind
    bool drawn = false;    // of each integral one point
    double width = 0;      // of the cone about the ray, where it starts
    Media media;
  };

  static int pointsASide(const Branch& branch);
  Ray eyeRay(double x, double y) const;
  Ray throughLens(const Ray& ray, Random& random) const;
  Media mediaAround(const Vec& point) const;
  void pass(Media& media, const Ray& ray, const Hit& hit) const;
  Sight trace(const Ray& ray, const Branch& branch, Random& random) const;
  double pixelSize() const;  // one away from the eye, or everywhere if rays are parallel
  double widthAfter(double width, double way) const;
  static void addVertices(Surface& surface, const Hit& hit);
  Surface surfaceAt(const Ray& ray, const Hit& hit, double width) const;
  static Sight reflectedFrom(const Surface& surface, const Arrival& arrival);
  Sight lightFrom(const Surface& surface, const Branch& branch, Random& random) const;
  Sight lightFromSphere(const Surface& surface, const Light& light, const Branch& branch,
                        Random& random) const;
  bool lit(const Surface& surface, const Arrival& arrival) const;
  Sight ambientLight(const Surface& surface, const Branch& branch, Random& random) const;
  Sight indirectLight(const Surface& surface, const Branch& branch, Random& random) const;
  Color diffuseLeft(const Surface& surface, const Media& before, const Media& behind) const;
  Color aboveLobe(const Surface& surface, const Media& before, const Media& behind) const;
  bool samplesLobe(const Material& material) const;
  void findFrosting(Surface& surface, const Media& before, const Media& behind) const;
  double interfaceReflectance(double n1, double n2, double cosine) const;
  Color facetReflectance(const Surface& surface, double vh) const;
  Sight frostedTransmission(const Surface& surface, const Branch& branch, const Media& behind,
                            Random& random) const;
  Sight lobeWeight(const Surface& surface, const Branch& branch, Random& random) const;
  Sight impulses(const Surface& surface, const Branch& branch, const Media& behind,
                 Random& random) const;
  Sight follow(const Surface& surface, const Branch& branch, const Impulse& impulse,
               Random& random) const;
  Sight glossyReflection(const Surface& surface, const Branch& branch, Random& random) const;

  const Scene scene_;  // at its time
  const Options& options_;
  std::vector<MipChain> textures_;  // as masks cut: at full size
  // As materials show them: by the number of the material and of the map in kMaps.
  std::map<std::pair<std::size_t, std::size_t>, MipChain> shown_;
  Geometry geometry_;
};

}  // namespace oracle
