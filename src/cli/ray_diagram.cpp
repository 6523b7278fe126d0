#include "cli/ray_diagram.h"

#include "accuracy/report.h"
#include "core/formatted.h"

namespace whit::cli {

namespace {

std::string drawn(const ScreenLine& line, RayLook look, double width) {
  const auto& color = styleOf(look).color;
  return formatted(
      "<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" stroke=\"#%02x%02x%02x\" "
      "stroke-width=\"%.2f\"%s/>\n",
      line.x1, line.y1, line.x2, line.y2, color[0], color[1], color[2], width,
      isDashed(look) ? " stroke-dasharray=\"4 3\"" : "");
}

}  // namespace

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
    if (seen) svg += drawn(*seen, line.look, line.width);
  }
  return svg + "</svg>\n";
}

}  // namespace whit::cli
