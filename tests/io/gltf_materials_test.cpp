// Materials of glTF files: pictures of a square, their colors worked out by hand.
#include "gltf_pictures.h"

namespace whit {
namespace {

TEST_F(GltfMaterials, FactorsOfColorMetalAndReflectance) {
  expectShown({
      {matte("'baseColorFactor':[0.5,0.25,1,1]"), {0.5f, 0.25f, 1}},

      // A rough metal. Straight on and with alpha 1, GGX's lobe is f0 / 4 pi: an eighth and a
      // quarter of the base color.
      {"{'pbrMetallicRoughness':{'baseColorFactor':[0.8,0.4,0.2,1]}}", {0.2f, 0.1f, 0.05f}},

      // A rough dielectric: 1 for the albedo, 0.04 / 4 for the lobe.
      {"{'pbrMetallicRoughness':{'metallicFactor':0}}", Rgb(1 - 0.04f * kRoughestAlbedo + 0.01f)},

      // Half a metal is the mean. The lobe reflects 0.5 * 0.04 + 0.5 * 0.8, of lamps a fourth of
      // that, and leaves the rest to 0.5 * 0.8.
      {"{'pbrMetallicRoughness':{'metallicFactor':0.5,'baseColorFactor':[0.8,0.8,0.8,1]}}",
       Rgb(0.4f * (1 - 0.42f * kRoughestAlbedo) + 0.42f / 4)},

      // Roughness 0.5 has alpha 0.25: straight on the lobe is f0 / (4 alpha^2) = 4 f0 here.
      {"{'pbrMetallicRoughness':{'metallicFactor':0,'roughnessFactor':0.5,'baseColorFactor':[0,0,0,"
       "1]},'extensions':{'KHR_materials_specular':{'specularFactor':0.5,'specularColorFactor':[1,"
       "0.5,0]},'KHR_materials_ior':{'ior':1.5}}}",
       {0.08f, 0.04f, 0}},
  });
}

TEST_F(GltfMaterials, TexturesAreUprightAndDecodedFromSrgb) {
  saveImage("t.tga", {"ff0000", "00ff00", "0000ff", "bcbcbc"}, 2);
  useImages({"t.tga"});
  const float at = lit(0.5, 0.5);
  expectColors(picture(matte("'baseColorFactor':[1,0.5,1,1],'baseColorTexture':{'index':0}"), 2),
               {Rgb{1, 0, 0} * at, Rgb{0, 0.5f, 0} * at, Rgb{0, 0, 1} * at,
                Rgb{1, 0.5f, 1} * (kCode188 * at)});

  // Images may be in data URIs.
  images_ = ",'images':[{'uri':'data:image/png;base64," +
            base64(encodePng(DisplayImage{1, 1, {0, 255, 0, 255}})) +
            "'}],'textures':[{'source':0}]";
  expectShown({{matte("'baseColorTexture':{'index':0}"), {0, 1, 0}}});
}

TEST_F(GltfMaterials, TextureTransformsAndSamplers) {
  saveImage("t.tga", {"ff0000", "00ff00", "0000ff", "ffffff"}, 2);
  const float at = lit(0.5, 0.5);
  const Rgb red = Rgb{1, 0, 0} * at, green = Rgb{0, 1, 0} * at, blue = Rgb{0, 0, 1} * at, white(at);

  struct Case {
    std::string sampler, transform;
    Colors colors;
  };
  const Case cases[] = {
      {"", "'offset':[0.5,0]", {green, red, white, blue}},
      {"", "'offset':[0,0.5]", {blue, white, red, green}},
      // u' = v, v' = 1 - u: the image turned clockwise by a quarter.
      {"", "'offset':[0,1],'rotation':1.5707963267948966", {blue, red, white, green}},
      {"", "'offset':[0,1],'scale':[1,-1]", {blue, white, red, green}},
      {"'wrapS':33071,'wrapT':10497", "'offset':[1,0]", {green, green, white, white}},
      {"'wrapS':33648", "'offset':[1,0]", {green, red, white, blue}},
  };
  for (const auto& [sampler, transform, colors] : cases) {
    SCOPED_TRACE(sampler + transform);
    useImages({"t.tga"}, {sampler});
    expectColors(
        picture(matte("'baseColorTexture':{'index':0,'extensions':{'KHR_texture_transform':{" +
                      transform + "}}}"),
                2),
        colors);
  }
}

// Four pixels to each of two texels.
TEST_F(GltfMaterials, NearestSamplersDoNotInterpolate) {
  const auto row = [&](const std::string& sampler) {
    useRows({{"ffffff", "000000"}}, sampler);
    return picture(matte("'baseColorTexture':{'index':0}"), 8);
  };
  Colors wanted;
  for (const double x : {-3.5, -2.5, -1.5, -0.5}) wanted.emplace_back(lit(x / 4, 0.875));
  wanted.resize(8, Rgb(0.0f));
  expectColors(row("'magFilter':9728"), wanted);
  expectColor(row("'magFilter':9729")[3], Rgb(0.625f * lit(0.125, 0.875)));
}

// Ambient light is multiplied by 1 + strength (R - 1), the lamp is not.
TEST_F(GltfMaterials, OcclusionDimsIndirectLight) {
  useRows({{"33ffff", "ff0000"}, {"ff0000"}});  // 0.2 and 1, and 1
  const auto expectAmbient = [&](const std::string& texture, const std::vector<float>& ambient) {
    SceneDescription d = loadMaterial(matte("", "'occlusionTexture':{'index':" + texture + "}"));
    d.ambient.up = d.ambient.down = Rgb(0.5f);
    const Colors shown = pictureOf(std::move(d), 2);
    for (std::size_t i = 0; i < ambient.size(); ++i) {
      expectColor(shown[i], Rgb(lit(0.5, 0.5) + ambient[i]));
    }
  };

  expectAmbient("0", {0.1f, 0.5f});
  expectAmbient("0,'strength':0.5", {0.3f});
  expectAmbient("0,'strength':0", {0.5f});
  expectAmbient("1", {0.5f});
  expectNoWarnings();
}

// The texture's blue is the metalness; its green, the roughness, is 1.
TEST_F(GltfMaterials, MetalnessTexelByTexel) {
  useRows({{"00ffff", "00ff00"}});
  const Rgb color{0.8f, 0.4f, 0.2f};
  const float lobe = lobeAt(0.5, 0.5);
  expectColors(
      picture("{'pbrMetallicRoughness':{'baseColorFactor':[0.8,0.4,0.2,1],"
              "'metallicRoughnessTexture':{'index':0}}}",
              2),
      {color * lobe, color * (lit(0.5, 0.5) * (1 - 0.04f * kRoughestAlbedo)) + Rgb(0.04f * lobe)});
}

// Lit from the eye, the half vector is where both are: D V cos with Smith's correlated V.
TEST_F(GltfMaterials, RoughnessTexelByTexel) {
  const auto lobe = [](double roughness) {
    const double a2 = std::pow(roughness, 4), cosine2 = 9 / 9.5;
    const double bell = cosine2 * (a2 - 1) + 1, root = std::sqrt(cosine2 * (1 - a2) + a2);
    return gray(a2 / (bell * bell) / (4 * root) * cosine2);
  };

  useRows({{"00ffff", "00ccff"}});  // 1 and 0.8
  expectColors(
      picture(
          "{'pbrMetallicRoughness':{'roughnessFactor':0.9,'metallicRoughnessTexture':{'index':0}}}",
          2),
      {lobe(0.9), lobe(0.9 * 0.8)});
}

TEST_F(GltfMaterials, AreSingleSidedUnlessTheFileSaysOtherwise) {
  const auto isDoubleSided = [&](const std::string& members) {
    return bake(loadMaterial("{" + members + "}")).materials[0].doubleSided;
  };
  EXPECT_FALSE(isDoubleSided(""));
  EXPECT_TRUE(isDoubleSided("'doubleSided':true"));
  // The ray has to leave what it has entered.
  EXPECT_TRUE(isDoubleSided(
      "'pbrMetallicRoughness':{'metallicFactor':0},'extensions':{'KHR_materials_transmission':{"
      "'transmissionFactor':1},'KHR_materials_volume':{'thicknessFactor':0.1}}"));
}

TEST_F(GltfMaterials, MeshesThatAreOnlySeenFromBehindAreNoted) {
  const auto notes = [&](const std::string& node, const std::string& material) {
    const SceneDescription scene = loadText(json(
        "'materials':[{" + material + "}],'meshes':[{'primitives':[" + triangle(",'material':0") +
        "]}],'cameras':[{'type':'perspective','perspective':{'yfov':1}}],'nodes':[{'mesh':0" +
        node + "},{'camera':0,'translation':[0,0,5]}]"));
    Warnings strict(true);  // what is only noted is not refused
    Scene::finalize(SceneDescription(scene), strict);
    return strict.entries().size();
  };

  const std::string turned = ",'rotation':[0,1,0,0]", mirrored = ",'scale':[1,1,-1]";
  EXPECT_EQ(notes("", ""), 0u);
  EXPECT_EQ(notes(turned, ""), 1u);
  EXPECT_EQ(notes(turned, "'doubleSided':true"), 0u);
  EXPECT_EQ(notes(mirrored, ""), 1u);
  EXPECT_EQ(notes(mirrored + turned, ""), 0u);

  options_.settings = {"/materials/*/doubleSided=true"};  // as the note says
  EXPECT_EQ(notes(turned, ""), 0u);
}

TEST_F(GltfMaterials, MapsThatAreTheSameAllOverAreNone) {
  useRows({{"0033ff66", "00330066"}, {"0033ff", "0099ff"}});
  const auto load = [&](const std::string& index) {
    return loadMaterial(
               "{'pbrMetallicRoughness':{'roughnessFactor':0.5,"
               "'metallicRoughnessTexture':{'index':" +
               index + "}}}")
        .materials[0];
  };

  EXPECT_EQ(load("0").roughnessMap, kNoTexture);
  EXPECT_NEAR(load("0").roughness, 0.1f, 1e-6f);
  EXPECT_NE(load("1").roughnessMap, kNoTexture);
  EXPECT_EQ(load("1").roughness, 0.5f);

  const Material blended =
      loadMaterial(matte("'baseColorTexture':{'index':0}", "'alphaMode':'BLEND'")).materials[0];
  EXPECT_EQ(blended.coverageMap, kNoTexture);
  EXPECT_EQ(blended.alphaMap, kNoTexture);
  EXPECT_NEAR(blended.coverage, 0.4f, 1e-6f);

  // What is given stays even if it is what the file says without its maps.
  options_.settings = {"/materials//roughness=0.5"};
  EXPECT_EQ(load("1").roughness, 0.5f);
  EXPECT_EQ(load("1").roughnessMap, kNoTexture);
}

TEST_F(GltfMaterials, MasksCutBelowTheCutoff) {
  useRows({{"ffffff64", "ffffffff"}});
  const auto show = [&](const std::string& alpha, const std::string& rest) {
    return picture(matte("'baseColorFactor':[1,1,1," + alpha + "],'baseColorTexture':{'index':0}",
                         "'alphaMode':'MASK'" + rest),
                   2);
  };

  const Rgb seen(lit(0.5, 0.5)), cut(0.0f);
  expectColors(show("1", ""), {cut, seen});  // 100 / 255 is below 0.5
  expectColors(show("1", ",'alphaCutoff':0.3"), {seen});
  expectColors(show("0.75", ",'alphaCutoff':0.3"), {cut});  // 0.294 is below 0.3
}

TEST_F(GltfMaterials, MasksCutEverythingAndBlendingLetsTheRestThrough) {
  const Rgb behind{0.5f, 1, 0};
  for (const auto& [mode, color] :
       {std::pair("'MASK'", behind), std::pair("'BLEND'", Rgb(0.25f) + behind * 0.75f)}) {
    SCOPED_TRACE(mode);
    const std::string material =
        matte("'baseColorFactor':[1,1,1,0.25]", std::string("'alphaMode':") + mode);
    expectColors(picture({{material}, {glowing("[0.5,1,0]"), -1, 4}}), {color});
  }
}

TEST_F(GltfMaterials, BlendingCountsTexelByTexel) {
  const auto blended = [](double alpha) {
    return Rgb{1, 0, 0} * static_cast<float>(1 - alpha) + gray(alpha * lit(0.5, 0.5));
  };
  // 0.2 and 0.6, or 0.4 all over; times the factor's alpha
  useRows({{"ffffff33", "ffffff99"}, {"ffffff66", "ffffff66"}});
  for (const double factor : {1.0, 0.5}) {
    const auto show = [&](int texture) {
      return picture({{matte(joined("'baseColorFactor':[1,1,1,", factor,
                                    "],'baseColorTexture':{'index':", texture, "}"),
                             "'alphaMode':'BLEND'")},
                      {glowing("[1,0,0]"), -1, 4}},
                     2);
    };
    expectColors(show(0), {blended(0.2 * factor), blended(0.6 * factor)});
    expectColors(show(1), {blended(0.4 * factor), blended(0.4 * factor)});
  }
}

TEST_F(GltfMaterials, TransmissionIsADielectric) {
  // Straight through one surface: 1 - ((1.5 - 1) / (1.5 + 1))^2 = 0.96 of the tinted light behind.
  candela_ = 0;
  const auto through = [&](const std::string& volume) {
    return picture({{"{'pbrMetallicRoughness':{'metallicFactor':0,'roughnessFactor':0,'"
                     "baseColorFactor':[1,0.5,0.25,1]},'extensions':{'KHR_materials_transmission':{"
                     "'transmissionFactor':1},'KHR_materials_volume':{'thicknessFactor':1" +
                     volume + "}}"},
                    {glowing("[1,1,1]"), -2, 9}})[0];
  };

  expectColor(through("}"), {0.96f, 0.48f, 0.24f});

  // ior 2: a ninth is reflected.
  expectColor(through("},'KHR_materials_ior':{'ior':2}"), Rgb{8.0f, 4.0f, 2.0f} / 9.0f);

  // Over a distance of 2, the root of what a distance of 4 leaves.
  expectColor(through(",'attenuationDistance':4,'attenuationColor':[0.0625,1,1]}"),
              {0.24f, 0.48f, 0.24f});
}

// A thin wall follows the extension, and a solid whose factors are 1 leaves out nothing.
TEST_F(GltfMaterials, SpecularFactorsOfSolidsAreSaidToBeLeftOut) {
  const auto solid = [](const std::string& specular, const std::string& thickness = "1") {
    return "{'extensions':{'KHR_materials_transmission':{'transmissionFactor':1},"
           "'KHR_materials_volume':{'thicknessFactor':" +
           thickness + "},'KHR_materials_specular':{" + specular + "}}}";
  };
  expectWarnings(
      "KHR_materials_specular of a material with a volume left out, but for the highlights of "
      "lights: it reflects by its ior alone",
      {{solid("'specularFactor':0.5"), 1},
       {solid("'specularColorFactor':[1,0,0]"), 1},
       {solid("'specularFactor':1,'specularColorFactor':[1,1,1]"), 0},
       {solid("'specularFactor':0.5", "0"), 0}});
}

// A wall that fades from white to black, behind a pane that is turned by 45 degrees. A surface of
// ior 1.5 bends the ray towards its normal, which leads to the left.
TEST_F(GltfMaterials, WithoutAThicknessTransmissionDoesNotBendLight) {
  candela_ = 0;
  useRows({{"ffffff", "000000"}}, "'wrapS':33071");
  // Between the middles of its two texels the wall is 0.5 - x / 4.
  const std::string wall =
      "{'emissiveFactor':[1,1,1],'emissiveTexture':{'index':0},"
      "'pbrMetallicRoughness':{'baseColorFactor':[0,0,0,1]}}";

  const auto expectSeen = [&](const std::string& rest, double wanted) {
    const std::string pane =
        "{'doubleSided':true,'pbrMetallicRoughness':{'metallicFactor':0,'roughnessFactor':0},"
        "'extensions':{'KHR_materials_transmission':{'transmissionFactor':1}" +
        rest + "}}";
    SceneDescription d = loadSquares({{pane}, {wall, -1, 4}});
    d.instances.at(0).toWorld = Affine::rotation({0, 1, 0}, 45);
    EXPECT_NEAR(pictureOf(std::move(d), 1)[0].x, wanted, kClose) << rest;
  };

  // Through a thin wall the middle of the wall is seen, 1/2, but for what the pane reflects by
  // Schlick's law at 45 degrees.
  const auto thin = [](double f0) {
    return 0.5 * (1 - f0 - (1 - f0) * std::pow(1 - std::sqrt(0.5), 5));
  };
  expectSeen("", thin(0.04));
  expectSeen(",'KHR_materials_ior':{'ior':2},'KHR_materials_volume':{}", thin(1.0 / 9));
  expectSeen(
      ",'KHR_materials_volume':{'thicknessFactor':0,'attenuationDistance':1,'attenuationColor':[0."
      "1,0.1,0.1]}",
      thin(0.04));
  // An index of 0 stands for a reflectance of 1, times the color.
  const std::string all = ",'KHR_materials_ior':{'ior':0}";
  expectSeen(all, 0);
  expectSeen(all + ",'KHR_materials_specular':{'specularColorFactor':[0.25,0.25,0.25]}",
             thin(0.25));

  // The exact Fresnel reflectance of ior 1.5 at 45 degrees is 0.0502.
  const double inside = std::asin(std::sin(kPi / 4) / 1.5), moved = std::tan(kPi / 4 - inside);
  expectSeen(",'KHR_materials_volume':{'thicknessFactor':1}", (1 - 0.0502) * (0.5 + moved / 4));
}

// KHR_materials_specular: the color changes the reflectance at normal incidence alone, and the
// factor that at grazing incidence too.
TEST_F(GltfMaterials, ABlackSpecularColorKeepsGrazingReflection) {
  candela_ = 0;
  const auto expectSeen = [&](const std::string& extensions, double wanted,
                              const std::string& metal = "'metallicFactor':0") {
    SceneDescription d = loadMaterial(
        "{'doubleSided':true,'pbrMetallicRoughness':{'baseColorFactor':[0,0,0,1],"
        "'roughnessFactor':0," +
        metal + "},'extensions':{" + extensions + "}}");
    d.instances.at(0).toWorld = Affine::rotation({0, 1, 0}, 80);
    d.sky.kind = Sky::Kind::color;
    d.sky.zenith = Rgb(1.0f);
    EXPECT_NEAR(pictureOf(std::move(d), 1)[0].x, wanted, kClose) << extensions << metal;
  };

  // Schlick's law at 80 degrees, with F0 = 0 and F90 = 1.
  const double grazing = std::pow(1 - std::cos(80 * kPi / 180), 5);
  const std::string black = "'KHR_materials_specular':{'specularColorFactor':[0,0,0]";
  expectSeen("'KHR_materials_specular':{'specularColorFactor':[1,1,1]}", 0.04 + 0.96 * grazing);
  expectSeen(black + "}", grazing);
  expectSeen(black + ",'specularFactor':0.5}", 0.5 * grazing);
  expectSeen(black + ",'specularFactor':0}", 0);
  expectSeen(black + "},'KHR_materials_ior':{'ior':0}", grazing);

  // Without an interface nothing is reflected.
  expectSeen(black + "},'KHR_materials_ior':{'ior':1}", 0);

  // The same from a texel, where maps say that the surface is no metal.
  useRows({{"000000"}});
  expectSeen(black + "}", grazing, "'metallicRoughnessTexture':{'index':0}");
}

TEST_F(GltfMaterials, SmoothSurfacesMirror) {
  candela_ = 0;
  const auto mirrored = [&](const std::string& pbr, const std::string& rest = "") {
    return picture(
        {{"{'pbrMetallicRoughness':{" + pbr + "}" + rest + "}"}, {glowing("[1,1,1]"), 6, 9}})[0];
  };

  expectColor(mirrored("'roughnessFactor':0,'baseColorFactor':[0.9,0.6,0.3,1]"),
              {0.9f, 0.6f, 0.3f});
  expectColor(mirrored("'roughnessFactor':0,'metallicFactor':0"), Rgb(0.04f));

  // Half of a lobe between smooth and rough.
  EXPECT_NEAR(mirrored("'roughnessFactor':0.175").x, 0.5, 0.01);
  expectColor(mirrored("'roughnessFactor':0.5"), Rgb(0.0f));
  expectColor(mirrored("'roughnessFactor':1,'metallicFactor':0",
                       ",'extensions':{'KHR_materials_specular':{'specularFactor':0}}"),
              Rgb(0.0f));
  expectColor(mirrored("'metallicFactor':0",
                       ",'extensions':{'KHR_materials_clearcoat':{'clearcoatFactor':1}}"),
              Rgb(0.04f));
}

// A rough white metal before a wall that glows, of which the tail of the lobe sees the edges.
TEST_F(GltfMaterials, RoughSurfacesReflectInSamples) {
  candela_ = 0;
  const auto reflected = [&](const std::string& material, int glossy) {
    rendering_.glossy = glossy;
    return picture({{material}, {glowing("[1,0.5,0.25]"), 6, 60}})[0];
  };

  const std::string rough = "{'pbrMetallicRoughness':{'roughnessFactor':0.5}}";
  expectColor(reflected(rough, 0), Rgb(0.0f));

  const Rgb seen = reflected(rough, 64);
  // Of alpha 1/4, a white lobe reflects 0.916 of an even light to who looks along the normal: the
  // integral of 2 c / (c + sqrt(c^2 (1 - alpha^2) + alpha^2)) over its samples; 64 of them.
  EXPECT_NEAR(seen.x, 0.916, 0.05);
  EXPECT_NEAR(seen.y, seen.x / 2, 1e-5);
  EXPECT_NEAR(seen.z, seen.x / 4, 1e-5);

  // Smooth: one impulse, whatever the number of samples.
  expectColor(reflected("{'pbrMetallicRoughness':{'roughnessFactor':0.03}}", 64), {1, 0.5f, 0.25f});

  // The facets of what bounds a volume reflect by its index of refraction.
  const std::string glass =
      "{'pbrMetallicRoughness':{'metallicFactor':0,'roughnessFactor':0.5},"
      "'extensions':{'KHR_materials_transmission':{'transmissionFactor':1},"
      "'KHR_materials_volume':{'thicknessFactor':1}}}";
  expectColor(reflected(glass, 64), Rgb(0.04f, 0.02f, 0.01f) * 0.916f);
  expectColor(reflected(glass, 0), {0.04f, 0.02f, 0.01f});
}

TEST_F(GltfMaterials, EmissionBelowAClearcoatIsSaidNotToBeDimmed) {
  const auto coated = [](const std::string& coat, const std::string& emission) {
    return "{'emissiveFactor':" + emission +
           ",'extensions':{'KHR_materials_clearcoat':{'clearcoatFactor':" + coat + "}}}";
  };
  expectWarnings(
      "emission below a clearcoat not dimmed by it: too bright by what the coat reflects",
      {{coated("1", "[0,0.5,0]"), 1}, {coated("0", "[0,0.5,0]"), 0}, {coated("1", "[0,0,0]"), 0}});
}

// Codes of (0.6, 0, 0.8): tilted to the right, or upwards with red and green exchanged.
TEST_F(GltfMaterials, NormalMaps) {
  useRows({{"cc80e6"}, {"80cce6"}});
  const auto expectLit = [&](const char* light, const std::string& texture, double cosine) {
    constexpr double kCode = 0.01;  // of a normal in 8 bits
    light_ = light;
    expectColors(picture(matte("", "'normalTexture':{'index':" + texture + "}")),
                 {gray(9.0 / 18 * cosine)}, kCode);
  };

  const double facing = (0.8 + 0.6) / std::sqrt(2.0), away = (0.8 - 0.6) / std::sqrt(2.0);
  expectLit("3,0,3", "0", facing);
  expectLit("0,3,3", "1", facing);
  expectLit("-3,0,3", "0", away);
  expectLit("0,-3,3", "1", away);
  expectLit("3,0,3", "0,'scale':0.5", (0.3 + 0.8) / std::sqrt(2 * (0.09 + 0.64)));
}

// Of two primitives only one has mappings.
TEST_F(GltfMaterials, AVariantHasMaterialsOfItsOwn) {
  const std::string mapped = triangle(
      ",'material':0,'extensions':{'KHR_materials_variants':{'mappings':[{'material':1,'variants':["
      "0]},{'material':2,'variants':[1,2]}]}}");
  const std::string model =
      save("m.gltf",
           json("'materials':[{'name':'plain'},{'name':'red'},{'name':'blue'}],'extensions':{'KHR_"
                "materials_variants':{'variants':[{'name':'a'},{'name':'b'},{'name':'c'}]}}," +
                oneMesh(mapped + "," + triangle(",'material':0"))));

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

  EXPECT_EQ(names(loadMembers("'scene': [{'model': 'm.gltf', 'variant': 'a'}]")), "red plain ");

  options_.settings = {"/variant='c'"};
  EXPECT_EQ(names(load(model)), "blue plain ");

  options_.settings = {"/variant='cc'"};
  expectLike(errorOfFile(model), "*m.gltf#/variant: expected one of \"a\", \"b\", \"c\"*");
  expectLike(errorOfObj(kTriangleObj), "*the model has none*");
}

}  // namespace
}  // namespace whit
