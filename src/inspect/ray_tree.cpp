#include "inspect/ray_tree.h"

#include <algorithm>

#include "core/index.h"
#include "inspect/reference_frame.h"
#include "reference/add_impulses.h"
#include "reference/find_intersections.h"
#include "reference/update_image.h"
#include "render/embree_intersector.h"
#include "render/frame.h"

namespace whit {

namespace {

Vec3d at(const Columns3& columns, std::size_t i) { return Vec3d(columns.at(i)); }

// Writes the tree down while the pipeline traces its pixel alone.
class TreeObserver : public StageObserver {
 public:
  explicit TreeObserver(RayTree& tree) : tree_(tree) {}

  void after(Stage stage, const Chunk& chunk) override {
    switch (stage) {
      case Stage::generateRays:
        if (chunk.narrowings) forgetSample();
        levels_.assign(1, {append(0, RayKind::primary, 0)});
        tree_.primaries.push_back(levels_[0][0]);
        return;
      case Stage::findIntersections:
        for (const auto i : indices(chunk.n)) recordHit(chunk, i);
        shadows_.assign(chunk.n, {});
        return;
      case Stage::writeEmittedAndReflectiveAmbient:
        for (const auto i : indices(chunk.n)) {
          node(chunk, i).emitted = at(chunk.radiance.rgb, i);
          node(chunk, i).weight = at(chunk.rays.weight, i);  // fog has dimmed the ray
        }
        break;
      case Stage::checkShadows:
        for (const auto k : indices(chunk.shadowCount)) recordShadowRay(chunk, k);
        return;
      case Stage::addShading:
        for (const auto i : indices(chunk.n)) addLight(chunk, i);
        break;
      case Stage::addImpulses:
        follow(chunk);
        return;
      default:
        return;
    }

    // The remaining stages add to the radiance of the surfel itself.
    for (const auto i : indices(chunk.n)) node(chunk, i).local = at(chunk.radiance.rgb, i);
  }

 private:
  // The sample is traced again, as a narrower tree.
  void forgetSample() {
    tree_.nodes.resize(tree_.primaries.back());
    tree_.primaries.pop_back();
    tree_.narrowed = true;
  }

  std::size_t append(std::size_t parent, RayKind kind, int depth) {
    RayNode& fresh = tree_.nodes.emplace_back();
    const std::size_t number = tree_.nodes.size() - 1;
    fresh.kind = kind;
    fresh.depth = depth;
    fresh.parent = depth == 0 ? number : parent;
    return number;
  }

  std::size_t numberOf(const Chunk& chunk, std::size_t i) const {
    return entryOf(levels_, chunk.depth)[chunk.first + i];
  }
  RayNode& node(const Chunk& chunk, std::size_t i) { return tree_.nodes[numberOf(chunk, i)]; }

  void recordHit(const Chunk& chunk, std::size_t i) {
    RayNode& n = node(chunk, i);
    const Ray ray = rayOf(chunk, i);
    n.origin = ray.origin;
    n.direction = ray.direction;
    n.weight = at(chunk.rays.weight, i);
    n.media = reference::mediaOf(chunk, i);
    if (chunk.hits.triangle[i] == kMiss) return;

    const Candidate candidate = candidateOf(chunk, i);
    n.triangle = candidate.triangle;
    n.instance = candidate.instance;
    n.u = candidate.u;
    n.v = candidate.v;
    n.distance = double{chunk.hits.t[i]};
    n.material = chunk.surfels.material[i];
    n.position = at(chunk.surfels.pos, i);
    n.alsoCrossed = reference::alsoCrossedAt(chunk, i);
    n.hidden = reference::isHidden(chunk, i);
  }

  void recordShadowRay(const Chunk& chunk, std::size_t k) {
    const ShadowColumns& s = chunk.shadows;
    LightContribution& light = shadows_[s.slot[k]];

    light.traced = true;
    light.origin = at(s.org, k);
    light.toLight = at(s.dir, k);
    light.visible = chunk.unshadowed.visible[s.slot[k]] > 0;
  }

  void addLight(const Chunk& chunk, std::size_t i) {
    RayNode& n = node(chunk, i);
    LightContribution light = shadows_[i];
    shadows_[i] = {};

    // A light contributes what the radiance has gained since the previous stage.
    light.radiance = at(chunk.radiance.rgb, i) - n.local;
    if (!light.traced && light.radiance == RgbD()) return;

    light.light = chunk.lightNumber;
    light.sample = chunk.lightSample;
    n.lights.push_back(light);
  }

  void follow(const Chunk& chunk) {
    const std::size_t depth = chunk.depth;
    levels_.resize(depth + 2);
    levels_[depth + 1].clear();

    for (const auto s : indices(chunk.childSegmentCount)) {
      const Segment& segment = chunk.childSegments[s];
      for (std::size_t i = segment.begin; i < segment.end; ++i) {
        const std::size_t parent = numberOf(chunk, chunk.children.parent[i]);
        const std::size_t child = append(parent, segment.kind, chunk.depth + 1);
        tree_.nodes[parent].children.push_back(child);
        levels_[depth + 1].push_back(child);
      }
    }
  }

