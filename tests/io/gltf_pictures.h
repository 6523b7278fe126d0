// Pictures of a square with a material of a glTF file.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/display.h"
#include "gltf_files.h"
#include "io/image/image_file.h"
#include "pi.h"
#include "render/renderer.h"

namespace whit {

// Some roundings of float, and of texels to 10 bits of their square roots.
inline constexpr double kClose = 2e-3;

// The share of even light that a lobe of roughness 1 and reflectance 1 reflects along the normal,
// 1 - ln 2: the integral of c / (1 + c) over [0, 1]. It takes so much from the color below. A
// little off the normal it differs by less than kClose where the reflectance is 0.04.
inline constexpr float kRoughestAlbedo = 0.30685282f;

// [-1, 1]^2 at `z`, facing +z, its texture upright and not mirrored as seen from there.
struct Square {
  double z = 0;
  std::string material;  // JSON
  double size = 1;
};

// Seen from (0, 0, 3) by a camera that holds exactly [-1, 1]^2 of the plane z = 0.
class GltfMaterials : public GltfTest {
 protected:
  // What they are lit with is the light at the eye alone.
  GltfMaterials() { options_.sky = "none"; }

  std::string sceneText(const std::vector<Square>& squares) {
    GltfBuilder b;
    const std::string uv = b.uvs({0, 1, 1, 1, 1, 0, 0, 0});
    const std::string indices = b.indices({0, 1, 2, 0, 2, 3});

    std::string attributes = ",\"TEXCOORD_0\":" + uv;
    if (!colors_.empty()) {
      attributes += ",\"COLOR_0\":" + b.accessor(b.view(bytesOf(colors_)), 5126, "VEC3", 4);
    }
    if (!alphas_.empty()) {
      std::vector<float> rgba;
      for (const float alpha : alphas_) rgba.insert(rgba.end(), {1, 1, 1, alpha});
      attributes += ",\"COLOR_0\":" + b.accessor(b.view(bytesOf(rgba)), 5126, "VEC4", 4);
    }
    if (!secondUvs_.empty()) attributes += ",\"TEXCOORD_1\":" + b.uvs(secondUvs_);

    std::string meshes, nodes, roots, materials;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      const auto z = static_cast<float>(squares[i].z), s = static_cast<float>(squares[i].size);
      const std::string position = b.positions({-s, -s, z, s, -s, z, s, s, z, -s, s, z});
      const std::string comma = i > 0 ? "," : "", number = std::to_string(i);
      materials += comma + squares[i].material;
      const std::string shown =
          primitive(position, attributes, ",\"material\":" + number + ",\"indices\":" + indices);
      meshes += comma + "{\"primitives\":[" + shown + "]}";
      nodes += "{\"mesh\":" + number + "},";
      roots += number + ",";
    }

    const std::string n = std::to_string(squares.size());
    const double cd = 683 * candela_;
    return b.json("\"materials\":[" + materials + "],\"meshes\":[" + meshes + "],\"nodes\":[" +
                  nodes + "{\"camera\":0,\"translation\":[0,0,3]},{\"translation\":[" + light_ +
                  "],\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}}}],\"scenes\":"
                  "[{\"nodes\":[" +
                  roots + n + "," + std::to_string(squares.size() + 1) +
                  "]}],"
                  "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"znear\":1,\"yfov\":" +
                  std::to_string(2 * std::atan(1.0 / 3)) +
                  "}}],\"extensions\":"
                  "{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"point\",\"intensity\":" +
                  std::to_string(cd) + "}]}}" + images_);
  }

  // n x n pixels, row by row from the top.
  std::vector<Rgb> picture(const std::vector<Square>& squares, int n) {
    return pictureOf(loadText(sceneText(squares)), n);
  }
  std::vector<Rgb> pictureOf(SceneDescription description, int n) {
    const Scene scene = Scene::finalize(std::move(description), warnings_);
    RenderOptions options;
    options.size = ImageSize{n, n};
    options.threads = 1;
    options.shading.textureFilter = TextureFilter::bilinear;  // the tests compare texels
    Renderer renderer(scene, options);
    Film film = makeFilm(scene, options);
    renderer.render(scene.cameras[0], film);
    return film.image.pixels;
  }
  Rgb pixel(const std::string& material) { return picture({{0, material, 1}}, 1)[0]; }

  // Textures 0, 1, ...: images beside the scene, by their own samplers.
  void useImages(const std::vector<std::string>& files, const std::string& sampler = "") {
    std::string images, textures;
    for (std::size_t i = 0; i < files.size(); ++i) {
      const std::string comma = i > 0 ? "," : "";
      images += comma + "{\"uri\":\"" + files[i] + "\"}";
      textures += comma + "{\"source\":" + std::to_string(i) +
                  (sampler.empty() ? "" : ",\"sampler\":0") + "}";
    }
    images_ = ",\"images\":[" + images + "],\"textures\":[" + textures + "]" +
              (sampler.empty() ? "" : ",\"samplers\":[{" + sampler + "}]");
  }

  // Of what is no metal, without a highlight.
  static std::string matte(const std::string& pbr, const std::string& rest = "") {
    return "{\"pbrMetallicRoughness\":{\"metallicFactor\":0" + (pbr.empty() ? "" : "," + pbr) +
           "},\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0}}" +
           (rest.empty() ? "" : "," + rest) + "}";
  }
  static std::string glowing(const std::string& color) {
    return matte("\"baseColorFactor\":[0,0,0,1]",
                 "\"doubleSided\":true,\"emissiveFactor\":" + color);
  }

  // Lit from the eye, a white Lambertian square is seen as this at (x, y) of its plane: as 1 in the
  // middle.
  static double lit(double x, double y) {
    const double d = std::sqrt(x * x + y * y + 9);
    return 27 / (d * d * d);
  }
  static void expectColor(const Rgb& got, const Rgb& wanted, double tolerance = kClose) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], wanted[i], tolerance) << "channel " << i;
  }

  // Of the squares' corners, from the lower left; empty: none.
  std::vector<float> colors_, alphas_, secondUvs_;
  double candela_ = 9 * kPi;  // at 683 lm/W
  std::string light_ = "0,0,3", images_;
};

}  // namespace whit
