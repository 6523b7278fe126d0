// whit explain: the tree of rays of one pixel, as text, as JSON and drawn over the scene.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "accuracy/report.h"
#include "cli/app/explained_rays.h"
#include "cli/app/image_output.h"
#include "cli/app/open_scene.h"
#include "cli/app/progress_bar.h"
#include "cli/commands.h"
#include "cli/json_report.h"
#include "core/display.h"
#include "core/error.h"
#include "core/formatted.h"
#include "core/option_values.h"
#include "inspect/ray_lines.h"
#include "io/atomic_file.h"
#include "io/image/image_file.h"
#include "render/auto_exposure.h"

namespace whit::cli {

namespace {

constexpr const char* kExplainUsage = "whit explain SCENE --pixel x,y [options]";
constexpr const char* kExplainSummary =
    "Prints the tree of rays of one pixel: what each ray hits, what it adds and where it ends, in "
    "packets and in the scalar reference.";
constexpr ImageSize kDiagramSize{960, 600};

struct ExplainJob {
  CommonOptions common;
  std::vector<std::string> scenes;
  std::string pixel, json, svg;
  std::optional<Vec3f> seenFrom;
  double least = 0.01;
};

OptionList listOptions(ExplainJob& job) {
  OptionList list;
  list.group("Explaining");
  list.value({"pixel", "x,y"}, "the pixel, from the top left", job.pixel);
  list.value({"least", "X", 0, 1}, "smallest share of the pixel's radiance that is listed",
             job.least);
  list.value({"svg", "FILE"}, "the rays drawn over a picture of the scene", job.svg);
  list.value({"seen-from", "x,y,z"},
             "position of the camera of that picture (default: aside and above)", job.seenFrom);
  list.value({"json", "FILE"}, "the whole trees as JSON; - is standard output", job.json);
  listCommonOptions(list, job.common);
  list.operands("SCENE", "a scene file, a model, or the name of a shipped scene", 1, 1, job.scenes);
  return list;
}

struct PixelPlace {
  int x = 0, y = 0;
};
PixelPlace readPixel(const std::string& text, const Image& image) {
  PixelPlace place;
  const std::vector<std::string> parts = split(text, ',');
  const bool read =
      parts.size() == 2 && readNumber(parts[0], place.x) && readNumber(parts[1], place.y);
  if (!read) throwUsage("--pixel expected x,y, as in 240,150; found '" + text + "'");
  const bool inside =
      place.x >= 0 && place.y >= 0 && place.x < image.width && place.y < image.height;
  if (!inside) {
    throwUsage("--pixel " + text + " is not in the picture of " + std::to_string(image.width) +
               "x" + std::to_string(image.height));
  }
  return place;
}

// The rays of a pixel, and their scene.
struct Explained {
  const Scene& scene;
  const RenderOptions& options;
  PixelPlace place;
  ExplainedRays rays;
};

std::string textOf(const RgbD& c) { return formatted("%.5f %.5f %.5f", c.x, c.y, c.z); }

std::array<std::uint8_t, 3> codesOf(const Rgb& pixel, const RenderOptions& o) {
  return displayCodes(pixel, std::exp2(double{o.exposure.ev}), o.toneCurve);
}

// Lists what adds more than so much, and counts the rest.
class TreeText {
 public:
  TreeText(const Explained& e, double least) : e_(e) {
    least_ = least * std::max(1e-12, double{maxComponent(e.rays.packets.pixel)});
  }

  std::string text() {
    for (const std::size_t primary : e_.rays.packets.primaries) appendNode(primary);
    if (leftOut_ > 0) {
      text_ += formatted("%zu more ray%s, adding %s\n", leftOut_, leftOut_ == 1 ? "" : "s",
                         textOf(restAdds_).c_str());
    }
    return std::move(text_);
  }

 private:
  std::string indent(const RayNode& n, int more = 0) const {
    return std::string(2 * static_cast<std::size_t>(n.depth + more), ' ');
  }

  void appendNode(std::size_t number) {
    const RayNode& n = e_.rays.packets.nodes[number];
    if (maxComponent(addedBy(e_.rays.packets, number, n.radiance)) < least_) {
      leaveOut(number);
      return;
    }
    text_ +=
        indent(n) + formatted("%s, weight %s, in %s: ", std::string(rowOf(n.kind).name).c_str(),
                              textOf(n.weight).c_str(), mediumName(e_.scene, n.media).c_str());
    text_ += metText(e_.scene, n) + "\n";
    if (e_.rays.partsFirstAt(number)) {
      text_ += indent(n, 1) +
               "here the reference parts: " + partingText(e_.scene, e_.rays, number) + "\n";
    }
    appendOwn(number);
    for (const std::size_t child : n.children) appendNode(child);
  }

