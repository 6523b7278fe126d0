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

// A material with its textures not yet asked for: libraries hold many that no model uses.
struct MtlMaterial {
  struct Map {
    std::string name;  // as written in the file; empty: none
    bool clamp = false;
    float bumpScale = 1;  // -bm
  };
  Material material;
  Map diffuse, specular, normal, bump, alpha;
  bool alphaFromDiffuse = true;  // the alpha of `diffuse` cuts, where there is no `alpha`
  std::string where;             // file:line of its newmtl
};

// Adds the materials of the file to `materials`; a name that is there already keeps its first
// meaning. Throws badScene "file:line" where a number is missing.
//
// How the statements are understood: Kd is the diffuse albedo, Ks the reflectance at normal
// incidence, Ns the exponent of Blinn's lobe (alpha = sqrt(2 / (Ns + 2)), roughness = sqrt(alpha))
// unless Pr gives the roughness, Pm the metalness. illum 0 and 1 have no highlight; 3, 5 and 8
// mirror with Ks (5: all at grazing incidence); 4, 6, 7 and 9 are glass with index Ni, filtered by
// Tf, else by 1 - d. d below 1 elsewhere lets 1 - d of the light straight through.
void readMtl(const std::filesystem::path& path, std::map<std::string, MtlMaterial>& materials,
             Warnings& warnings);

// The material with its textures asked for; the files they name are relative to `folder`.
Material loadTextures(const MtlMaterial& source, const std::filesystem::path& folder,
                      const PathRules& rules, TextureLoader& textures);

}  // namespace whit
