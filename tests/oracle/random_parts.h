// What the oracle's random scenes are put together from. Every number is a float, so that both
// sides have the same one.
#pragma once

#include <cstdint>
#include <random>

#include "oracle/scene.h"

namespace oracle {

// The same numbers everywhere: those of the standard's distributions depend on the library.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}

  double between(double low, double high) {
    return asFloat(low + (high - low) * static_cast<double>(engine_() >> 8) * 0x1p-24);
  }
  bool chance(double probability) { return between(0, 1) < probability; }
  int below(int count) { return static_cast<int>(between(0, 1) * 0.999999 * count); }
  Color color(double low, double high) {
    const double r = between(low, high), g = between(low, high), b = between(low, high);
    return {r, g, b};
  }
  Vec inBox(const Vec& low, const Vec& high) {
    const double x = between(low.x, high.x), y = between(low.y, high.y), z = between(low.z, high.z);
    return {x, y, z};
  }
  // Turned any way, moved and of this size.
  Transform placement(const Vec& translate, double size);

 private:
  std::mt19937 engine_;
};

// Appends to a scene.
class SceneMaker {
 public:
  explicit SceneMaker(std::uint32_t seed) : random(seed) {}

  int add(Mesh mesh);
  int add(const Material& material);
  int addObject(Mesh mesh, const Material& material);
  int addSphere(double radius, const Material& material);
  void place(int object, const Transform& transform, bool inPlace = false) {
    scene.bodies.push_back({object, transform, inPlace});
  }
  void add(Mesh mesh, const Material& material, const Transform& transform) {
    place(addObject(std::move(mesh), material), transform);
  }

  // A floor, a sky that is nowhere black, ambient light, and an eye that looks at what stands about
  // (0, 1, 0), from some 6 away.
  void room();
  // The same from near, so that what is sampled fills the picture, and a lamp that few samples see
  // without much noise.
  void roomFromNear();
  void floor(const Material& material);
  // A point light somewhere above, on the eye's side.
  Light lamp();
  void addLamps(int count);
  // Moves everything in the scene.
  void moveBy(const Vec& way);

  Material matte();
  Material glossy();
  // A highlight narrower than the light would be met by few samples, and by none of the oracle's.
  Material rough();
  Material mirror();
  // Tinted and absorbing; `priority` as it is.
  Material glass(double ior, int priority = 0);
  Material anyGlass(int priority = 0) { return glass(random.between(1.2, 1.9), priority); }

  // Glossy, of several textures.
  Material painted();

  // Returns the number of the texture.
  int addTexture(const Texture& texture);
  // A texture of colors that are exact as sRGB, of a few texels; its number.
  int addColors();
  int addColors(int width, int height);
  // A texture of numbers within the box, all three of a texel at once; its number.
  int addData(int width, int height, const Color& low, const Color& high);

  Mesh solid();  // a box, a tetrahedron or a ball
  // In one of `count` places beside each other, so that nothing touches.
  Transform standing(int place, int count);

  Random random;
  Scene scene;
};

}  // namespace oracle