  RayTree& tree_;
  std::vector<std::vector<std::size_t>> levels_;  // a queue a depth
  std::vector<LightContribution> shadows_;  // contributions of the current light, one for each slot
};

// Writes the tree down while the reference follows its paths, one after the other.
class TreeIntersector : public EmbreeIntersector, public reference::PathObserver {
 public:
  TreeIntersector(const Accel& accel, RayTree& tree) : EmbreeIntersector(accel), tree_(tree) {}

  void beginSample() {
    current_ = tree_.nodes.size();
    tree_.primaries.push_back(current_);
    RayNode& fresh = tree_.nodes.emplace_back();
    fresh.parent = current_;
  }

  void endSample(const RgbD& radiance) { tree_.nodes[tree_.primaries.back()].radiance = radiance; }

  bool closest(const Ray& ray, Candidate& c) const override {
    RayNode& n = tree_.nodes[current_];
    n.origin = ray.origin;
    n.direction = ray.direction;
    return EmbreeIntersector::closest(ray, c);
  }

  void hit(const Candidate& c) const override {
    RayNode& n = tree_.nodes[current_];
    n.triangle = c.triangle;
    n.instance = c.instance;
    n.u = c.u;
    n.v = c.v;
  }

  bool occluded(const Ray& ray, double tFar) const override {
    LightContribution light;
    light.traced = true;
    light.origin = ray.origin;
    light.toLight = ray.direction;
    light.visible = !EmbreeIntersector::occluded(ray, tFar);

    tree_.nodes[current_].lights.push_back(light);
    return !light.visible;
  }

  void began(const reference::Impulse& impulse, RayKind kind) const override {
    const std::size_t number = tree_.nodes.size();
    RayNode fresh;
    fresh.kind = kind;
    fresh.parent = current_;
    fresh.depth = tree_.nodes[current_].depth + 1;
    fresh.weight = impulse.weight;
    fresh.media = impulse.media;

    tree_.nodes[current_].children.push_back(number);
    tree_.nodes.push_back(std::move(fresh));
    current_ = number;
  }

  void beganAgain() const override {
    current_ = tree_.primaries.back();
    tree_.nodes.resize(current_);
    tree_.nodes.emplace_back().parent = current_;
    tree_.narrowed = true;
  }

  void ended(const RgbD& radiance) const override {
    tree_.nodes[current_].radiance = radiance;
    current_ = tree_.nodes[current_].parent;
  }

 private:
  RayTree& tree_;
  mutable std::size_t current_ = 0;
};

// The order of these sums is the pipeline's (render/tile_tracer.h); products are rounded, too.
Rgb sumRadiance(RayTree& tree, std::size_t number) {
  Rgb sum(tree.nodes[number].local);
  for (const std::size_t child : tree.nodes[number].children) {
    const Rgb weight(tree.nodes[child].weight);
    sum += weight * sumRadiance(tree, child);
  }

  tree.nodes[number].radiance = RgbD(sum);
  return sum;
}

bool sends(const RayTree& tree, const RayNode& n, RayKind kind) {
  return std::ranges::any_of(n.children,
                             [&](std::size_t child) { return tree.nodes[child].kind == kind; });
}

// The impulses that the surface would have sent, according to the reference.
struct ReferenceImpulses {
  reference::Impulses impulses;
  reference::Crossing crossing;
  // The diffuse lobe sends samples on. All samples of a glossy lobe may end in the surface.
  bool scattered = false;

