// The reader of scenes: from a name on the command line to a scene description.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/scene.h"
#include "core/options.h"
#include "core/progress.h"
#include "core/warnings.h"
#include "io/json_reader.h"
#include "io/scene/scene_parts.h"
#include "scene/description.h"
#include "scene/motion.h"

namespace whit {

struct LoadOptions {
  bool allowOutside = false;                   // paths may leave the scene's folder and $WHIT_DATA
  std::uint64_t maxMemoryBytes = 16ull << 30;  // texels and geometry while loading
  int threads = 0;                             // decoders; 0: all
  std::string shippedScenes;                   // where else shipped scenes are; empty: nowhere
  // "POINTER=VALUE", see scene_settings.h, taken for parts of the scene file. Of a model: members
  // of "materials" by their names there, its "lights" or those supplied, "sky" and "ambient"; of a
  // glTF file "variant" (KHR_materials_variants), and of other models "up", the axis that is up in
  // them: "x", "y" or "z"; "viewpoint", the side from which a supplied camera sees it: "outside"
  // or "inside".
  std::vector<std::string> settings;
  // In place of the scene's own sky: "none", "studio" (make/model_view.h) or an equirectangular
  // image. Empty: the scene's own; of a model, which has none, the studio.
  std::string sky;
  // Supplied cameras fit a picture of this size; none: of the scene's own.
  std::optional<ImageSize> size;
  // When the scene is looked at. With seconds that nothing in the scene follows, or an animation
  // that no model has: Error(usage).
  Instant instant;
  // Segments of the triangles in place of each exact sphere, at least 4 (Error(usage) else); 0: the
  // spheres stay.
  int sphereSegments = 0;
};

// `name`: a scene file (.json), a model (model.h), or the bare name of a shipped scene, looked for
// in $WHIT_SCENES, beside the program, in options.shippedScenes and in the source tree. Throws
// Error: badScene with "file:line" or "file#/json/pointer" and what was expected there, io when it
// cannot be read, usage when no such scene is shipped (names the nearest).
SceneDescription loadScene(const std::string& name, const LoadOptions& options, Warnings& warnings,
                           Progress* progress = nullptr);

// A scene that a program makes: what a scene file would say, and what it hands over besides. Paths
// are relative to the working directory. `name` stands for the file in errors.
struct SceneText {  // NOLINT(bugprone-exception-escape): moving Json does not throw
  std::string name;
  Json root;
  SceneParts parts;
};
SceneDescription loadScene(const SceneText& text, const LoadOptions& options, Warnings& warnings,
                           Progress* progress = nullptr);

// Scene::finalize() of what was read from `file`. Its errors name the scene; these name the file
// too.
Scene finalizeScene(const std::string& file, SceneDescription description, Warnings& warnings,
                    Progress* progress = nullptr);

// The document that is read as a scene's description, with settings and parameters in their places;
// none for a model without a scene file.
std::optional<JsonDocument> readDocument(const std::string& name, const LoadOptions& options);
JsonDocument readDocument(const SceneText& text, const LoadOptions& options);

// The share of the sky's light that becomes ambient light around a model: the model occludes part
// of the sky, and lights shine as well.
inline constexpr double kAmbientOfSky = 0.4;

inline constexpr const char* kNoSky = "none";

// Makes the sky for kNoSky, "studio" (make/model_view.h) or the file of an equirectangular image.
// The file and its decoded texels may take `mostBytes`. Throws as readRawImage() does.
Sky namedSky(const std::string& name, std::uint64_t mostBytes, Warnings& warnings);

}  // namespace whit
