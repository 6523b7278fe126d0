// What the oracle's random scenes are put together from. Every number is a float, so that both
// sides have the same one.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

#include "oracle/scene.h"
#include "oracle/shapes.h"

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
  template <typename Value>
  Value oneOf(std::initializer_list<Value> values) {
    return values.begin()[below(static_cast<int>(values.size()))];
  }
  Color color(double low, double high) {
    const double r = between(low, high), g = between(low, high), b = between(low, high);
    return {r, g, b};
  }
  Vec inBox(const Vec& low, const Vec& high) {
    const double x = between(low.x, high.x), y = between(low.y, high.y), z = between(low.z, high.z);
    return {x, y, z};
  }
  // Turned any way, moved and of this size.
  Transform placement(const Vec& translate, double size) {
    Transform transform;
    transform.scale = gray(asFloat(size));
    transform.axis = inBox({-1, 0.3, -1}, {1, 1, 1});
    transform.degrees = between(10, 350);
    transform.translate = asFloat(translate);
    return transform;
  }

 private:
  std::mt19937 engine_;
};

// Appends random things to a scene.
class SceneMaker : public Random {
 public:
  using Random::Random;

  int add(Mesh mesh) { return append(scene.meshes, std::move(mesh)); }
  int add(const Material& material) { return append(scene.materials, material); }
  int addObject(Mesh mesh, const Material& material) {
    const int number = add(std::move(mesh));
    return append(scene.objects, {number, add(material), {}, {}});
  }
  int addSphere(double radius, const Material& material) {
    return append(scene.objects, {kNone, add(material), {}, {}, asFloat(radius)});
  }
  void place(int object, const Transform& transform, bool inPlace = false) {
    scene.bodies.push_back({object, transform, inPlace});
  }
  void add(Mesh mesh, const Material& material, const Transform& transform) {
    place(addObject(std::move(mesh), material), transform);
  }

  // A floor, a sky that is nowhere black, ambient light, and an eye that looks at what stands about
  // (0, 1, 0), from some 6 away.
  void room() {
    scene.sky.zenith = color(0.1, 0.6);
    scene.sky.horizon = color(0.3, 0.8);
    scene.sky.ground = color(0.05, 0.3);
    scene.ambient = {color(0.02, 0.2), color(0.02, 0.1)};

    scene.camera.eye = inBox({-2, 1, 5}, {2, 2.5, 6});
    scene.camera.at = inBox({-0.3, 0.7, -0.3}, {0.3, 1, 0.3});
    scene.camera.up = inBox({-0.2, 1, -0.2}, {0.2, 1, 0.2});
    scene.camera.fov = between(35, 50);

    floor(matte());
  }
  // The same from near, so that what is sampled fills the picture, and a lamp that few samples see
  // without much noise.
  void roomFromNear() {
    room();
    scene.camera.fov = between(24, 30);
    addLamp().intensity = color(2, 6);
  }
  // Somewhere just below 0, or at this height.
  void floor(const Material& material, std::optional<double> height = {}) {
    Transform transform;
    transform.scale = {9, 1, 9};
    transform.degrees = between(0, 90);
    transform.translate.y = between(-0.1, 0);
    if (height) transform.translate.y = *height;
    add(pane(), material, transform);
  }
  // What stands behind the middle of the picture, to be seen through glass.
  void thingsBehind() {
    add(box(), glossy(), placement({-1.4, 0.8, -2}, 0.9));
    add(tetrahedron(), matte(), placement({1.2, 0.9, -1.8}, 1));
  }
  // A point light somewhere above, on the eye's side. The reference ends with the next light.
  Light& addLamp() {
    Light& light = scene.lights.emplace_back();
    light.position = inBox({-4, 2.5, 1}, {4, 4.5, 4});
    light.intensity = color(8, 25);
    return light;
  }
  void addLamps(int count) {
    for (int i = 0; i < count; ++i) addLamp();
  }
  // A directional light with an irradiance within these bounds.
  void addSun(double low, double high) {
    Light& sun = scene.lights.emplace_back();
    sun.kind = Light::Kind::directional;
    sun.direction = inBox({-1, -2, -1}, {1, -0.5, 0.2});
    sun.intensity = color(low, high);
  }
  // Turns the lamp into a spot light that shines on the middle of the scene.
  void makeSpot(Light& lamp) {
    lamp.kind = Light::Kind::spot;
    lamp.direction = asFloat(inBox({-1, 0, -1}, {1, 1, 1}) - lamp.position);
    lamp.innerConeAngle = between(0, 15);
    lamp.outerConeAngle = between(20, 50);
  }
  // An image of texels within these bounds, of 255.
  void skyImage(double low, double high) {
    Sky& sky = scene.sky;
    sky.kind = Sky::Kind::image;
    sky.width = 7;
    sky.height = 4;
    sky.rotation = between(-180, 360);
    for (int i = 0; i < sky.width * sky.height; ++i) {
      const Color c = color(low, high);
      sky.texels.push_back(Color{std::floor(c.x), std::floor(c.y), std::floor(c.z)} / 256);
    }
  }
  // Moves everything in the scene.
  void moveBy(const Vec& way) {
    const auto move = [&](Vec& p) { p = asFloat(p + way); };
    for (Body& body : scene.bodies) move(body.transform.translate);
    for (Light& light : scene.lights) move(light.position);
    move(scene.camera.eye);
    move(scene.camera.at);
  }

