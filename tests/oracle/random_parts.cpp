#include "oracle/random_parts.h"

#include "oracle/shapes.h"

namespace oracle {

Transform Random::placement(const Vec& translate, double size) {
  Transform transform;
  transform.scale = gray(asFloat(size));
  transform.axis = inBox({-1, 0.3, -1}, {1, 1, 1});
  transform.degrees = between(10, 350);
  transform.translate = asFloat(translate);
  return transform;
}

int SceneMaker::add(Mesh mesh) {
  scene.meshes.push_back(std::move(mesh));
  return static_cast<int>(scene.meshes.size()) - 1;
}

int SceneMaker::add(const Material& material) {
  scene.materials.push_back(material);
  return static_cast<int>(scene.materials.size()) - 1;
}

int SceneMaker::addObject(Mesh mesh, const Material& material) {
  const int number = add(std::move(mesh));
  scene.objects.push_back({number, add(material), {}, {}});
  return static_cast<int>(scene.objects.size()) - 1;
}

int SceneMaker::addSphere(double radius, const Material& material) {
  Object object;
  object.mesh = kNone;
  object.material = add(material);
  object.radius = asFloat(radius);
  scene.objects.push_back(object);
  return static_cast<int>(scene.objects.size()) - 1;
}

void SceneMaker::room() {
  scene.sky.zenith = random.color(0.1, 0.6);
  scene.sky.horizon = random.color(0.3, 0.8);
  scene.sky.ground = random.color(0.05, 0.3);
  scene.ambient = {random.color(0.02, 0.2), random.color(0.02, 0.1)};

  scene.camera.eye = random.inBox({-2, 1, 5}, {2, 2.5, 6});
  scene.camera.at = random.inBox({-0.3, 0.7, -0.3}, {0.3, 1, 0.3});
  scene.camera.up = random.inBox({-0.2, 1, -0.2}, {0.2, 1, 0.2});
  scene.camera.fov = random.between(35, 50);

  floor(matte());
}

void SceneMaker::roomFromNear() {
  room();
  scene.camera.fov = random.between(24, 30);

  Light light = lamp();
  light.intensity = random.color(2, 6);
  scene.lights.push_back(light);
}

void SceneMaker::floor(const Material& material) {
  Transform transform;
  transform.scale = {9, 1, 9};
  transform.degrees = random.between(0, 90);
  transform.translate = {0, random.between(-0.1, 0), 0};
  add(pane(), material, transform);
}

Light SceneMaker::lamp() {
  Light light;
  light.position = random.inBox({-4, 2.5, 1}, {4, 4.5, 4});
  light.intensity = random.color(8, 25);
  return light;
}

void SceneMaker::addLamps(int count) {
  for (int i = 0; i < count; ++i) scene.lights.push_back(lamp());
}

void SceneMaker::moveBy(const Vec& way) {
  const auto move = [&](Vec& p) { p = asFloat(p + way); };
  for (Body& body : scene.bodies) move(body.transform.translate);
  for (Light& light : scene.lights) move(light.position);
  move(scene.camera.eye);
  move(scene.camera.at);
}

Material SceneMaker::matte() {
  Material material;
  material.diffuse = random.color(0.2, 0.9);
  return material;
}

Material SceneMaker::glossy() {
  Material material = matte();
  material.specular = random.color(0.05, 0.6);
  material.roughness = random.between(0.25, 0.8);
  return material;
}

Material SceneMaker::rough() {
  Material material = glossy();
  material.roughness = random.between(0.55, 0.9);
  return material;
}

Material SceneMaker::mirror() {
  Material material = matte();
  material.mirror = random.color(0.2, 0.7);
  material.mirrorGrazing = random.chance(0.5) ? random.color(0.7, 1) : material.mirror;
  return material;
}

Material SceneMaker::glass(double ior, int priority) {
  Material material;
  material.diffuse = random.chance(0.3) ? random.color(0.02, 0.1) : gray(0);
  material.transmission = random.color(0.6, 0.98);
  material.ior = asFloat(ior);
  material.absorption = random.color(0, 0.6);
  material.priority = priority;
  material.castsShadow = random.chance(0.3);
  return material;
}

Material SceneMaker::painted() {
  Material material = glossy();
  material.diffuseMap = addColors();
  if (random.chance(0.3)) material.specularMap = addColors();
  if (random.chance(0.3)) material.emission = random.color(0.2, 1);
  if (largest(material.emission) > 0) material.emissionMap = addColors();
  return material;
}

int SceneMaker::addTexture(const Texture& texture) {
  scene.textures.push_back(texture);
  return static_cast<int>(scene.textures.size()) - 1;
}

int SceneMaker::addColors() {
  const int width = 3 + random.below(12), height = 2 + random.below(7);
  return addColors(width, height);
}

int SceneMaker::addColors(int width, int height) {
  Texture texture{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    const auto channel = [&] { return random.chance(0.5) ? 255 : 0; };
    const int r = channel(), g = channel(), b = channel();
    texture.texels.push_back({r, g, b});
  }
  return addTexture(texture);
}

int SceneMaker::addData(int width, int height, const Color& low, const Color& high) {
  Texture texture{width, height, {}, true};
  for (int i = 0; i < width * height; ++i) {
    const Vec texel = random.inBox(low, high);
    texture.texels.push_back(
        {static_cast<int>(texel.x), static_cast<int>(texel.y), static_cast<int>(texel.z)});
  }
  return addTexture(texture);
}

Mesh SceneMaker::solid() {
  switch (random.below(3)) {
    case 0:
      return box();
    case 1:
      return tetrahedron();
    default:
      return ball(12, 8);
  }
}

Transform SceneMaker::standing(int place, int count) {
  const double width = 4.4 / count;
  const double x = (place + 0.5 - 0.5 * count) * width;
  const Vec at{x, random.between(0.8, 1.3), random.between(-0.8, 0.8)};
  return random.placement(at, std::min(1.0, 0.57 * width) * random.between(0.8, 1));
}

}  // namespace oracle
