// Materials of glTF files: pictures of a square, their colors worked out by hand.
#include "core/display.h"
#include "gltf_pictures.h"
#include "has_text.h"

namespace whit {
namespace {

TEST_F(GltfMaterials, LambertianBaseColor) {
  expectColor(pixel(matte("\"baseColorFactor\":[0.5,0.25,1,1]")), {0.5f, 0.25f, 1});
}

// Straight on and with alpha 1, GGX's lobe is f0 / 4 pi: an eighth and a quarter of the base
// color.
TEST_F(GltfMaterials, RoughMetalReflectsItsBaseColor) {
  expectColor(pixel("{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.4,0.2,1]}}"),
              {0.2f, 0.1f, 0.05f});
}

// 1 for the albedo, 0.04 / 4 for the lobe.
TEST_F(GltfMaterials, RoughDielectricHasBoth) {
  expectColor(pixel("{\"pbrMetallicRoughness\":{\"metallicFactor\":0}}"),
              Rgb(1 - 0.04f * kRoughestAlbedo + 0.01f));
}

TEST_F(GltfMaterials, HalfMetalIsTheMean) {
  // The lobe reflects 0.5 * 0.04 + 0.5 * 0.8, of lamps a fourth of that, and leaves the rest to
  // 0.5 * 0.8.
  expectColor(pixel("{\"pbrMetallicRoughness\":{\"metallicFactor\":0.5,"
                    "\"baseColorFactor\":[0.8,0.8,0.8,1]}}"),
              Rgb(0.4f * (1 - 0.42f * kRoughestAlbedo) + 0.42f / 4));
}

TEST_F(GltfMaterials, SpecularExtensionSetsTheReflectance) {
  // Roughness 0.5 has alpha 0.25: straight on the lobe is f0 / (4 alpha^2) = 4 f0 here.
  expectColor(pixel("{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.5,"
                    "\"baseColorFactor\":[0,0,0,1]},\"extensions\":{\"KHR_materials_specular\":"
                    "{\"specularFactor\":0.5,\"specularColorFactor\":[1,0.5,0]},"
                    "\"KHR_materials_ior\":{\"ior\":1.5}}}"),
              {0.08f, 0.04f, 0});
}

TEST_F(GltfMaterials, TexturesAreUprightAndDecodedFromSrgb) {
  save("t.tga", tga(2, 2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {188, 188, 188}}));
  useImages({"t.tga"});
  const auto p = picture(
      {{0, matte("\"baseColorFactor\":[1,0.5,1,1],\"baseColorTexture\":{\"index\":0}"), 1}}, 2);
  const auto at = static_cast<float>(lit(0.5, 0.5));
  const auto gray = static_cast<float>(srgbToLinear(188 / 255.0));
  expectColor(p[0], Rgb{1, 0, 0} * at);
  expectColor(p[1], Rgb{0, 0.5f, 0} * at);
  expectColor(p[2], Rgb{0, 0, 1} * at);
  expectColor(p[3], Rgb{gray, gray / 2, gray} * at);
}

TEST_F(GltfMaterials, ImagesInDataUris) {
  DisplayImage image{1, 1, {0, 255, 0, 255}};
  images_ = ",\"images\":[{\"uri\":\"data:image/png;base64," + base64(encodePng(image)) +
            "\"}],\"textures\":[{\"source\":0}]";
  expectColor(pixel(matte("\"baseColorTexture\":{\"index\":0}")), {0, 1, 0});
}

TEST_F(GltfMaterials, TextureTransformsAndSamplers) {
  save("t.tga", tga(2, 2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}}));

  const auto show = [&](const std::string& transform) {
    return picture({{0,
                     matte("\"baseColorTexture\":{\"index\":0,\"extensions\":"
                           "{\"KHR_texture_transform\":{" +
                           transform + "}}}"),
                     1}},
                   2);
  };

  const auto at = static_cast<float>(lit(0.5, 0.5));
  const Rgb red = Rgb{1, 0, 0} * at, green = Rgb{0, 1, 0} * at, blue = Rgb{0, 0, 1} * at, white(at);
  const auto expectPicture = [&](const std::vector<Rgb>& got, const std::vector<Rgb>& wanted) {
    for (std::size_t i = 0; i < 4; ++i) expectColor(got[i], wanted[i]);
  };

  useImages({"t.tga"});
  expectPicture(show("\"offset\":[0.5,0]"), {green, red, white, blue});
  expectPicture(show("\"offset\":[0,0.5]"), {blue, white, red, green});
  // u' = v, v' = 1 - u: the image turned clockwise by a quarter.
  expectPicture(show("\"offset\":[0,1],\"rotation\":1.5707963267948966"),
                {blue, red, white, green});
  expectPicture(show("\"offset\":[0,1],\"scale\":[1,-1]"), {blue, white, red, green});

  useImages({"t.tga"}, "\"wrapS\":33071,\"wrapT\":10497");
  expectPicture(show("\"offset\":[1,0]"), {green, green, white, white});
  useImages({"t.tga"}, "\"wrapS\":33648");
  expectPicture(show("\"offset\":[1,0]"), {green, red, white, blue});
}

