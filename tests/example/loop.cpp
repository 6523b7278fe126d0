// A loop of frames in which the camera goes around and a light grows brighter: nothing is built
// anew between them, and the picture is traced to the same memory.
//   loop SCENE OUT.exr
#include <whit/whit.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace {

constexpr int kFrames = 8;

// Where the camera is in a frame, as the option "eye" takes it.
std::string eyeIn(int frame) {
  const double angle = 0.1 * frame;
  char text[96];
  std::snprintf(text, sizeof text, "%.9g,1.75,%.9g", 6.2 * std::sin(angle), 6.2 * std::cos(angle));
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: loop SCENE OUT.exr\n");
    return 2;
  }
  try {
    whit::api::Renderer renderer(whit::api::loadScene(argv[1]));
    renderer.set("size", "96x60").set("depth", "4");
    // A window would look here whether it was closed.
    renderer.setProgress([](const std::string&, double) { return true; });

    whit::api::Image image;
    for (int frame = 0; frame < kFrames; ++frame) {
      renderer.set("eye", eyeIn(frame));
      renderer.setMember("/lights/0/intensity", std::to_string(200 + 50 * frame));
      renderer.render(image);
      const std::span<const float> pixels = image.rgb();  // the frame itself, not a copy
      std::printf("frame %d, %.2f ms, the pixel in the middle %.3f %.3f %.3f\n", frame,
                  renderer.statistics().frameMs, pixels[pixels.size() / 2],
                  pixels[pixels.size() / 2 + 1], pixels[pixels.size() / 2 + 2]);
    }

    image.write(argv[2]);
    std::printf("last: --eye %s\n", eyeIn(kFrames - 1).c_str());
  } catch (const whit::api::Error& error) {
    std::fprintf(stderr, "loop: %s\n", error.what());
    return error.status();
  }
}
