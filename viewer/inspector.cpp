#include "viewer/inspector.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/display.h"
#include "core/formatted.h"
#include "inspect/metrics.h"
#include "viewer/label.h"
#include "viewer/window.h"

namespace whit::view {

namespace {

// Where in the picture, each from 0 to 1; null: beside it.
std::optional<std::array<double, 2>> placeIn(const ImageSize& madeFor, const ImageSize& window,
                                             const std::array<int, 2>& pixel) {
  const auto shares = sharesFilled(madeFor, window);
  const double x = ((pixel[0] + 0.5) / window.width - 0.5) / shares[0] + 0.5;
  const double y = ((pixel[1] + 0.5) / window.height - 0.5) / shares[1] + 0.5;
  if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return std::nullopt;
  return std::array{x, y};
}

int indexAt(double share, int pixels) { return static_cast<int>(share * pixels); }

std::string colorText(const Rgb& c) {
  const RgbD d(c);
  return formatted("%.4g %.4g %.4g", d.x, d.y, d.z);
}

Image alone(const Rgb& radiance) {
  Image image(1, 1);
  image.pixels[0] = radiance;
  return image;
}

// As in the map of differences.
int codesApart(const Rgb& a, const Rgb& b) {
  return codeDifferences(toDisplay(alone(a), 0, ToneCurve::none),
                         toDisplay(alone(b), 0, ToneCurve::none))[0];
}

std::string comparedText(const Comparison& comparison, const Rgb& packets, int x, int y) {
  std::string text = "\npackets   " + colorText(packets);
  if (y >= comparison.rows) return text + "\nreference: not traced yet";
  const Image& image = comparison.reference.image;
  const Rgb reference = image.pixels[image.index(x, y)];
  return text + "\nreference " + colorText(reference) +
         formatted("\n%d 8-bit codes apart", codesApart(packets, reference));
}

}  // namespace

std::string inspect(const TracedFrame& frame, bool compared, const ImageSize& window,
                    const std::array<int, 2>& pixel) {
  const Image& image = frame.film.image;
  const DisplayImage& display = frame.film.display;
  const ImageSize& madeFor = frame.request.window;
  if (!frame.scene || window.width < 1 || window.height < 1 || madeFor.width < 1 ||
      image.pixels.empty() || display.rgba.size() < 4 * image.pixels.size()) {
    return "";
  }
  const auto place = placeIn(madeFor, window, pixel);
  if (!place) return "";
  const auto [shareX, shareY] = *place;
  const int x = indexAt(shareX, image.width), y = indexAt(shareY, image.height);
  const std::size_t at = image.index(x, y);
  std::string text =
      formatted("pixel %d, %d", indexAt(shareX, madeFor.width), indexAt(shareY, madeFor.height));
  if (frame.watched) {
    text += "\n" + textOf(frame.request.view, (*frame.watched)[at], frame.options.spp);
  } else {
    const std::uint8_t* codes = &display.rgba[4 * at];
    text += formatted("\n8-bit codes %d %d %d", codes[0], codes[1], codes[2]) +
            "\nradiance, W/sr a square unit";
    if (!compared || !frame.comparison) text += "\n" + colorText(image.pixels[at]);
  }
  if (compared && frame.comparison) {
    text += comparedText(*frame.comparison, image.pixels[at], x, y);
  }
  return text;
}

void drawInspection(const std::string& lines, double pointerX, double pointerY) {
  if (lines.empty()) return;
  constexpr float kMargin = 4;
  const float away = ImGui::GetFontSize();
  const ImVec2 size = ImGui::CalcTextSize(lines.c_str()), window = ImGui::GetIO().DisplaySize;
  const auto beside = [&](double pointer, float length, float room) {
    const auto at = static_cast<float>(pointer);
    const bool fits = at + away + length + kMargin <= room;
    return std::max(fits ? at + away : at - away - length, kMargin);
  };
  drawLabel(ImVec2(beside(pointerX, size.x, window.x), beside(pointerY, size.y, window.y)),
            lines.c_str(), kMargin, IM_COL32(255, 255, 255, 255), IM_COL32(0, 0, 0, 190));
}

}  // namespace whit::view