// Four pixels to each of two texels.
TEST_F(GltfMaterials, NearestSamplersDoNotInterpolate) {
  save("t.tga", tga(2, 1, {{255, 255, 255}, {0, 0, 0}}));
  const auto row = [&](const std::string& sampler) {
    useImages({"t.tga"}, sampler);
    return picture({{0, matte("\"baseColorTexture\":{\"index\":0}"), 1}}, 8);
  };
  const auto nearest = row("\"magFilter\":9728");
  for (std::size_t x = 0; x < 8; ++x) {
    const double at = (static_cast<double>(x) - 3.5) / 4;
    expectColor(nearest[x], Rgb(x < 4 ? static_cast<float>(lit(at, 0.875)) : 0.0f));
  }
  const auto linear = row("\"magFilter\":9729");
  expectColor(linear[3], Rgb(static_cast<float>(0.625 * lit(0.125, 0.875))));
}

// Ambient light is multiplied by 1 + strength (R - 1), the lamp is not.
TEST_F(GltfMaterials, OcclusionDimsIndirectLight) {
  save("o.tga", tga(2, 1, {{51, 255, 255}, {255, 0, 0}}));  // 0.2 and 1
  save("even.tga", tga(1, 1, {{255, 0, 0}}));
  useImages({"o.tga", "even.tga"});

  const auto show = [&](const std::string& rest, const char* image = "0") {
    SceneDescription d = loadText(sceneText(
        {{0, matte("", "\"occlusionTexture\":{\"index\":" + std::string(image) + rest + "}"), 1}}));
    d.ambient.up = d.ambient.down = Rgb(0.5f);
    return pictureOf(std::move(d), 2);
  };

  const auto lamp = static_cast<float>(lit(0.5, 0.5));
  expectColor(show("")[0], Rgb(lamp + 0.1f));
  expectColor(show("")[1], Rgb(lamp + 0.5f));
  expectColor(show(",\"strength\":0.5")[0], Rgb(lamp + 0.3f));
  expectColor(show(",\"strength\":0")[0], Rgb(lamp + 0.5f));
  expectColor(show("", "1")[0], Rgb(lamp + 0.5f));
  EXPECT_EQ(kinds(), "");
}