  bool has(RayKind kind) const {
    return maxComponent(impulses.of(kind).weight) > 0 || (kind == kDiffuseLobe.kind && scattered);
  }
  // No ray is refracted where the media would have one.
  bool isReflectedTotally(RayKind kind) const {
    return kind == RayKind::refraction && crossing.dielectric && !crossing.hidden;
  }
};
ReferenceImpulses referenceImpulses(const Scene& scene, const Plan& plan,
                                    const RenderOptions& options, const RayNode& n) {
  // The reference computes the surface again from the hit that the tree holds.
  const Ray ray{n.origin, n.direction};
  const Candidate candidate{n.triangle, n.instance, n.u, n.v};
  const TriangleHit hit = refineHit(scene, ray, candidate);
  const reference::Surfel surfel = reference::makeSurfel(scene, plan.effects, candidate, hit, ray);

  const reference::Crossing crossing = reference::crossMedia(
      scene, plan.effects, surfel.material, surfel.entering, n.media, n.alsoCrossed);
  const bool scattered = kDiffuseLobe.isSampled(scene.materials[surfel.material], plan.effects) &&
                         !crossing.hidden && maxComponent(surfel.diffuse * surfel.coverage) > 0;

  return {reference::findImpulses(scene, plan.effects, surfel, crossing, n.media, options.shading),
          crossing, scattered};
}

// The reason for which the surface does not send an impulse that it could send.
PathEnd endOf(const RenderOptions& options, const RayNode& n, bool narrowed) {
  if (n.depth >= options.depth) return PathEnd::depth;
  if (narrowed && !n.children.empty()) return PathEnd::limit;
  return options.roulette > 0 ? PathEnd::roulette : PathEnd::cutoff;
}

void explainEnds(const Renderer& renderer, RayTree& tree) {
  const RenderOptions& options = renderer.options();
  for (RayNode& n : tree.nodes) {
    if (n.triangle == kMiss) continue;

    const ReferenceImpulses sent = referenceImpulses(renderer.scene(), renderer.plan(), options, n);
    for (const RayKind kind : kImpulseKinds) {
      if (sends(tree, n, kind)) continue;
      if (sent.has(kind)) {
        n.endOf(kind) = endOf(options, n, tree.narrowed);
      } else if (sent.isReflectedTotally(kind)) {
        n.endOf(kind) = PathEnd::totalReflection;
      }
    }
  }
}

Film filmOfPixel(const Film& film, int x, int y) {
  Film one = film;
  one.image.window = {x, y, x + 1, y + 1};
  one.image.pixels.assign(1, Rgb());
  one.wantDisplay = false;
  return one;
}

void fillHits(const Scene& scene, RayTree& tree) {
  for (RayNode& n : tree.nodes) {
    if (n.triangle == kMiss) continue;

    const Ray ray{n.origin, n.direction};
    n.distance = refineHit(scene, ray, {n.triangle, n.instance, n.u, n.v}).t;
    n.position = n.origin + n.direction * n.distance;
    n.material = scene.triangles[n.triangle].material;
  }
}

}  // namespace

std::size_t RayTree::shadowRays() const {
  std::size_t traced = 0;
  for (const RayNode& n : nodes) {
    for (const LightContribution& light : n.lights) traced += light.traced;
  }
  return traced;
}

RayTree traceRayTree(Renderer& renderer, const Camera& camera, const Film& film, int x, int y) {
  RayTree tree;
  TreeObserver observer(tree);

  Film one = filmOfPixel(film, x, y);
  tree.samples = renderer.samplesOf(camera, one);
  StageObserver* const observers[] = {&observer};
  renderer.render(
      {.camera = camera, .film = one, .pattern = &tree.samples, .observers = observers});

  tree.pixel = one.image.pixels[0];
  for (const std::size_t primary : tree.primaries) sumRadiance(tree, primary);
  explainEnds(renderer, tree);
  return tree;
}

RayTree traceReferenceTree(Renderer& renderer, const Camera& camera, const Film& film, int x, int y,
                           const std::vector<Vec2f>& samples) {
  RayTree tree;
  tree.samples = samples;

  TreeIntersector intersector(renderer.accel(), tree);
  const reference::Tracer tracer(renderer.scene(), intersector, referenceSettings(renderer),
                                 intersector);
  CameraFrame frame = renderer.prepareView(camera, film);
  if (samples.size() == 1) frame.footprint = 1;  // adaptive sampling took the center alone

  reference::RayCounts counts;
  RgbD mean;
  for (const auto s : indices(samples)) {
    intersector.beginSample();
    const RgbD radiance = tracer.sampled(frame, x, y, samples[s], s, counts);
    intersector.endSample(radiance);
    reference::addSample(mean, radiance, static_cast<double>(s + 1));
  }

  tree.pixel = Rgb(mean);
  fillHits(renderer.scene(), tree);
  return tree;
}

RgbD weightAtEye(const RayTree& tree, std::size_t node) {
  RgbD weight = tree.nodes[node].weight;
  while (tree.nodes[node].parent != node) {
    node = tree.nodes[node].parent;
    weight = weight * tree.nodes[node].weight;
  }
  return weight;
}

std::vector<std::size_t> counterparts(const RayTree& a, const RayTree& b) {
  std::vector<std::size_t> found(a.nodes.size(), kNoCounterpart);

  // Primary rays correspond by the number of their sample.
  for (const auto s : indices(std::min(a.primaries.size(), b.primaries.size()))) {
    found[a.primaries[s]] = b.primaries[s];
  }

  // Children correspond by kind, in their order; parents come before their children.
  for (const auto i : indices(a.nodes)) {
    if (found[i] == kNoCounterpart) continue;

    std::vector<std::size_t> left = b.nodes[found[i]].children;
    for (const std::size_t child : a.nodes[i].children) {
      const auto same = std::ranges::find_if(
          left, [&](std::size_t other) { return b.nodes[other].kind == a.nodes[child].kind; });
      if (same == left.end()) continue;
      found[child] = *same;
      left.erase(same);
    }
  }

  return found;
}

bool hitsSameSurface(const RayNode& a, const RayNode& b) {
  return a.triangle == b.triangle && a.instance == b.instance;
}

bool seesSameLights(const RayNode& a, const RayNode& b) {
  const auto shadows = [](const RayNode& n) {
    std::vector<bool> seen;
    for (const LightContribution& light : n.lights) {
      if (light.traced) seen.push_back(light.visible);
    }
    return seen;
  };

  return shadows(a) == shadows(b);
}

bool agree(const RayNode& a, const RayNode& b) {
  return hitsSameSurface(a, b) && seesSameLights(a, b) && a.children.size() == b.children.size();
}

}  // namespace whit
