// whit within another program: a few frames of a scene, and what the last one cost.
//   embed SCENE OUT.exr
#include <whit/whit.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: embed SCENE OUT.exr\n");
    return 2;
  }
  try {
    const whit::api::Scene scene = whit::api::loadScene(argv[1]);
    std::printf("%s: %llu triangles\n", scene.name().c_str(),
                static_cast<unsigned long long>(scene.triangles()));

    whit::api::Renderer renderer(scene);
    renderer.set("size", "96x60").set("depth", "4");
    whit::api::Image image;
    for (int frame = 0; frame < 3; ++frame) renderer.render(image);

    double sum = 0;
    for (const float value : image.rgb()) sum += value;
    std::printf("mean radiance %.4f\n", sum / static_cast<double>(image.rgb().size()));
    image.write(argv[2]);

    const whit::api::FrameStatistics& cost = renderer.statistics();
    std::printf("%.2f ms, %.2f of them in Embree\n", cost.frameMs, cost.embreeMs);
    for (const auto& stage : cost.stages) {
      std::printf("  %-34.*s%8.3f ms\n", static_cast<int>(stage.name.size()), stage.name.data(),
                  stage.ms);
    }
  } catch (const whit::api::Error& error) {
    std::fprintf(stderr, "embed: %s\n", error.what());
    return error.status();
  }
}