// The texture's blue is the metalness; its green, the roughness, is 1.
TEST_F(GltfMaterials, MetalnessTexelByTexel) {
  save("mr.tga", tga(2, 1, {{0, 255, 255}, {0, 255, 0}}));
  useImages({"mr.tga"});
  const auto p = picture({{0,
                           "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.8,0.4,0.2,1],"
                           "\"metallicRoughnessTexture\":{\"index\":0}}}",
                           1}},
                         2);

  // Off the middle the lobe of alpha 1 is f0 / (4 pi cos), which the cosine cancels.
  const double d2 = 0.25 + 0.25 + 9, lobe = 9 / (4 * d2);
  const auto metal = static_cast<float>(lobe), rest = static_cast<float>(lit(0.5, 0.5));
  expectColor(p[0], Rgb{0.8f, 0.4f, 0.2f} * metal);
  const float left = rest * (1 - 0.04f * kRoughestAlbedo);
  expectColor(p[1], Rgb{0.8f, 0.4f, 0.2f} * left + Rgb(0.04f * metal));
}

// Lit from the eye, the half vector is where both are: D V cos with Smith's correlated V.
TEST_F(GltfMaterials, RoughnessTexelByTexel) {
  save("mr.tga", tga(2, 1, {{0, 255, 255}, {0, 204, 255}}));  // 1 and 0.8
  useImages({"mr.tga"});
  const auto p = picture({{0,
                           "{\"pbrMetallicRoughness\":{\"roughnessFactor\":0.9,"
                           "\"metallicRoughnessTexture\":{\"index\":0}}}",
                           1}},
                         2);

  const auto lobe = [](double roughness) {
    const double a2 = std::pow(roughness, 4), cosine2 = 9 / 9.5;
    const double bell = cosine2 * (a2 - 1) + 1, root = std::sqrt(cosine2 * (1 - a2) + a2);
    return static_cast<float>(a2 / (bell * bell) / (4 * root) * cosine2);
  };

  expectColor(p[0], Rgb(lobe(0.9)));
  expectColor(p[1], Rgb(lobe(0.9 * 0.8)));
}

TEST_F(GltfMaterials, AreSingleSidedUnlessTheFileSaysOtherwise) {
  const auto isDoubleSided = [&](const std::string& rest) {
    const SceneDescription scene = loadText(sceneText({{0, "{\"name\":\"m\"" + rest + "}", 1}}));
    return Scene::finalize(SceneDescription(scene), warnings_).materials[0].doubleSided;
  };
  EXPECT_FALSE(isDoubleSided(""));
  EXPECT_TRUE(isDoubleSided(",\"doubleSided\":true"));
  // The ray has to leave what it has entered.
  EXPECT_TRUE(
      isDoubleSided(",\"pbrMetallicRoughness\":{\"metallicFactor\":0},\"extensions\":{\"KHR_"
                    "materials_transmission\":{\"transmissionFactor\":1},"
                    "\"KHR_materials_volume\":{\"thicknessFactor\":0.1}}"));
}

TEST_F(GltfMaterials, MeshesThatAreOnlySeenFromBehindAreNoted) {
  const auto notes = [&](const std::string& node, const std::string& material) {
    GltfBuilder b;
    const std::string text =
        b.json("\"materials\":[{" + material + "}],\"meshes\":[{\"primitives\":[" +
               triangle(b, ",\"material\":0") +
               "]}],\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1}}],"
               "\"nodes\":[{\"mesh\":0" +
               node + "},{\"camera\":0,\"translation\":[0,0,5]}]");
    Warnings strict(true);  // what is only noted is not refused
    Scene::finalize(loadText(text), strict);
    return strict.entries().size();
  };

  const std::string turned = ",\"rotation\":[0,1,0,0]", mirrored = ",\"scale\":[1,1,-1]";
  EXPECT_EQ(notes("", ""), 0u);
  EXPECT_EQ(notes(turned, ""), 1u);
  EXPECT_EQ(notes(turned, "\"doubleSided\":true"), 0u);

  options_.settings = {"/materials/*/doubleSided=true"};  // as the note says
  EXPECT_EQ(notes(turned, ""), 0u);
  options_.settings.clear();

  EXPECT_EQ(notes(mirrored, ""), 1u);
  EXPECT_EQ(notes(mirrored + turned, ""), 0u);
}

