// whit explain: the tree of rays of one pixel, as text, as JSON and drawn over the scene.
#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/lesson.h"
#include "command_line/progress_bar.h"
#include "core/error.h"
#include "core/index.h"
#include "core/option_table.h"
#include "core/text.h"
#include "engine/engine.h"
#include "inspect/ray_tree.h"
#include "io/image/image_file.h"
#include "output/explained_rays.h"
#include "output/image_output.h"
#include "output/json_report.h"
#include "output/open_and_warn.h"
#include "output/report_page.h"

namespace whit::cli {

namespace {

constexpr const char* kExplainUsage = "whit explain SCENE --pixel x,y [options]";
constexpr const char* kExplainSummary =
    "Prints the tree of rays of one pixel: what each ray hits, what it adds and where it ends, in "
    "packets and in the scalar reference. One sample is explained unless --spp asks for more.";
constexpr ImageSize kDiagramSize{960, 600};

struct ExplainJob {
  CommonOptions common;
  std::vector<std::string> scenes;
  std::string pixel, json, svg, html;
  double least = 0.01;
};

OptionList listOptions(ExplainJob& job) {
  OptionList list;
  list.group("Explaining");
  list.value({"pixel", "x,y"}, "the pixel, from the top left", job.pixel);
  list.value({"least", "X", 0, 1}, "smallest share of the pixel's radiance that is listed",
             job.least);
  list.value({"svg", "FILE"}, "the rays drawn over a picture of the scene from aside", job.svg);
  list.value({"html", "FILE"},
             "a page for a lesson: picture, rays and what each adds, and the stages of the pixel's "
             "tile, to step through; needs no network",
             job.html);
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
  const Crop& w = image.window;
  if (!w.contains(place.x, place.y)) {
    throwUsage(concat("--pixel ", text, " is not in the picture of ", image.width, "x",
                      image.height, " with pixels ", w.x0, ",", w.y0, " to ", w.x1 - 1, ",",
                      w.y1 - 1));
  }
  return place;
}

// The rays of a pixel, and their scene.
struct Explained {
  const Scene& scene;
  const RenderOptions& options;
  PixelPlace place;
  ExplainedRays rays;
  int samplesOfPicture = 1;

  // Says that there are more samples than those explained; empty if there are none.
  std::string note() const {
    if (samplesOfPicture == options.spp) return "";
    return formatted(
        "One sample explains the pixel here; the picture has %d: --spp %d explains all.",
        samplesOfPicture, samplesOfPicture);
  }
};

// The tree as text. Rays that add at least the share `least` of the pixel's radiance are listed,
// and the others are counted.
class TreeText {
 public:
  TreeText(const Explained& e, double least) : e_(e) {
    least_ = least * std::max(1e-12, double{maxComponent(e.rays.packets.pixel)});
  }

  std::string text() {
    for (const std::size_t primary : e_.rays.packets.primaries) appendNode(primary);
    if (leftOut_ > 0) {
      text_ += counted(leftOut_, "more ray") + ", adding " + textOf(restAdds_) + "\n";
    }
    return std::move(text_);
  }

 private:
  std::string indent(const RayNode& n, int more = 0) const {
    return std::string(2 * static_cast<std::size_t>(n.depth + more), ' ');
  }

  void appendNode(std::size_t number) {
    const RayNode& n = e_.rays.packets.nodes[number];
    if (maxComponent(contributionOf(e_.rays.packets, number, n.radiance)) < least_) {
      leaveOut(number);
      return;
    }

    const RayText ray = describeRay(e_.scene, e_.rays, number);
    text_ += indent(n) + std::string(rowOf(n.kind).name) + ", weight " + textOf(n.weight) +
             ", in " + ray.medium + ": " + ray.hit + "\n";
    for (const std::string& line : ray.lines) text_ += indent(n, 1) + line + "\n";
    for (const std::size_t child : n.children) appendNode(child);
  }

