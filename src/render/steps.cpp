#include "render/steps.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "accel/accel.h"
#include "bake/sphere.h"
#include "core/error.h"
#include "core/image.h"
#include "core/index.h"
#include "core/text.h"
#include "render/embree_intersector.h"
#include "render/renderer.h"
#include "sampling/ray_limit.h"
#include "simd/kernels.h"
#include "surfaces/channel_values.h"
#include "surfaces/choose_surface.h"
#include "surfaces/initial_media.h"

namespace whit {

namespace {

// True if this chunk belongs to the sample whose channels are stored.
bool isKept(const Chunk& c) {
  const ChannelTarget& target = c.frame->channels;
  return target.layers && target.sample == c.sampleNumber;
}

// keep(slot, pixel of the layers) for the slots of a chunk of depth 0 whose pixels are in the
// window. Samples that are given up keep nothing.
template <typename Keep>
void forEachKept(const Chunk& c, Keep&& keep) {
  const Crop& w = c.frame->channels.window;
  const int width = w.x1 - w.x0;
  for (const auto i : indices(c.n)) {
    if (c.isGivenUp(c.first + i)) continue;
    const std::uint32_t pixel = c.pixels[c.first + i];
    const int x = pixelX(pixel), y = pixelY(pixel);
    if (!w.contains(x, y)) continue;
    keep(i, cellAt(x - w.x0, y - w.y0, width));
  }
}

float largestWeight(const RayColumns& rays, std::size_t i) {
  return maxComponent(rays.weight.at(i));
}

void moveRow(RayColumns rays, std::size_t from, std::size_t to) {
  RayColumns::forEachColumn(rays, [&](const char*, auto* column, Feature) {
    if (column) column[to] = column[from];
  });
}

// Keeps the children for which keeps(child) is true, in their order.
template <typename Keeps>
void keepChildren(Chunk& c, const Keeps& keeps) {
  std::size_t kept = 0, segments = 0;
  for (const auto s : indices(c.childSegmentCount)) {
    const Segment all = c.childSegments[s];
    const std::size_t first = kept;
    for (std::size_t i = all.begin; i < all.end; ++i) {
      if (!keeps(i)) continue;
      moveRow(c.children, i, kept);
      c.childPixelSlots[kept] = c.childPixelSlots[i];
      if (c.narrowings) c.childNarrowings[kept] = c.childNarrowings[i];
      ++kept;
    }
    if (kept > first) c.childSegments[segments++] = {all.kind, first, kept};
  }
  c.childCount = kept;
  c.childSegmentCount = segments;
}

// The child counts for all of its surface's, as the one that was chosen.
void standForAll(const Chunk& c, std::size_t child, const Narrowing& of) {
  const double grows = of.weights / double{largestWeight(c.children, child)};
  for (float* weight : {c.children.weight.x, c.children.weight.y, c.children.weight.z}) {
    weight[child] = static_cast<float>(double{weight[child]} * grows);
  }
  const double before = double{c.rays.throughput[c.children.parent[child]]};
  c.children.throughput[child] = static_cast<float>(before * of.weights);
}

void narrowTrees(Chunk& c) {
  const std::uint64_t widest = widestTree(c.options().maxRays, c.options().depth);
  const std::uint32_t* const parents = c.children.parent;
  for (const auto i : indices(c.childCount)) {
    Narrowing& parent = c.narrowings[parents[i]];
    ++parent.children;
    parent.weights += double{largestWeight(c.children, i)};
  }

  keepChildren(c, [&](std::size_t i) {
    Narrowing& parent = c.narrowings[parents[i]];
    const bool all = parent.width * parent.children <= widest;
    c.childNarrowings[i] = {parent.width * (all ? parent.children : 1)};
    if (all) return true;

    // Each child has its share of the line from 0 to the sum of the weights.
    const double drawn = choiceDraw(c.rays.path[parents[i]]) * parent.weights;
    const double begin = parent.passed;
    parent.passed += double{largestWeight(c.children, i)};
    if (drawn < begin || drawn >= parent.passed) return false;
    standForAll(c, i, parent);
    return true;
  });
}

ChannelValues valuesOf(const Chunk& c, std::size_t i) {
  ChannelValues values;
  const SurfelColumns& s = c.surfels;
  if (s.material[i] == kMiss) return values;
  const Scene& scene = *c.frame->scene;
  const Vec3f forward(c.frame->camera.forward);
  values.distance = c.hits.t[i];
  values.z = values.distance * dot(c.rays.dir.at(i), forward);
  const Vec3d position(s.pos.at(i));
  values.position = Vec3f(scene.inFile(position));
  values.normal = s.ns.at(i);
  values.albedo = s.diffuse.at(i);
  values.material = s.material[i];

  RgbD specular;
  double alpha = 0;
  if (c.has(Feature::glossy)) {
    specular = RgbD(s.specular.at(i));
    alpha = s.alpha[i];
  }
  keepFinish(scene.materials[values.material], specular, alpha, values);

  // These take longer than to read columns.
  const ChannelSet kept = c.frame->channels.layers->channels();
  const std::uint32_t triangle = c.hits.triangle[i];
  const std::uint32_t instance = c.has(Feature::instances) ? c.hits.instance[i] : kNoInstance;
  if (kept.has(Channel::motion) && c.frame->channels.earlier) {
    const Candidate hit{triangle, instance, double{c.hits.u[i]}, double{c.hits.v[i]}};
    values.motion = motionOf(scene, *c.frame->channels.earlier, c.frame->camera, hit, position);
  }
  if (kept.has(Channel::uv)) {
    values.uv = uvAt(scene, triangle, double{c.hits.u[i]}, double{c.hits.v[i]});
  }
  if (kept.has(Channel::object) || kept.has(Channel::triangle)) {
    const Scene::HitNumbers numbers = scene.numbersOf(triangle, instance);
    values.object = numbers.item;
    values.triangle = numbers.triangle;
  }
  return values;
}

void setSurface(const Candidate& chosen, std::size_t i, Chunk& c) {
  c.hits.triangle[i] = chosen.triangle;
  if (c.has(Feature::instances)) c.hits.instance[i] = chosen.instance;
  c.hits.u[i] = static_cast<float>(chosen.u);
  c.hits.v[i] = static_cast<float>(chosen.v);
}

Box boundsWithin(const Scene& scene, const Geometry& geometry) {
  Box box;
  for (const auto i : indices(geometry.index)) {
    const TriangleRecord& triangle = scene.triangles[geometry.firstTriangle + i];
    if (scene.mediumOfMaterial[triangle.material] == 0) continue;
    for (int k = 0; k < 9; k += 3) {
      box.add({triangle.position[k], triangle.position[k + 1], triangle.position[k + 2]});
    }
  }
  for (std::uint32_t i = 0; i < geometry.spheres; ++i) {
    const TriangleRecord& sphere = scene.triangles[geometry.firstSphere + i];
    if (scene.mediumOfMaterial[sphere.material] == 0) continue;
    const Box own = sphereBounds(sphereMap(sphere));
    box.add(own.lower);
    box.add(own.upper);
  }
  return box;
}

}  // namespace

void encodeForDisplay(Chunk& c) {
  const RenderOptions& o = c.options();
  simd::encodeDisplay({std::exp2(o.exposure.ev), o.toneCurve, c.radiance, c.n, c.codes});
}

void updateImage(Chunk& c) {
  Film& film = *c.film;
  if (film.wantDisplay) encodeForDisplay(c);

  // Locals: what memory may alias would be read again for every pixel.
  const int left = film.image.window.x0, top = film.image.window.y0;
  const int width = film.image.windowWidth();
  const Columns3 radiance = c.radiance.rgb;
  const std::uint32_t* const pixels = c.pixels.data();
  const std::uint32_t* const codes = film.wantDisplay ? c.codes : nullptr;
  auto* const display = reinterpret_cast<std::uint32_t*>(film.display.rgba.data());
  Rgb* const image = film.image.pixels.data();
  const std::size_t n = c.n;

  const auto placeOf = [&](std::uint32_t pixel) {
    return cellAt(pixelX(pixel) - left, pixelY(pixel) - top, width);
  };

  // The film is larger than the caches: its lines are asked for before they are written.
  constexpr std::size_t kAhead = 64;
  for (const auto i : indices(n)) {
    const std::size_t next = placeOf(pixels[std::min(i + kAhead, n - 1)]);
    __builtin_prefetch(image + next, 1);

    const std::size_t place = placeOf(pixels[i]);
    image[place] = radiance.at(i);
    if (codes) {
      __builtin_prefetch(display + next, 1);
      display[place] = codes[i];
    }
  }
}

std::uint64_t countNonFinite(const Chunk& c) {
  const auto [r, g, b] = c.radiance.rgb;
  std::uint64_t count = 0;
  // The sum is finite only if its terms are, or cancel; infinities of one sign do not.
  for (const auto i : indices(c.n)) count += !std::isfinite(r[i] + g[i] + b[i]);
  return count;
}

// Makes the last component of the channel the mean over the samples so far of valueAt(slot).
template <typename ValueAt>
void addToMean(const Chunk& c, Channel channel, const ValueAt& valueAt) {
  const std::span<float> means = c.frame->channels.layers->floats(channel);
  const std::size_t components = infoOf(channel).components;
  forEachKept(c, [&](std::size_t slot, std::size_t pixel) {
    float& mean = means[(pixel + 1) * components - 1];
    const float value = valueAt(slot), before = c.sampleNumber == 0 ? value : mean;
    mean = before + (value - before) / static_cast<float>(c.sampleNumber + 1);
  });
}

void keepChannels(Chunk& c) {
  // Samples that are traced again have the same first hits.
  if (c.depth > 0 || !c.frame->channels.layers || c.narrowings) return;
  if (!isKept(c)) return;
  forEachKept(c, [&](std::size_t slot, std::size_t pixel) {
    c.frame->channels.layers->keep(pixel, valuesOf(c, slot));
  });
}

void limitRays(Chunk& c) {
  for (const auto i : indices(c.childCount)) {
    c.childPixelSlots[i] = c.pixelSlots[c.children.parent[i]];
  }
  if (c.narrowings) {
    narrowTrees(c);
    return;
  }

  const auto most = static_cast<unsigned>(c.options().maxRays);
  bool tooMany = false;
  for (const auto i : indices(c.childCount)) {
    tooMany |= ++c.followed[c.childPixelSlots[i]] > most;
  }
  if (tooMany) keepChildren(c, [&](std::size_t i) { return !c.isGivenUp(c.childPixelSlots[i]); });
}

void countRays(Chunk& c) { std::fill_n(c.rayCounts, c.n, 1u); }

void countShadowRays(Chunk& c) {
  for (const auto i : indices(c.shadowCount)) ++c.rayCounts[c.shadows.slot[i]];
}

void returnRayCounts(Chunk& c) {
  for (const auto i : indices(c.n)) c.parentRayCounts[c.rays.parent[i]] += c.rayCounts[i];
}

void keepRayCounts(Chunk& c) {
  if (!isKept(c)) return;
  const std::span<std::uint32_t> rays = c.frame->channels.layers->numbers(Channel::rays);
  forEachKept(c, [&](std::size_t slot, std::size_t pixel) { rays[pixel] = c.rayCounts[slot]; });
}

void startEnds(Chunk& c) { std::fill_n(c.radiance.ended, c.n, 0.0f); }

void returnEnds(Chunk& c) {
  for (const auto i : indices(c.n)) {
    c.parentRadiance.ended[c.rays.parent[i]] += largestWeight(c.rays, i) * c.radiance.ended[i];
  }
}

void keepEnds(Chunk& c) {
  if (!c.frame->channels.layers) return;
  addToMean(c, Channel::error,
            [&](std::size_t slot) { return largestWeight(c.rays, slot) * c.radiance.ended[slot]; });
}

void startAlpha(Chunk& c) {
  const RadianceColumns& radiance = c.radiance;
  const bool hidesSky = c.options().background.hidesSky();
  for (const auto i : indices(c.n)) {
    const bool isClear = c.surfels.material[i] == kMiss && c.isStraight(i);
    radiance.clear.set(i, Rgb(isClear ? 1.0f : 0.0f));
    if (isClear && hidesSky) radiance.rgb.set(i, Rgb());
  }
}

void markStraight(Chunk& c) {
  const RayColumns &rays = c.rays, &children = c.children;
  for (const auto i : indices(c.childCount)) {
    const std::uint32_t parent = children.parent[i];
    const bool goesOn = children.dir.at(i) == rays.dir.at(parent);
    children.straight[i] = goesOn && c.isStraight(parent) ? 1 : 0;
  }
}

void returnAlpha(Chunk& c) {
  const RadianceColumns &from = c.radiance, &to = c.parentRadiance;
  for (const auto i : indices(c.n)) {
    const std::uint32_t parent = c.rays.parent[i];
    to.clear.set(parent, to.clear.at(parent) + c.rays.weight.at(i) * from.clear.at(i));
  }
}

void keepAlpha(Chunk& c) {
  if (!c.frame->channels.layers) return;
  addToMean(c, Channel::alpha, [&](std::size_t slot) {
    const auto [r, g, b] = c.rays.weight.at(slot) * c.radiance.clear.at(slot);
    // Grays keep their bits.
    return 1 - (r + ((g - r) + (b - r)) / 3);
  });
}

void chooseCoplanar(Chunk& c) {
  const Scene& scene = *c.frame->scene;
  std::fill_n(c.hits.alsoCrossed, c.n, 0u);
  for (const auto i : indices(c.n)) {
    if (!scene.coplanar.any(c.hits.triangle[i])) continue;
    const ChosenSurface chosen =
        chooseSurface(scene, c.frame->effects, rayOf(c, i), candidateOf(c, i));
    if (!chosen.hit) continue;
    setSurface(chosen.candidate, i, c);
    c.hits.t[i] = static_cast<float>(chosen.hit->t);
    c.hits.alsoCrossed[i] = chosen.alsoCrossed;
  }
}

void chooseSpheres(Chunk& c) {
  for (const auto i : indices(c.n)) {
    const Candidate found = candidateOf(c, i);
    const Candidate best = chooseSphere(*c.frame->scene, c.frame->effects, found);
    if (best.triangle != found.triangle || best.instance != found.instance) setSurface(best, i, c);
  }
}

Box dielectricBounds(const Scene& scene) {
  std::vector<Box> boxes;
  for (const Geometry& geometry : scene.geometries) boxes.push_back(boundsWithin(scene, geometry));
  Box all = boxes.empty() ? Box() : boxes[0];
  for (const InstanceRecord& instance : scene.instances) {
    const Box& own = boxes[instance.geometry];
    for (int i = 0; i < 8 && !own.empty(); ++i) {
      all.add(Vec3f(instance.toWorld.point(Vec3d(own.corner(i)))));
    }
  }
  return all;
}

bool startsMayLieInside(const CameraFrame& camera, const Box& dielectrics) {
  if (dielectrics.empty()) return false;
  const Vec3d lower = Vec3d(dielectrics.lower), upper = Vec3d(dielectrics.upper);
  double nearest = kInfinity, farthest = -nearest;
  for (int i = 0; i < 8; ++i) {
    const double ahead = dot(Vec3d(dielectrics.corner(i)) - camera.eye, camera.forward);
    nearest = std::min(nearest, ahead);
    farthest = std::max(farthest, ahead);
  }
  if (nearest > camera.turning || farthest < -camera.turning) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (camera.eye[axis] + camera.reach[axis] < lower[axis]) return false;
    if (camera.eye[axis] - camera.reach[axis] > upper[axis]) return false;
  }
  return true;
}

void findInitialMedia(Chunk& c) {
  if (!c.frame->camera.mediaVary) return;
  const EmbreeIntersector intersector(*c.frame->accel);
  for (const auto i : indices(c.n)) {
    c.rays.media[i] =
        mediaAtStart(*c.frame->scene, c.frame->effects, intersector, c.frame->camera, rayOf(c, i));
  }
}

}  // namespace whit