TEST_F(GltfMaterials, RoughnessThatIsTheSameAllOverNeedsNoMap) {
  save("even.tga", tga(2, 1, {{0, 51, 255}, {0, 51, 0}}));
  save("uneven.tga", tga(2, 1, {{0, 51, 255}, {0, 153, 255}}));
  useImages({"even.tga", "uneven.tga"});

  const auto load = [&](const std::string& index) {
    return loadText(sceneText({{0,
                                "{\"pbrMetallicRoughness\":{\"roughnessFactor\":0.5,"
                                "\"metallicRoughnessTexture\":{\"index\":" +
                                    index + "}}}",
                                1}}))
        .materials[0];
  };

  EXPECT_EQ(load("0").roughnessMap, kNoTexture);
  EXPECT_NEAR(load("0").roughness, 0.1f, 1e-6f);
  EXPECT_NE(load("1").roughnessMap, kNoTexture);
  EXPECT_EQ(load("1").roughness, 0.5f);
}

TEST_F(GltfMaterials, WhatIsGivenStaysEvenIfItIsWhatTheFileSaysWithoutItsMaps) {
  save("mr.tga", tga(2, 1, {{0, 51, 255}, {0, 153, 255}}));
  useImages({"mr.tga"});
  options_.settings = {"/materials//roughness=1"};
  const SceneDescription scene = loadText(sceneText(
      {{0, "{\"pbrMetallicRoughness\":{\"metallicRoughnessTexture\":{\"index\":0}}}", 1}}));
  EXPECT_EQ(scene.materials[0].roughness, 1);
  EXPECT_EQ(scene.materials[0].roughnessMap, kNoTexture);
}

TEST_F(GltfMaterials, MasksCutBelowTheCutoff) {
  save("t.tga", tga(2, 1, {{255, 255, 255, 100}, {255, 255, 255, 255}}));
  useImages({"t.tga"});

  const auto show = [&](const std::string& alpha, const std::string& rest) {
    return picture(
        {{0,
          matte("\"baseColorFactor\":[1,1,1," + alpha + "],\"baseColorTexture\":{\"index\":0}",
                "\"alphaMode\":\"MASK\"" + rest),
          1}},
        2);
  };

  const Rgb seen(static_cast<float>(lit(0.5, 0.5)));
  expectColor(show("1", "")[0], Rgb(0.0f));  // 100 / 255 is below 0.5
  expectColor(show("1", "")[1], seen);
  expectColor(show("1", ",\"alphaCutoff\":0.3")[0], seen);
  expectColor(show("0.75", ",\"alphaCutoff\":0.3")[0], Rgb(0.0f));  // 0.294 is below 0.3
}

TEST_F(GltfMaterials, MasksThatCutEverything) {
  const auto p =
      picture({{0, matte("\"baseColorFactor\":[1,1,1,0.25]", "\"alphaMode\":\"MASK\""), 1},
               {-1, glowing("[0.5,1,0]"), 4}},
              1);
  expectColor(p[0], {0.5f, 1, 0});
}

TEST_F(GltfMaterials, BlendingLetsTheRestThrough) {
  const std::string behind = glowing("[0.5,1,0]");
  const auto p =
      picture({{0, matte("\"baseColorFactor\":[1,1,1,0.25]", "\"alphaMode\":\"BLEND\""), 1},
               {-1, behind, 4}},
              1);
  expectColor(p[0], Rgb(0.25f) + Rgb{0.5f, 1, 0} * 0.75f);
}

