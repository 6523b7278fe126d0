// MTL files: materials as OBJ files name them.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/warnings.h"
#include "io/paths.h"
#include "io/texture_loader.h"
#include "scene/material.h"

namespace whit {

// Limit on the materials of a file: a line of a few letters makes one, which takes kilobytes.
inline constexpr std::size_t kMaterialLimit = 65536;

// A material whose textures are not loaded yet: libraries hold many materials that no model uses.
struct MtlMaterial {
  struct Map {
    std::string name;  // as written in the file; empty: none
    bool clamp = false;
    float bumpScale = 1;  // -bm
  };
  Material material;
  Map diffuse, specular, normal, bump, alpha;
  bool alphaFromDiffuse = true;  // without `alpha`, the alpha channel of `diffuse` is used
  std::string where;             // file:line of its newmtl
};

// Adds the materials of the file to `materials`; the first definition of a name wins. Statements in
// a form that is not supported are warnings. Throws badScene "file:line" where a number is missing.
//
// The statements mean: Kd is the diffuse albedo, Ks the reflectance at normal
// incidence, Ns the exponent of Blinn's lobe (alpha = sqrt(2 / (Ns + 2)), roughness = sqrt(alpha))
// unless Pr gives the roughness, Pm the metalness. illum 0 and 1 have no highlight; 3, 5 and 8
// mirror with Ks (5: all at grazing incidence); 4, 6, 7 and 9 are glass with index Ni, filtered by
// Tf, else by 1 - d. d below 1 elsewhere lets 1 - d of the light straight through.
void readMtl(const std::filesystem::path& path, std::map<std::string, MtlMaterial>& materials,
             Warnings& warnings);

// Returns the material and adds its textures to `textures`; their names are relative to `folder`.
Material loadTextures(const MtlMaterial& source, const std::filesystem::path& folder,
                      const PathRules& rules, TextureLoader& textures);

}  // namespace whit