  void leaveOut(std::size_t number) {
    const RayNode& n = e_.rays.packets.nodes[number];
    ++leftOut_;
    restAdds_ += contributionOf(e_.rays.packets, number, n.local);
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

  const std::size_t rays = e.rays.packets.nodes.size();
  bool diverge = false;
  for (const auto i : indices(rays)) diverge |= e.rays.divergesAt(i);

  std::string remarks;
  if (e.options.background.hidesSky()) {
    remarks += "  the picture shows --background " + backgroundText(e.options.background) +
               " where rays leave the scene straight on\n";
  }
  if (diverge) remarks += "  their paths diverge\n";
  if (!e.note().empty()) remarks += "  " + e.note() + "\n";

  return formatted("%s, pixel %d,%d: ", printable(e.scene.name).c_str(), e.place.x, e.place.y) +
         counted(rays, "ray") + " and " + counted(e.rays.packets.shadowRays(), "shadow ray") +
         "\n" + line("packets", e.rays.packets.pixel) + line("reference", e.rays.reference.pixel) +
         remarks + "\n";
}

Json lightJson(const Scene& scene, const LightContribution& light) {
  const char* const found = light.visible ? "lit" : "blocked";
  Json json{{"light", lightName(scene, light.light)},
            {"sample", light.sample},
            {"shadow", light.traced ? found : "none"},
            {"radiance", jsonOf(light.radiance)}};
  if (light.traced) {
    json["origin"] = jsonOf(scene.inFile(light.origin));
    json["to_light"] = jsonOf(light.toLight);
  }
  return json;
}

Json surfaceJson(const Scene& scene, const RayNode& n) {
  if (n.triangle == kMiss) return nullptr;
  Json json{{"material", materialName(scene, n.material)},
            {scene.isSphere(n.triangle) ? "sphere" : "triangle", n.triangle},
            {"distance", n.distance},
            {"position", jsonOf(scene.inFile(n.position))},
            {"hidden", n.hidden}};
  if (n.instance != kMiss) json["instance"] = n.instance;
  return json;
}

Json nodeJson(const Scene& scene, const RayTree& tree, std::size_t number, bool ofPackets) {
  const RayNode& n = tree.nodes[number];
  Json json{{"kind", rowOf(n.kind).name},           {"origin", jsonOf(scene.inFile(n.origin))},
            {"direction", jsonOf(n.direction)},     {"weight", jsonOf(n.weight)},
            {"medium", mediumName(scene, n.media)}, {"surface", surfaceJson(scene, n)},
            {"radiance", jsonOf(n.radiance)}};

  // Only packets record what each light adds and why paths end.
  if (ofPackets) {
    json["emitted"] = jsonOf(n.emitted);
    json["local"] = jsonOf(n.local);
    json["adds"] = jsonOf(contributionOf(tree, number, n.local));
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

std::string lineSvg(const ScreenLine& line, RayLook look, double width,
                    const std::string& more = "") {
  return formatted(
      "<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" stroke=\"%s\" "
      "stroke-width=\"%.2f\"%s%s/>\n",
      line.x1, line.y1, line.x2, line.y2, colorOf(look).c_str(), width,
      isDashed(look) ? " stroke-dasharray=\"4 3\"" : "", more.c_str());
}

// Makes a text of the diagram. Its letters are white with a black edge, legible on any picture.
std::string wordSvg(double x, double y, std::string_view word) {
  return formatted("<text x=\"%.1f\" y=\"%.1f\">%s</text>\n", x, y, std::string(word).c_str());
}

// Lists the colors of the lines in the lower left corner.
std::string legendSvg(const std::vector<RayLine>& lines, int height) {
  constexpr double kLine = 18, kLeft = 12, kSample = 30;
  std::string svg;
  double y = height - kLine;
  for (const RayLook look : looksOf(lines)) {
    svg += lineSvg({kLeft, y - 4, kLeft + kSample, y - 4}, look, 2);
    svg += wordSvg(kLeft + kSample + 8, y, styleOf(look).name);
    y -= kLine;
  }
  return svg;
}

// Returns an SVG of the picture's size with the rays as lines over it, as in Whitted's figure of
// 1980; shadow rays are dashed. The eye, the lights, and the ray of each kind with the largest
// weight have their names beside them. `picture` is a PNG of the scene by `camera`; `eye` is the
// camera of the rays.
std::string rayDiagram(const RayTree& tree, const Camera& eye, const Camera& camera, int width,
                       int height, const std::string& picture) {
  std::string svg = formatted(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
      "viewBox=\"0 0 %d %d\">\n<image width=\"%d\" height=\"%d\" href=\"",
      width, height, width, height, width, height);
  svg += "data:image/png;base64," + base64(picture) + "\"/>\n";

  const LineView view(camera, width, height);
  const std::vector<RayLine> lines = linesOf(tree, eye);
  // Places of the names. Lines of larger weight come later and replace earlier ones.
  std::map<std::string, ScreenLine> places;
  for (const RayLine& line : lines) {
    const auto seen = view.see(line.from, line.to);
    if (!seen) continue;
    svg += lineSvg(*seen, line.look, line.width, formatted(" data-node=\"%zu\"", line.node));

    const ScreenLine middle{(seen->x1 + seen->x2) / 2, (seen->y1 + seen->y2) / 2};
    const bool isShadow = line.look == RayLook{RayKind::shadow};
    const bool isPrimary = line.look.kind == RayKind::primary;
    const auto end = isShadow ? view.see(line.to, line.to) : view.see(line.from, line.from);
    if (end && (isShadow || isPrimary)) places[isShadow ? "light" : "eye"] = *end;
    if (!isDashed(line.look)) places[std::string(styleOf(line.look).name)] = middle;
  }

  svg +=
      "<g font-family=\"sans-serif\" font-size=\"14\" fill=\"#fff\" stroke=\"#000\" "
      "stroke-width=\"3\" paint-order=\"stroke\">\n";
  for (const auto& [word, at] : places) {
    const bool inside = at.x1 >= 0 && at.y1 >= 20 && at.x1 < width - 80 && at.y1 < height;
    if (inside) svg += wordSvg(at.x1 + 6, at.y1 - 6, word);
  }
  return svg + legendSvg(lines, height) + "</g>\n</svg>\n";
}

// Returns the picture by `camera` as a PNG. It has as many samples as the scene asks for, up to a
// number for which nobody has to wait.
std::string pictureBy(const Camera& camera, const Explained& e, ImageSize size, Renderer& renderer,
                      const ExplainJob& job) {
  constexpr int kMostSamples = 16;
  RenderOptions options = e.options;
  options.size = size;
  options.crop.reset();
  options.spp = std::clamp(e.samplesOfPicture, options.spp, std::max(options.spp, kMostSamples));

  Film film = makeFilm(renderer.scene(), options, job.common.load.maxMemoryBytes);
  film.wantDisplay = true;
  const RenderOptions explained = renderer.options();
  renderer.setOptions(options);
  renderer.render(camera, film);
  renderer.setOptions(explained);
  return encodePng(film.display);
}

std::string drawDiagram(const ExplainJob& job, const Explained& e, Renderer& renderer,
                        const Camera& camera) {
  const Camera seen = cameraAside(e.rays.packets, camera, renderer.accel());
  return rayDiagram(e.rays.packets, camera, seen, kDiagramSize.width, kDiagramSize.height,
                    pictureBy(seen, e, kDiagramSize, renderer, job));
}

// The build turns lesson.html into a string literal.
constexpr std::string_view kLesson =
#include "lesson_html.inc"
    ;

std::string lessonPage(const ExplainJob& job, const Explained& e, const std::string& diagram,
                       Renderer& renderer, const Camera& camera, const Film& film) {
  constexpr int kLargestTile = 64;  // the page holds every column of all its pixels
  const int side = std::min(e.options.tile, kLargestTile);
  const Crop& window = film.image.window;
  const int x0 = e.place.x - (e.place.x - window.x0) % side,
            y0 = e.place.y - (e.place.y - window.y0) % side;
  const Crop tile{x0, y0, std::min(x0 + side, window.x1), std::min(y0 + side, window.y1)};

  const ImageSize size{film.image.width, film.image.height};
  std::vector<RayText> words;
  for (const auto i : indices(e.rays.packets.nodes)) {
    words.push_back(describeRay(e.scene, e.rays, i));
  }

  const std::string picture = pictureBy(camera, e, size, renderer, job);
  return pageWith(kLesson,
                  {{"scene", e.scene.name},
                   {"size", {size.width, size.height}},
                   {"pixel", {e.place.x, e.place.y}},
                   {"reference", jsonOf(RgbD(e.rays.reference.pixel))},
                   {"note", e.note()},
                   {"tree", pageTree(words, e.rays, e.options)},
                   {"picture", base64(picture)},
                   {"diagram", diagram},
                   {"tile", {tile.x0, tile.y0, tile.x1, tile.y1}},
                   {"recorded", recordStages(renderer, camera, film, tile, e.place.x, e.place.y)}});
}

}  // namespace

int explainCommand(const Words& words) {
  ExplainJob job;
  if (!parseOptions(kExplainUsage, kExplainSummary, listOptions(job), words)) return 0;

  if (job.pixel.empty()) throwUsage("whit explain expected --pixel x,y");
  if (!job.svg.empty()) requireWritable(job.svg, {".svg"});
  if (!job.html.empty()) requireWritable(job.html, {".html"});
  requireJsonWritable(job.json);
  requireSeparateFiles({job.svg, job.html, job.json}, job.common, job.scenes);

  auto progress = makeProgressBar(job.common);
  Engine engine(openAndWarn(job.scenes[0], job.common, progress.get()));
  engine.setOptions(job.common.render, job.common.given);
  const int samplesOfPicture = engine.requestedOptions().spp;

  // Nobody reads the rays of hundreds of samples: one explains the pixel, unless more are asked
  // for.
  if (job.common.given.insert("spp").second) job.common.render.spp = 1;
  engine.setOptions(job.common.render, job.common.given);

  const Film film =
      makeFilm(engine.scene(), engine.requestedOptions(), job.common.load.maxMemoryBytes);
  const PixelPlace place = readPixel(job.pixel, film.image);
  Renderer& renderer = engine.prepare(progress.get());
  const Camera camera = engine.camera();
  progress.reset();

  const Explained e{engine.scene(), engine.options(), place,
                    explainRays(renderer, camera, film, place.x, place.y), samplesOfPicture};

  // The diagram is a file of its own, and part of the page.
  if (!job.svg.empty() || !job.html.empty()) {
    const std::string diagram = drawDiagram(job, e, renderer, camera);
    if (!job.svg.empty()) writeReport(job.svg, diagram);
    if (!job.html.empty()) {
      writeReport(job.html, lessonPage(job, e, diagram, renderer, camera, film));
    }
  }

  if (!job.json.empty()) {
    writeJson(job.json, Json{{"scene", e.scene.name},
                             {"size", {film.image.width, film.image.height}},
                             {"pixel", {place.x, place.y}},
                             {"packets", treeJson(e, e.rays.packets, true)},
                             {"reference", treeJson(e, e.rays.reference, false)}});
  }
  if (job.json != "-") std::fputs((headOf(e) + TreeText(e, job.least).text()).c_str(), stdout);
  printWrittenFiles({job.svg, job.html, job.json}, job.common);
  return 0;
}

}  // namespace whit::cli