  Material matte() {
    Material material;
    material.diffuse = color(0.2, 0.9);
    return material;
  }
  Material glossy() {
    Material material = matte();
    material.specular = color(0.05, 0.6);
    material.roughness = between(0.25, 0.8);
    return material;
  }
  // A highlight narrower than the light would be met by few samples, and by none of the oracle's.
  Material rough() {
    Material material = glossy();
    material.roughness = between(0.55, 0.9);
    return material;
  }
  Material mirror() {
    Material material = matte();
    material.mirror = color(0.2, 0.7);
    material.mirrorGrazing = chance(0.5) ? color(0.7, 1) : material.mirror;
    return material;
  }
  // Tinted and absorbing; `priority` as it is.
  Material glass(double ior, int priority = 0) {
    Material material;
    material.diffuse = chance(0.3) ? color(0.02, 0.1) : gray(0);
    material.transmission = color(0.6, 0.98);
    material.ior = asFloat(ior);
    material.absorption = color(0, 0.6);
    material.priority = priority;
    material.castsShadow = chance(0.3);
    return material;
  }
  Material anyGlass(int priority = 0) { return glass(between(1.2, 1.9), priority); }
  // The same with a mirroring coat.
  Material coated(Material material) {
    material.mirror = color(0.05, 0.2);
    material.mirrorGrazing = color(0.3, 0.6);
    return material;
  }

  // Glossy, of several textures.
  Material painted() {
    Material material = glossy();
    material.diffuseMap = addColors();
    if (chance(0.3)) material.specularMap = addColors();
    if (chance(0.3)) material.emission = color(0.2, 1);
    if (largest(material.emission) > 0) material.emissionMap = addColors();
    return material;
  }

  // Returns the number of the texture.
  int addTexture(const Texture& texture) { return append(scene.textures, texture); }
  // A texture of colors that are exact as sRGB, of a few texels; its number.
  int addColors() {
    const int width = 3 + below(12), height = 2 + below(7);
    return addColors(width, height);
  }
  int addColors(int width, int height) {
    Texture texture{width, height, {}};
    for (int i = 0; i < width * height; ++i) {
      const auto channel = [&] { return chance(0.5) ? 255 : 0; };
      const int r = channel(), g = channel(), b = channel();
      texture.texels.push_back({r, g, b});
    }
    return addTexture(texture);
  }
  // A texture of numbers within the box, all three of a texel at once; its number.
  int addData(int width, int height, const Color& low, const Color& high) {
    Texture texture{width, height, {}, true};
    for (int i = 0; i < width * height; ++i) {
      const Vec texel = inBox(low, high);
      texture.texels.push_back(
          {static_cast<int>(texel.x), static_cast<int>(texel.y), static_cast<int>(texel.z)});
    }
    return addTexture(texture);
  }
  // What a normal map has, half as high as wide.
  int addNormals(int width) { return addData(width, width / 2, {80, 80, 200}, {176, 176, 255.99}); }
  // Anything from nothing to all.
  int addMask() { return addData(16, 8, {}, {255.99, 1, 1}); }

  // A box, a tetrahedron or a ball.
  Mesh solid() {
    const int kind = below(3);
    if (kind == 0) return box();
    return kind == 1 ? tetrahedron() : ball(12, 8);
  }
  // In one of `count` places beside each other, so that nothing touches.
  Transform standing(int place, int count) {
    const double width = 4.4 / count;
    const double x = (place + 0.5 - 0.5 * count) * width;
    const Vec at{x, between(0.8, 1.3), between(-0.8, 0.8)};
    return placement(at, std::min(1.0, 0.57 * width) * between(0.8, 1));
  }

  Scene scene;

 private:
  // Appends the thing; its number in the list.
  template <typename Thing>
  static int append(std::vector<Thing>& things, std::type_identity_t<Thing> thing) {
    things.push_back(std::move(thing));
    return static_cast<int>(things.size()) - 1;
  }
};

}  // namespace oracle