TEST_F(GltfMaterials, BlendingCountsTexelByTexel) {
  // 0.2, 0.6; times the factor's alpha
  save("t.tga", tga(2, 1, {{255, 255, 255, 51}, {255, 255, 255, 153}}));
  save("even.tga", tga(2, 1, {{255, 255, 255, 102}, {255, 255, 255, 102}}));

  const auto show = [&](const std::string& image, const std::string& alpha) {
    useImages({image});
    return picture(
        {{0,
          matte("\"baseColorFactor\":[1,1,1," + alpha + "],\"baseColorTexture\":{\"index\":0}",
                "\"alphaMode\":\"BLEND\""),
          1},
         {-1, glowing("[1,0,0]"), 4}},
        2);
  };

  const auto blended = [](double alpha) {
    const auto own = static_cast<float>(alpha * lit(0.5, 0.5));
    return Rgb{own + static_cast<float>(1 - alpha), own, own};
  };

  for (const auto& [factor, text] : {std::pair(1.0, "1"), std::pair(0.5, "0.5")}) {
    const auto pixels = show("t.tga", text);
    expectColor(pixels[0], blended(0.2 * factor));
    expectColor(pixels[1], blended(0.6 * factor));
    expectColor(show("even.tga", text)[1], blended(0.4 * factor));
  }
}

TEST_F(GltfMaterials, BlendingThatIsTheSameAllOverNeedsNoMap) {
  save("even.tga", tga(2, 1, {{255, 255, 255, 102}, {9, 9, 9, 102}}));
  useImages({"even.tga"});
  const Material m =
      loadText(
          sceneText(
              {{0, matte("\"baseColorTexture\":{\"index\":0}", "\"alphaMode\":\"BLEND\""), 1}}))
          .materials[0];
  EXPECT_EQ(m.coverageMap, kNoTexture);
  EXPECT_EQ(m.alphaMap, kNoTexture);
  EXPECT_NEAR(m.coverage, 0.4f, 1e-6f);
}

TEST_F(GltfMaterials, TransmissionIsADielectric) {
  // Straight through one surface: 1 - ((1.5 - 1) / (1.5 + 1))^2 = 0.96 of the tinted light behind.
  candela_ = 0;
  const std::string glass =
      "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0,\"baseColorFactor\":"
      "[1,0.5,0.25,1]},\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}";
  const auto through = [&](const std::string& rest) {
    return picture({{0, glass + rest + "}}", 1}, {-2, glowing("[1,1,1]"), 9}}, 1)[0];
  };

  const std::string volume = ",\"KHR_materials_volume\":{\"thicknessFactor\":1}";
  expectColor(through(volume), Rgb{0.96f, 0.48f, 0.24f});

  // ior 2: a ninth is reflected.
  expectColor(through(volume + ",\"KHR_materials_ior\":{\"ior\":2}"), Rgb{8.0f, 4.0f, 2.0f} / 9.0f);

  // Over a distance of 2, the root of what a distance of 4 leaves.
  expectColor(through(",\"KHR_materials_volume\":{\"thicknessFactor\":1,\"attenuationDistance\":4,"
                      "\"attenuationColor\":[0.0625,1,1]}"),
              Rgb{0.24f, 0.48f, 0.24f});
}

// A wall that fades from white to black, behind a pane that is turned by 45 degrees. A surface of
// ior 1.5 bends the ray towards its normal, which leads to the left.
// A thin wall follows the extension, and a solid whose factors are 1 leaves out nothing.
TEST_F(GltfMaterials, SpecularFactorsOfSolidsAreSaidToBeLeftOut) {
  const char* const kind =
      "KHR_materials_specular of a material with a volume left out, but for the highlights of "
      "lights: it reflects by its ior alone";
  const auto warnedOf = [&](const std::string& specular, const std::string& thickness) {
    const std::uint64_t before = warned(kind);
    loadText(
        sceneText({{0,
                    "{\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
                    "\"KHR_materials_volume\":{\"thicknessFactor\":" +
                        thickness + "},\"KHR_materials_specular\":{" + specular + "}}}",
                    1}}));
    return warned(kind) - before;
  };

  EXPECT_EQ(warnedOf("\"specularFactor\":0.5", "1"), 1u);
  EXPECT_EQ(warnedOf("\"specularColorFactor\":[1,0,0]", "1"), 1u);
  EXPECT_EQ(warnedOf("\"specularFactor\":1,\"specularColorFactor\":[1,1,1]", "1"), 0u);
  EXPECT_EQ(warnedOf("\"specularFactor\":0.5", "0"), 0u);
}

