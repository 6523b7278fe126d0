// Pictures of a square with a material of a glTF file.
#pragma once

#include <cmath>

#include "core/display.h"
#include "gltf_files.h"
#include "inspect/reference_frame.h"
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

// The linear light of code 188 in sRGB.
inline constexpr float kCode188 = 0.502886f;

using Colors = std::vector<Rgb>;

// [-1, 1]^2 at `z`, facing +z, its texture upright and not mirrored as seen from there.
struct Square {
  std::string material;  // JSON
  double z = 0, size = 1;
};

// Seen from (0, 0, 3) by a camera that holds exactly [-1, 1]^2 of the plane z = 0.
class GltfMaterials : public GltfTest {
 protected:
  // What they are lit with is the light at the eye alone.
  GltfMaterials() {
    options_.sky = "none";
    rendering_.threads = 1;
    rendering_.shading.textureFilter = TextureFilter::bilinear;  // the tests compare texels
  }

  SceneDescription loadSquares(const std::vector<Square>& squares) {
    GltfBuilder b;
    const std::string indices = b.indices({0, 1, 2, 0, 2, 3});
    std::string attributes = ",'TEXCOORD_0':" + b.floats("VEC2", {0, 1, 1, 1, 1, 0, 0, 0});

    std::vector<float> colors = colors_;
    for (const float alpha : alphas_) colors.insert(colors.end(), {1, 1, 1, alpha});
    if (!colors.empty()) {
      attributes += ",'COLOR_0':" + b.floats(joined("VEC", colors.size() / 4), colors);
    }
    if (!secondUvs_.empty()) attributes += ",'TEXCOORD_1':" + b.floats("VEC2", secondUvs_);

    std::string meshes, nodes, materials;
    for (const Square& square : squares) {
      const auto z = static_cast<float>(square.z), s = static_cast<float>(square.size);
      const std::string position = b.positions({-s, -s, z, s, -s, z, s, s, z, -s, s, z});
      const std::string number = joined(&square - squares.data());
      addItem(materials, square.material);
      addItem(meshes, "{'primitives':[" +
                          primitive(position, attributes,
                                    ",'material':" + number + ",'indices':" + indices) +
                          "]}");
      nodes += "{'mesh':" + number + "},";
    }

    return loadText(b.json(joined(
        "'materials':[", materials, "],'meshes':[", meshes, "],'nodes':[", nodes,
        "{'camera':0,'translation':[0,0,3]},{'translation':[", light_,
        "],'extensions':{'KHR_lights_punctual':{'light':0}}}],'cameras':[{'type':'perspective',"
        "'perspective':{'znear':1,'yfov':",
        2 * std::atan(1.0 / 3),
        "}}],'extensions':{'KHR_lights_punctual':{'lights':[{'type':'point','intensity':",
        683 * candela_, "}]}}", images_)));
  }

  SceneDescription loadMaterial(const std::string& material) { return loadSquares({{material}}); }

  // n x n pixels, row by row from the top.
  Colors pictureOf(SceneDescription description, int n) {
    const Scene scene = bake(std::move(description));
    rendering_.size = ImageSize{n, n};
    return pixelsOf(scene);
  }

  // The picture of the first camera, traced in packets or by the reference.
  Colors pixelsOf(const Scene& scene, bool reference = false) const {
    Renderer renderer(scene, rendering_);
    Film film = makeFilm(scene, rendering_);
    if (reference) {
      renderReference(renderer, scene.cameras[0], film);
    } else {
      renderer.render(scene.cameras[0], film);
    }
    return film.image.pixels;
  }

  Colors picture(const std::vector<Square>& squares, int n = 1) {
    return pictureOf(loadSquares(squares), n);
  }

  Colors picture(const std::string& material, int n = 1) {
    return pictureOf(loadMaterial(material), n);
  }

  // Textures 0, 1, ...: images beside the scene. Each has the sampler of its number, or the last.
  void useImages(const std::vector<std::string>& files,
                 const std::vector<std::string>& samplers = {""}) {
    std::string images, textures, all;
    for (const std::string& sampler : samplers) addItem(all, "{" + sampler + "}");
    for (std::size_t i = 0; i < files.size(); ++i) {
      addItem(images, "{'uri':'" + files[i] + "'}");
      const std::size_t sampler = std::min(i, samplers.size() - 1);
      addItem(textures, joined("{'source':", i, ",'sampler':", sampler, "}"));
    }
    images_ = joined(",'images':[", images, "],'textures':[", textures, "],'samplers':[", all, "]");
  }

  // Textures 0, 1, ... of one row each, with equal samplers.
  void useRows(const std::vector<Texels>& rows, const std::string& sampler = "") {
    std::vector<std::string> files;
    for (const Texels& row : rows) {
      files.push_back(joined(files.size(), ".tga"));
      saveImage(files.back(), row);
    }
    useImages(files, std::vector(files.size(), sampler));
  }

  // Of what is no metal, without a highlight.
  static std::string matte(const std::string& pbr, const std::string& rest = "") {
    return "{'pbrMetallicRoughness':{'metallicFactor':0" + (pbr.empty() ? "" : "," + pbr) +
           "},'extensions':{'KHR_materials_specular':{'specularFactor':0}}" +
           (rest.empty() ? "" : "," + rest) + "}";
  }
  static std::string glowing(const std::string& color) {
    return matte("'baseColorFactor':[0,0,0,1]", "'doubleSided':true,'emissiveFactor':" + color);
  }

  // Lit from the eye, a white Lambertian square is seen as this at (x, y) of its plane: as 1 in the
  // middle.
  static float lit(double x, double y) {
    return static_cast<float>(27 / std::pow(x * x + y * y + 9, 1.5));
  }

  // A lobe of alpha 1 and reflectance 1 is 1 / (4 pi cos), which the cosine cancels.
  static float lobeAt(double x, double y) {
    return static_cast<float>(9 / (4 * (x * x + y * y + 9)));
  }

  static Rgb gray(double x) { return Rgb(static_cast<float>(x)); }

  static void expectColor(const Rgb& got, const Rgb& wanted, double tolerance = kClose) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], wanted[i], tolerance) << "channel " << i;
  }

  // Expects these colors at the beginning of a picture or texture.
  static void expectColors(const Colors& got, const Colors& wanted, double tolerance = kClose) {
    ASSERT_GE(got.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      SCOPED_TRACE(i);
      expectColor(got[i], wanted[i], tolerance);
    }
  }

  // Expects what a pixel in the middle of a square shows.
  struct Shown {
    std::string material;
    Rgb color;
  };
  void expectShown(const std::vector<Shown>& all) {
    for (const auto& [material, color] : all) {
      SCOPED_TRACE(material);
      expectColor(picture(material)[0], color);
    }
  }

  // Expects how often loading each of these materials warns of something.
  void expectWarnings(const std::string& kind,
                      const std::vector<std::pair<std::string, std::uint64_t>>& materials) {
    std::uint64_t all = warned(kind);
    for (const auto& [material, count] : materials) {
      SCOPED_TRACE(material);
      loadMaterial(material);
      expectWarned(kind, all += count);
    }
  }

  // Of the squares' corners, from the lower left; empty: none.
  std::vector<float> colors_, alphas_, secondUvs_;
  double candela_ = 9 * kPi;  // at 683 lm/W
  std::string light_ = "0,0,3", images_;
  RenderOptions rendering_;
};

}  // namespace whit
