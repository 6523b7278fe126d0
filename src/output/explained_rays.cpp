#include "output/explained_rays.h"

#include <algorithm>
#include <cstdlib>

#include "core/index.h"
#include "output/json_report.h"
#include "reference/media.h"

namespace whit {

namespace {

std::string nameOf(const std::string& name, const char* kind, std::size_t number) {
  if (!name.empty()) return printable(name);
  return concat(kind, " ", number);
}

std::string hitText(const Scene& scene, const RayNode& node) {
  if (node.triangle == kMiss) return "leaves the scene";
  return formatted("%s, %.6g away%s", materialName(scene, node.material).c_str(), node.distance,
                   node.hidden ? ", hidden in another medium" : "");
}

std::string divergenceText(const Scene& scene, const ExplainedRays& rays, std::size_t node) {
  const std::size_t other = rays.counterpart[node];
  if (other == kNoCounterpart) return "it does not trace this ray";

  const RayNode &n = rays.packets.nodes[node], &reference = rays.reference.nodes[other];
  if (!hitsSameSurface(n, reference)) return hitText(scene, reference);
  return seesSameLights(n, reference) ? "it sends on other rays" : "it sees other lights";
}

}  // namespace

bool ExplainedRays::divergesAt(std::size_t node) const {
  return counterpart[node] == kNoCounterpart ||
         !agree(packets.nodes[node], reference.nodes[counterpart[node]]);
}

bool ExplainedRays::divergesFirstAt(std::size_t node) const {
  const std::size_t parent = packets.nodes[node].parent;
  return divergesAt(node) && (parent == node || !divergesAt(parent));
}

ExplainedRays explainRays(Renderer& renderer, const Camera& camera, const Film& film, int x,
                          int y) {
  ExplainedRays rays{traceRayTree(renderer, camera, film, x, y), {}, {}};
  rays.reference = traceReferenceTree(renderer, camera, film, x, y, rays.packets.samples);
  rays.counterpart = counterparts(rays.packets, rays.reference);
  return rays;
}

RgbD contributionOf(const RayTree& tree, std::size_t node, const RgbD& own) {
  return weightAtEye(tree, node) * own * (1.0 / static_cast<double>(tree.primaries.size()));
}

std::string materialName(const Scene& scene, std::uint32_t material) {
  return nameOf(scene.materials[material].name, "material", material);
}

std::string lightName(const Scene& scene, std::uint32_t light) {
  if (light == kAmbientLight) return "ambient light";
  return nameOf(scene.lights[light].name, "light", light);
}

std::string mediumName(const Scene& scene, std::uint32_t media) {
  const std::uint32_t medium = reference::currentMedium(scene, media);
  if (medium == 0) return "vacuum";

  // A medium has no name of its own; it is called after the first material that has it.
  for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
    if (scene.mediumOfMaterial[m] == medium) return materialName(scene, m);
  }
  return concat("medium ", medium);
}

const char* nameOf(PathEnd end) {
  constexpr const char* kNames[] = {
      "", "depth", "cutoff", "roulette", "cutoff or --max-rays", "total reflection"};
  return entryOf(kNames, end);
}

std::string colorOf(RayLook look) {
  const auto& color = styleOf(look).color;
  return formatted("#%02x%02x%02x", color[0], color[1], color[2]);
}

RayText describeRay(const Scene& scene, const ExplainedRays& rays, std::size_t node) {
  const RayNode& n = rays.packets.nodes[node];
  RayText text{hitText(scene, n), mediumName(scene, n.media), {}};

  const auto adds = [&](const std::string& what, const RgbD& own) {
    text.lines.push_back(what + " adds " + textOf(contributionOf(rays.packets, node, own)));
  };

  if (rays.divergesFirstAt(node)) {
    text.lines.push_back("here the reference diverges: " + divergenceText(scene, rays, node));
  }
  if (maxComponent(n.emitted) > 0) {
    adds(n.triangle == kMiss ? "sky" : "emission and ambient", n.emitted);
  }

  for (const LightContribution& light : n.lights) {
    const std::string name = lightName(scene, light.light);
    if (light.visible) {
      adds(name, light.radiance);
    } else {
      text.lines.push_back(name + " is in shadow");
    }
  }

  // A reflected or refracted ray that was not traced has a reason, such as the limit of depth.
  for (const RayKind kind : kImpulseKinds) {
    const PathEnd end = n.endOf(kind);
    if (end == PathEnd::none) continue;
    text.lines.push_back(formatted("no %s: %s", rowOf(kind).light.data(), nameOf(end)));
  }
  return text;
}

int codesAddedBy(const RayTree& tree, std::size_t node, const RenderOptions& options) {
  const RgbD added = contributionOf(tree, node, tree.nodes[node].radiance);
  const auto with = codesOf(tree.pixel, options);
  const auto without = codesOf(max(tree.pixel - Rgb(added), Rgb(0.0f)), options);

  int most = 0;
  for (const auto i : indices(with)) most = std::max(most, std::abs(with[i] - without[i]));
  return most;
}

Json pageTree(const std::vector<RayText>& words, const ExplainedRays& rays,
              const RenderOptions& options) {
  const RayTree& tree = rays.packets;
  Json json{{"radiance", jsonOf(RgbD(tree.pixel))},
            {"codes", codesOf(tree.pixel, options)},
            {"reference", codesOf(rays.reference.pixel, options)},
            {"shadowRays", tree.shadowRays()}};

  for (const auto i : indices(tree.nodes)) {
    const RayNode& n = tree.nodes[i];
    json["nodes"].push_back({{"parent", n.parent},
                             {"kind", rowOf(n.kind).name},
                             {"color", colorOf({n.kind})},
                             {"hit", words[i].hit},
                             {"medium", words[i].medium},
                             {"weight", textOf(n.weight)},
                             {"codes", codesAddedBy(tree, i, options)},
                             {"adds", jsonOf(contributionOf(tree, i, n.local))},
                             {"lines", words[i].lines}});
  }
  return json;
}

}  // namespace whit