TEST_F(GltfMaterials, WithoutAThicknessTransmissionDoesNotBendLight) {
  candela_ = 0;
  save("halves.tga", tga(2, 1, {{255, 255, 255}, {0, 0, 0}}));
  useImages({"halves.tga"}, "\"wrapS\":33071");
  // Between the middles of its two texels the wall is 0.5 - x / 4.
  const std::string wall =
      "{\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":0},\"pbrMetallicRoughness\":"
      "{\"baseColorFactor\":[0,0,0,1]}}";

  const auto seen = [&](const std::string& rest) {
    const std::string pane =
        "{\"doubleSided\":true,\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":"
        "0},"
        "\"extensions\":{\"KHR_materials_transmission\":{\"transmissionFactor\":1}" +
        rest + "}}";
    SceneDescription d = loadText(sceneText({{0, pane, 1}, {-1, wall, 4}}));
    d.instances.at(0).toWorld = Affine::rotation({0, 1, 0}, 45);
    return pictureOf(std::move(d), 1)[0].x;
  };

  // Through a thin wall the middle of the wall is seen, 1/2, but for what the pane reflects by
  // Schlick's law at 45 degrees.
  const double reflected = 0.04 + 0.96 * std::pow(1 - std::sqrt(0.5), 5);
  const auto thin = static_cast<float>(0.5 * (1 - reflected));
  EXPECT_NEAR(seen(""), thin, kClose);
  EXPECT_NEAR(seen(",\"KHR_materials_ior\":{\"ior\":2},\"KHR_materials_volume\":{}"),
              0.5 * (1 - 1.0 / 9 - 8.0 / 9 * std::pow(1 - std::sqrt(0.5), 5)), kClose);
  // An index of 0 stands for a reflectance of 1, times the color.
  const std::string all = ",\"KHR_materials_ior\":{\"ior\":0}";
  EXPECT_NEAR(seen(all), 0, kClose);
  EXPECT_NEAR(seen(all + ",\"KHR_materials_specular\":{\"specularColorFactor\":[0.25,0.25,0.25]}"),
              0.5 * 0.75 * (1 - std::pow(1 - std::sqrt(0.5), 5)), kClose);
  EXPECT_NEAR(seen(",\"KHR_materials_volume\":{\"thicknessFactor\":0,\"attenuationDistance\":1,"
                   "\"attenuationColor\":[0.1,0.1,0.1]}"),
              thin, kClose);

  // The exact Fresnel reflectance of ior 1.5 at 45 degrees is 0.0502.
  const double inside = std::asin(std::sin(kPi / 4) / 1.5), moved = std::tan(kPi / 4 - inside);
  EXPECT_NEAR(seen(",\"KHR_materials_volume\":{\"thicknessFactor\":1}"),
              (1 - 0.0502) * (0.5 + moved / 4), kClose);
}

