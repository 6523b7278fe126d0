// MTL files: materials as OBJ files name them.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "io/gltf/material.h"

namespace whit {

// Limit on the materials of a file. A line of a few letters makes a material that takes kilobytes.
inline constexpr std::size_t kMaterialLimit = 65536;

// The statements of a material. Libraries hold many materials that no model uses.
struct MtlMaterial {
  struct Map {
    std::string name;  // as written in the file
    std::string where;
    bool clamp = false;
    float bumpScale = 1;           // -bm
    Vec3f offset, scale{1, 1, 1};  // -o, -s
  };

  std::string name;
  std::string where;                   // file:line of its newmtl
  std::map<std::string, Rgb> numbers;  // colors by keyword in lower case; single numbers are gray
  std::map<std::string, Map> maps;
  bool isFromMeshLab = false, isFromBlender = false;

  bool has(const std::string& keyword) const { return numbers.contains(keyword); }
  bool hasMap(const std::string& keyword) const { return maps.contains(keyword); }
};

// Adds the materials of the file to `materials`; the first definition of a name wins. Statements
// that cannot be read or that have no meaning here are left out and counted in the warnings.
void readMtl(const std::filesystem::path& path, std::map<std::string, MtlMaterial>& materials,
             Warnings& warnings);

// A material in terms of glTF, and the reflectances that glTF does not have.
//
// The statements mean: Kd is the diffuse albedo. Ks is the strength of the highlight: F0 is
// 0.08 Ks, as Blender reads it. Ns is the exponent of Blinn's lobe (alpha = sqrt(2 / (Ns + 2)),
// roughness = sqrt(alpha); in files of Blender roughness = 1 - sqrt(Ns / 1000)) unless Pr gives the
// roughness. Pm is the metalness, in files of Blender Ka where illum is 3 or 6. Ke is emitted, Pc
// and Pcr are the clearcoat. illum 0 and 1 have no highlight; 3, 5 and 8 mirror with Ks (5: all at
// grazing incidence) unless a metalness is given; 4, 6, 7 and 9 (in files of Blender 4 and 7) are
// glass with index Ni, filtered by Tf, else by 1 - d. Tr is 1 - d, but d in files of MeshLab. d
// below 1 elsewhere lets 1 - d of the light straight through. A map_d whose texels are mostly gray
// is coverage, which multiplies d; any other map_d is a mask that cuts at a half. Without map_d,
// the alpha channel of map_Kd is used. Ka and map_Ka are not read, because ambient light is
// reflected by Kd.
struct ObjMaterial {
  GltfMaterial surface;
  Rgb mirror{0, 0, 0}, mirrorGrazing{0, 0, 0};  // reflectance of illum 3, 5 and 8
  Rgb transmission{0, 0, 0};                    // transmission of glass
  float dissolve = 1;
};

// Returns the material that the statements mean. Its maps refer to images by their numbers in
// `images`, to which new ones are added. Their names are relative to `folder`. A map that cannot be
// found causes a warning.
ObjMaterial interpretMtl(const MtlMaterial& source, const std::filesystem::path& folder,
                         const PathRules& rules, std::vector<GltfImageSource>& images,
                         Warnings& warnings);
Material shadedAs(const ObjMaterial& source, const GltfMeans& means);

}  // namespace whit
