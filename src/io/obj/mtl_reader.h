// MTL files: materials as OBJ files name them.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "io/model.h"

namespace whit {

// Limit on the materials of a file: a line of a few letters makes one, which takes kilobytes.
inline constexpr std::size_t kMaterialLimit = 65536;

// A material whose textures are not loaded yet: libraries hold many materials that no model uses.
struct MtlMaterial {
  struct Map {
    std::string name;  // as written in the file
    bool clamp = false;
    float bumpScale = 1;  // -bm
  };
  Material material;
  std::string where;                   // file:line of its newmtl
  std::map<std::string, Rgb> numbers;  // by keyword in lower case; single numbers as gray
  std::map<std::string, Map> maps;
};

// Adds the materials of the file to `materials`; the first definition of a name wins. Throws
// badScene "file:line" where a number is missing.
//
// The statements mean: Kd is the diffuse albedo, Ks the reflectance at normal
// incidence, Ns the exponent of Blinn's lobe (alpha = sqrt(2 / (Ns + 2)), roughness = sqrt(alpha))
// unless Pr gives the roughness, Pm the metalness. illum 0 and 1 have no highlight; 3, 5 and 8
// mirror with Ks (5: all at grazing incidence); 4, 6, 7 and 9 are glass with index Ni, filtered by
// Tf, else by 1 - d. Tr is 1 - d, but d in files of MeshLab. d below 1 elsewhere lets 1 - d of the
// light straight through. Without map_d, the alpha channel of map_Kd is used.
void readMtl(const std::filesystem::path& path, std::map<std::string, MtlMaterial>& materials,
             Warnings& warnings);

// Returns `material` with the maps of `source` that are not `given`, which it adds to `textures`;
// their names are relative to `folder`. A map that cannot be read is a warning.
Material loadTextures(const MtlMaterial& source, Material material, const GivenMembers& given,
                      const std::filesystem::path& folder, const PathRules& rules,
                      TextureLoader& textures, Warnings& warnings);

}  // namespace whit