TEST_F(GltfMaterials, SmoothSurfacesMirror) {
  candela_ = 0;
  const std::string behindTheEye = glowing("[1,1,1]");

  const auto mirrored = [&](const std::string& material) {
    return picture({{0, material, 1}, {6, behindTheEye, 9}}, 1)[0];
  };

  expectColor(mirrored("{\"pbrMetallicRoughness\":{\"roughnessFactor\":0,\"baseColorFactor\":"
                       "[0.9,0.6,0.3,1]}}"),
              {0.9f, 0.6f, 0.3f});
  expectColor(mirrored("{\"pbrMetallicRoughness\":{\"roughnessFactor\":0,\"metallicFactor\":0}}"),
              Rgb(0.04f));

  // Half of a lobe between smooth and rough.
  EXPECT_NEAR(mirrored("{\"pbrMetallicRoughness\":{\"roughnessFactor\":0.175}}").x, 0.5, 0.01);
  expectColor(mirrored("{\"pbrMetallicRoughness\":{\"roughnessFactor\":0.5}}"), Rgb(0.0f));
  expectColor(mirrored(matte("\"roughnessFactor\":1").insert(1, "\"name\":\"x\",")), Rgb(0.0f));
  expectColor(mirrored("{\"pbrMetallicRoughness\":{\"metallicFactor\":0},\"extensions\":"
                       "{\"KHR_materials_clearcoat\":{\"clearcoatFactor\":1}}}"),
              Rgb(0.04f));
}

// A rough white metal before a wall that glows, of which the tail of the lobe sees the edges.
TEST_F(GltfMaterials, RoughSurfacesReflectInSamples) {
  candela_ = 0;
  const auto reflected = [&](const std::string& material, int glossy) {
    const std::vector<Square> squares{{0, material, 1}, {6, glowing("[1,0.5,0.25]"), 60}};
    const Scene scene = Scene::finalize(loadText(sceneText(squares)), warnings_);

    RenderOptions options;
    options.size = ImageSize{1, 1};
    options.glossy = glossy;
    Renderer renderer(scene, options);
    Film film = makeFilm(scene, options);
    renderer.render(scene.cameras[0], film);
    return film.image.pixels[0];
  };

  const std::string rough = "{\"pbrMetallicRoughness\":{\"roughnessFactor\":0.5}}";
  expectColor(reflected(rough, 0), Rgb(0.0f));

  const Rgb seen = reflected(rough, 64);
  // Of alpha 1/4, a white lobe reflects 0.916 of an even light to who looks along the normal: the
  // integral of 2 c / (c + sqrt(c^2 (1 - alpha^2) + alpha^2)) over its samples; 64 of them.
  EXPECT_NEAR(seen.x, 0.916, 0.05);
  EXPECT_NEAR(seen.y, seen.x / 2, 1e-5);
  EXPECT_NEAR(seen.z, seen.x / 4, 1e-5);

  // Smooth: one impulse, whatever the number of samples.
  expectColor(reflected("{\"pbrMetallicRoughness\":{\"roughnessFactor\":0.03}}", 64),
              {1, 0.5f, 0.25f});

  // The facets of what bounds a volume reflect by its index of refraction.
  const std::string glass =
      "{\"pbrMetallicRoughness\":{\"metallicFactor\":0,\"roughnessFactor\":0.5},\"extensions\":"
      "{\"KHR_materials_transmission\":{\"transmissionFactor\":1},"
      "\"KHR_materials_volume\":{\"thicknessFactor\":1}}}";
  expectColor(reflected(glass, 64), Rgb(0.04f, 0.02f, 0.01f) * 0.916f);
  expectColor(reflected(glass, 0), Rgb{0.04f, 0.02f, 0.01f});
}

TEST_F(GltfMaterials, EmissionBelowAClearcoatIsSaidNotToBeDimmed) {
  const char* const kind =
      "emission below a clearcoat not dimmed by it: too bright by what the coat reflects";
  const auto warnedOf = [&](const std::string& coat, const std::string& emission) {
    const std::uint64_t before = warned(kind);
    loadText(sceneText(
        {{0,
          "{\"emissiveFactor\":" + emission +
              ",\"extensions\":{\"KHR_materials_clearcoat\":{\"clearcoatFactor\":" + coat + "}}}",
          1}}));
    return warned(kind) - before;
  };

  EXPECT_EQ(warnedOf("1", "[0,0.5,0]"), 1u);
  EXPECT_EQ(warnedOf("0", "[0,0.5,0]"), 0u);
  EXPECT_EQ(warnedOf("1", "[0,0,0]"), 0u);
}

