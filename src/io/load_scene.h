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
  std::string shippedScenes;                   // one more folder of shipped scenes, or empty

  // "POINTER=VALUE" for members of the scene file, see scene_settings.h. For a model they are
  // members of "materials" and "cameras" by their names there, its "lights" or the supplied ones,
  // "sky" and "ambient"; for a glTF file "variant" (KHR_materials_variants), and for other models
  // "up", the axis that is up in them: "x", "y" or "z". For models and scene files with "view":
  // "model", "viewpoint", the side from which a supplied camera sees it: "outside" or "inside";
  // "azimuth", its direction in degrees, from the front towards the right; "zoom", how much larger
  // than usual it shows the model; and "ground": true for a soft shadow below the model.
  std::vector<std::string> settings;

  // Replaces the scene's own sky: "none", "studio" (make/studio_sky.h) or an equirectangular image.
  // If it is empty, a scene keeps its sky, and a model, which has none, gets the studio.
  std::string sky;

  // Supplied cameras fit a picture of this size; without it, one of the scene's own size.
  std::optional<ImageSize> size;

  // The instant at which the scene is looked at. Seconds that nothing in the scene follows, or an
  // animation that no model has, are Error(usage).
  Instant instant;

  // The camera that is asked for, if any. One that a scene file lacks is Error(usage) before its
  // shapes and images are made, which can take minutes.
  std::string camera;

  // Number of segments of the triangles that replace each exact sphere, at least 4 (otherwise
  // Error(usage)). With 0 the spheres stay.
  int sphereSegments = 0;
};

// `name`: a scene file (.json), a model (model.h), or the bare name of a shipped scene, looked for
// in $WHIT_SCENES, beside the program, in options.shippedScenes and in the source tree. Throws
// Error: badScene with "file:line" or "file#/json/pointer" and what was expected there, io when it
// cannot be read, usage when no such scene is shipped (names the nearest).
SceneDescription loadScene(const std::string& name, const LoadOptions& options, Warnings& warnings,
                           Progress* progress = nullptr);

// A scene that a program makes: the text of a scene file, and the meshes and images that belong to
// it. Paths are relative to the working directory. Errors give `name` as the file.
struct SceneText {  // NOLINT(bugprone-exception-escape): moving Json does not throw
  std::string name;
  Json root;
  SceneParts parts;
};
SceneDescription loadScene(const SceneText& text, const LoadOptions& options, Warnings& warnings,
                           Progress* progress = nullptr);

// Calls Scene::finalize() for what was read from `file`. Its errors name the scene; the errors of
// this function name the file as well.
Scene finalizeScene(const std::string& file, SceneDescription description, Warnings& warnings,
                    Progress* progress = nullptr);

// Returns the document that is read as a scene's description, with settings and parameters in their
// places, or nothing for a model without a scene file.
std::optional<JsonDocument> readDocument(const std::string& name, const LoadOptions& options);
JsonDocument readDocument(const SceneText& text, const LoadOptions& options);

// The share of the sky's light that becomes ambient light around a model: the model occludes part
// of the sky, and lights shine as well.
inline constexpr double kAmbientOfSky = 0.4;

inline constexpr const char* kNoSky = "none";

}  // namespace whit