  void appendOwn(std::size_t number) {
    const RayNode& n = e_.rays.packets.nodes[number];
    const RgbD emitted = addedBy(e_.rays.packets, number, n.emitted);
    if (maxComponent(emitted) > 0) {
      text_ += indent(n, 1) + (n.triangle == kMiss ? "sky" : "emission and ambient") + " adds " +
               textOf(emitted) + "\n";
    }
    for (const LightContribution& light : n.lights) {
      const std::string name = lightName(e_.scene, light.light);
      text_ += indent(n, 1) + name +
               (light.visible ? " adds " + textOf(addedBy(e_.rays.packets, number, light.radiance))
                              : std::string(" is in shadow")) +
               "\n";
    }
    for (const RayKind kind : kImpulseKinds) {
      const PathEnd end = n.endOf(kind);
      if (end == PathEnd::none) continue;
      text_ += indent(n, 1) + formatted("no %s: %s\n", rowOf(kind).light.data(), nameOf(end));
    }
  }

  void leaveOut(std::size_t number) {
    const RayNode& n = e_.rays.packets.nodes[number];
    ++leftOut_;
    restAdds_ += addedBy(e_.rays.packets, number, n.local);
    for (const std::size_t child : n.children) leaveOut(child);
  }

  const Explained& e_;
  double least_ = 0;
  std::string text_;
  std::size_t leftOut_ = 0;
  RgbD restAdds_;
};

std::string headOf(const Explained& e) {
  const auto line = [&](const char* name, const Rgb& pixel) {
    const auto codes = codesOf(pixel, e.options);
    return formatted("  %-11s%.6f %.6f %.6f  codes %d %d %d\n", name, double{pixel.x},
                     double{pixel.y}, double{pixel.z}, codes[0], codes[1], codes[2]);
  };
  std::size_t shadowRays = 0, parted = 0;
  for (std::size_t i = 0; i < e.rays.packets.nodes.size(); ++i) {
    for (const LightContribution& light : e.rays.packets.nodes[i].lights)
      shadowRays += light.traced;
    parted += e.rays.partsAt(i);
  }
  const std::size_t rays = e.rays.packets.nodes.size();
  return formatted("%s, pixel %d,%d: %zu ray%s and %zu shadow ray%s\n",
                   printable(e.scene.name).c_str(), e.place.x, e.place.y, rays,
                   rays == 1 ? "" : "s", shadowRays, shadowRays == 1 ? "" : "s") +
         line("packets", e.rays.packets.pixel) + line("reference", e.rays.reference.pixel) +
         (parted == 0 ? "" : "  their paths part\n") + "\n";
}

Json jsonOf(const RgbD& v) { return Json::array({v.x, v.y, v.z}); }

Json lightJson(const Scene& scene, const LightContribution& light) {
  Json json{{"light", lightName(scene, light.light)},
            {"sample", light.sample},
            {"shadow", !light.traced   ? "none"
                       : light.visible ? "lit"
                                       : "blocked"},
            {"radiance", jsonOf(light.radiance)}};
  if (light.traced) {
    json["origin"] = jsonOf(light.origin);
    json["to_light"] = jsonOf(light.toLight);
  }
  return json;
}

Json surfaceJson(const Scene& scene, const RayNode& n) {
  if (n.triangle == kMiss) return nullptr;
  Json json{{"material", materialName(scene, n.material)},
            {scene.isSphere(n.triangle) ? "sphere" : "triangle", n.triangle},
            {"distance", n.distance},
            {"position", jsonOf(n.position)},
            {"hidden", n.hidden}};
  if (n.instance != kMiss) json["instance"] = n.instance;
  return json;
}

Json nodeJson(const Scene& scene, const RayTree& tree, std::size_t number, bool ofPackets) {
  const RayNode& n = tree.nodes[number];
  Json json{{"kind", rowOf(n.kind).name},           {"origin", jsonOf(n.origin)},
            {"direction", jsonOf(n.direction)},     {"weight", jsonOf(n.weight)},
            {"medium", mediumName(scene, n.media)}, {"surface", surfaceJson(scene, n)},
            {"radiance", jsonOf(n.radiance)}};
  if (ofPackets) {
    json["emitted"] = jsonOf(n.emitted);
    json["local"] = jsonOf(n.local);
    json["adds"] = jsonOf(addedBy(tree, number, n.local));
    json["lights"] = Json::array();
    for (const LightContribution& light : n.lights)
      json["lights"].push_back(lightJson(scene, light));
    for (const RayKind kind : kImpulseKinds)
      json["ends"][std::string(rowOf(kind).name)] = nameOf(n.endOf(kind));
  }
  json["children"] = Json::array();
  for (const std::size_t child : n.children) {
    json["children"].push_back(nodeJson(scene, tree, child, ofPackets));
  }
  return json;
}

Json treeJson(const Explained& e, const RayTree& tree, bool ofPackets) {
  Json json{{"radiance", jsonOf(RgbD(tree.pixel))}, {"codes", codesOf(tree.pixel, e.options)}};
  json["samples"] = Json::array();
  for (const std::size_t primary : tree.primaries) {
    json["samples"].push_back(nodeJson(e.scene, tree, primary, ofPackets));
  }
  return json;
}

std::string lineSvg(const ScreenLine& line, RayLook look, double width) {
  const auto& color = styleOf(look).color;
  return formatted(
      "<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" stroke=\"#%02x%02x%02x\" "
      "stroke-width=\"%.2f\"%s/>\n",
      line.x1, line.y1, line.x2, line.y2, color[0], color[1], color[2], width,
      isDashed(look) ? " stroke-dasharray=\"4 3\"" : "");
}

// An SVG of the picture's size with the rays as lines over it, as in Whitted's figure of 1980;
// shadow rays are dashed. `picture` is a PNG of the scene by that camera.
std::string rayDiagram(const RayTree& tree, const Camera& camera, int width, int height,
                       const std::string& picture) {
  std::string svg = formatted(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
      "viewBox=\"0 0 %d %d\">\n<image width=\"%d\" height=\"%d\" href=\"",
      width, height, width, height, width, height);
  svg += "data:image/png;base64," + accuracy::base64(picture) + "\"/>\n";
  const LineView view(camera, width, height);
  for (const RayLine& line : linesOf(tree)) {
    const auto seen = view.see(line.from, line.to);
    if (seen) svg += lineSvg(*seen, line.look, line.width);
  }
  return svg + "</svg>\n";
}

void drawDiagram(const ExplainJob& job, const Explained& e, Renderer& renderer,
                 const Camera& camera) {
  Camera seen = cameraAside(e.rays.packets, camera);
  if (job.seenFrom) seen.eye = *job.seenFrom;
  RenderOptions options = e.options;
  options.size = kDiagramSize;
  options.crop.reset();
  Film film = makeFilm(e.scene, options, job.common.load.maxMemoryBytes);
  renderer.render(seen, film);
  const std::string picture =
      encodePng(toDisplay(film.image, options.exposure.ev, options.toneCurve));
  writeTextFile(job.svg,
                rayDiagram(e.rays.packets, seen, kDiagramSize.width, kDiagramSize.height, picture));
}

}  // namespace

int explainCommand(const Words& words) {
  ExplainJob job;
  if (parseOptions(kExplainUsage, kExplainSummary, listOptions(job), words) == Parsed::helpShown) {
    return 0;
  }
  settleOptions(job.common);
  if (job.pixel.empty()) throwUsage("whit explain expected --pixel x,y");
  if (!job.svg.empty()) requireWritable(job.svg, {".svg"});
  requireJsonWritable(job.json);
  auto progress = makeProgressBar(job.common);
  const auto open = openScene(job.scenes[0], job.common, progress.get());
  RenderOptions options = optionsFor(open->scene, job.common);
  const Film film = openFilm(open->scene, job.common);
  const PixelPlace place = readPixel(job.pixel, film.image);
  Renderer renderer(open->scene, options, progress.get());
  const Camera camera = chooseCamera(open->scene, options);
  settleExposure(renderer, camera, options);
  progress.reset();

  Explained e{open->scene, options, place, explainRays(renderer, camera, film, place.x, place.y)};
  if (!job.svg.empty()) drawDiagram(job, e, renderer, camera);
  if (!job.json.empty()) {
    writeJson(job.json, Json{{"scene", open->scene.name},
                             {"size", {film.image.width, film.image.height}},
                             {"pixel", {place.x, place.y}},
                             {"packets", treeJson(e, e.rays.packets, true)},
                             {"reference", treeJson(e, e.rays.reference, false)}});
  }
  if (job.json != "-") std::fputs((headOf(e) + TreeText(e, job.least).text()).c_str(), stdout);
  return 0;
}

}  // namespace whit::cli