TEST_F(GltfMaterials, EmissionAndUnlit) {
  candela_ = 0;
  expectColor(pixel("{\"emissiveFactor\":[0.5,0.25,0],\"extensions\":"
                    "{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":8}}}"),
              {4, 2, 0});
  expectColor(pixel("{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.25,1,1]},"
                    "\"extensions\":{\"KHR_materials_unlit\":{}}}"),
              {0.5f, 0.25f, 1});
}

// Codes of (0.6, 0, 0.8): tilted to the right, or upwards with red and green exchanged.
TEST_F(GltfMaterials, NormalMaps) {
  save("right.tga", tga(1, 1, {{204, 128, 230}}));
  save("up.tga", tga(1, 1, {{128, 204, 230}}));

  const double distance2 = 18, cosine = (0.6 + 0.8) / std::sqrt(2.0), arriving = 9 / distance2;
  const auto show = [&](const char* light, const std::string& image, const std::string& scale) {
    light_ = light;
    useImages({image});
    return pixel(matte("", "\"normalTexture\":{\"index\":0" + scale + "}"));
  };

  constexpr double kCode = 0.01;  // of a normal in 8 bits
  const Rgb facing(static_cast<float>(arriving * cosine));
  expectColor(show("3,0,3", "right.tga", ""), facing, kCode);
  expectColor(show("0,3,3", "up.tga", ""), facing, kCode);

  const double away = (0.8 - 0.6) / std::sqrt(2.0);
  expectColor(show("-3,0,3", "right.tga", ""), Rgb(static_cast<float>(arriving * away)), kCode);
  expectColor(show("0,-3,3", "up.tga", ""), Rgb(static_cast<float>(arriving * away)), kCode);

  const double half = (0.3 + 0.8) / std::sqrt(2 * (0.09 + 0.64));
  expectColor(show("3,0,3", "right.tga", ",\"scale\":0.5"),
              Rgb(static_cast<float>(arriving * half)), kCode);
}

// Of two primitives only one has mappings.
TEST_F(GltfMaterials, AVariantHasMaterialsOfItsOwn) {
  GltfBuilder b;
  const std::string mapped =
      ",\"material\":0,\"extensions\":{\"KHR_materials_variants\":{\"mappings\":["
      "{\"material\":1,\"variants\":[0]},{\"material\":2,\"variants\":[1,2]}]}}";
  const std::string first = triangle(b, mapped), second = triangle(b, ",\"material\":0");
  const std::string model =
      save("m.gltf",
           b.json("\"materials\":[{\"name\":\"plain\"},{\"name\":\"red\"},{\"name\":\"blue\"}],"
                  "\"extensions\":{\"KHR_materials_variants\":{\"variants\":[{\"name\":\"a\"},"
                  "{\"name\":\"b\"},{\"name\":\"c\"}]}}," +
                  oneMesh(first + "," + second)));

  const auto names = [](const SceneDescription& scene) {
    std::string found;
    for (const Object& object : scene.objects) {
      found += scene.materials.at(object.meshes.at(0).materials.at(0)).name + " ";
    }
    return found;
  };

  const SceneDescription plain = load(model);
  EXPECT_EQ(names(plain), "plain plain ");
  EXPECT_EQ(plain.variants, (std::vector<std::string>{"a", "b", "c"}));

  EXPECT_EQ(names(loadMembers(R"("scene": [{"model": "m.gltf", "variant": "a"}])")), "red plain ");

  options_.settings = {"/variant=\"c\""};
  EXPECT_EQ(names(load(model)), "blue plain ");

  options_.settings = {"/variant=\"cc\""};
  EXPECT_TRUE(hasText(errorOfFile(model), "m.gltf#/variant: expected one of \"a\", \"b\", \"c\""));

  const std::string obj = save("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_TRUE(hasText(errorOfFile(obj), "the model has none"));
}

}  // namespace
}  // namespace whit
