// whit-walk: flies along the camera path of a scene in real time, as the viewer does, and reports
// by mean FLIP how far what it shows at --rate is from references of many samples.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <thread>

#include "command_line/program.h"
#include "core/error.h"
#include "inspect/metrics.h"
#include "output/open_and_warn.h"
#include "viewer/session/session.h"

namespace whit::view {
namespace {

constexpr double kSecondsAtRest = 2;  // before it flies
constexpr int kReferenceSpp = 16;

struct Shown {
  Camera camera;
  DisplayImage picture;
};

class Walker {
 public:
  Walker(const ViewOptions& options, const std::shared_ptr<OpenScene>& scene)
      : session_(options, scene, [] {}) {
    const ImageSize& size = *options.common.render.size;
    session_.setWindow(size, size.height, 1);
  }

  // Moves for `length` seconds, and returns `kept` of the pictures at equal times.
  std::vector<Shown> fly(double length, int kept) {
    moveFor(kSecondsAtRest, [](double) {});
    session_.act("play");
    std::vector<Shown> all;

    pictures_ = changes_ = 0;
    moveFor(length, [&](double seconds) {
      if (seconds < length * (static_cast<double>(all.size()) + 0.5) / kept) return;
      const TracedFrame& shown = session_.state().shown;
      all.push_back({shown.request.camera, shown.film.display});
    });
    return all;
  }
  int pictures() const { return pictures_; }
  int changes() const { return changes_; }  // changes of the resolution

 private:
  template <typename Step>
  void moveFor(double length, const Step& step) {
    const ViewState& state = session_.state();
    Stopwatch clock;
    for (double now = 0, before = 0; now < length; before = now) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const std::optional<ImageSize> last = state.shown.request.options.size;
      if (session_.fetchFrame()) {
        ++pictures_;
        changes_ += state.shown.request.options.size != last;
      }

      now = clock.ms() / 1000;
      if (state.shown.scene) step(now);
      session_.advance(now - before);
      if (!state.error.empty()) throwUsage(state.error);
    }
  }

  Session session_;
  int pictures_ = 0, changes_ = 0;
};

// Enlarges a picture as the viewer's windows do, which blend coarse pixels.
DisplayImage enlarged(const DisplayImage& image, const ImageSize& size) {
  // Blends the values of the two of `from` pixels between which the center of a pixel i of `to`
  // lies.
  const auto blended = [](int i, int from, int to, const auto& valueOf) {
    const double at = std::clamp((i + 0.5) * from / to - 0.5, 0.0, from - 1.0);
    const int first = static_cast<int>(at);
    return std::lerp(valueOf(first), valueOf(std::min(first + 1, from - 1)), at - first);
  };

  DisplayImage large{size.width, size.height, {}};
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      for (int c = 0; c < 4; ++c) {
        const double code = blended(row, image.height, size.height, [&](int y) {
          return blended(column, image.width, size.width, [&](int x) {
            const int at = 4 * (y * image.width + x) + c;
            return static_cast<double>(image.rgba[static_cast<std::size_t>(at)]);
          });
        });
        large.rgba.push_back(static_cast<std::uint8_t>(std::lround(code)));
      }
    }
  }
  return large;
}

double meanFlip(const std::vector<Shown>& all, Renderer& renderer, const ImageSize& size) {
  Film film;
  film.image = Image(size.width, size.height);
  double sum = 0;
  for (const Shown& shown : all) {
    renderer.render(shown.camera, film);
    const std::vector<float> flip = flipOfCodes(enlarged(shown.picture, size), film.display);
    sum += std::accumulate(flip.begin(), flip.end(), 0.0) / static_cast<double>(flip.size());
  }
  return sum / static_cast<double>(all.size());
}

int run(const std::vector<std::string>& words) {
  ViewOptions options;
  std::vector<std::string> scenes;
  double seconds = 10;
  int kept = 40;

  cli::OptionList list;
  list.group("Walking");
  list.value({"seconds", "N", 1, 1000}, "time along the path", seconds);
  list.value({"pictures", "N", 1, 10000}, "pictures that are compared", kept);
  listViewOptions(list, options);
  list.operands("SCENE", "a scene with a camera path", 1, 1, scenes);

  if (!cli::parseOptions("whit-walk SCENE --size WxH", "Measures the viewer in motion.", list,
                         words)) {
    return 0;
  }

  settleViewOptions(options);
  options.scene = scenes[0];
  if (!options.common.render.size) options.common.render.size = {480, 300};
  const std::shared_ptr<OpenScene> scene = openAndWarn(options.scene, options.common, nullptr);
  if (scene->scene.cameraPath.empty()) throwUsage(options.scene + " has no camera path");
  Walker walker(options, scene);
  const std::vector<Shown> all = walker.fly(seconds, kept);

  // References have the full size and many samples.
  RenderOptions many = cli::optionsFor(scene->scene, options.common);
  many.spp = kReferenceSpp;
  Renderer renderer(scene->scene, many);

  std::printf("FLIP %.4f, %.1f frames/s, %.2f changes of the resolution a second\n",
              meanFlip(all, renderer, *options.common.render.size), walker.pictures() / seconds,
              walker.changes() / seconds);
  return 0;
}

}  // namespace
}  // namespace whit::view

int main(int argc, char** argv) {
  return whit::cli::runProgram("whit-walk",
                               [&] { return whit::view::run(whit::cli::wordsOf(argc, argv)); });
}
