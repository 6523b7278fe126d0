// Members of a scene's description that are given apart from its file: --set POINTER=VALUE.
#pragma once

#include <string>
#include <vector>

#include "core/warnings.h"
#include "io/json_reader.h"

namespace whit {

class Scene;
struct LoadOptions;

// A JSON pointer (RFC 6901) taken apart, and the value that is to stand there.
struct SceneSetting {
  std::vector<std::string> tokens;  // at least one
  Json value;
};

// Reads "/lights/0/intensity=40". The value is everything after the first '=' that JSON follows,
// because names may hold that sign as well. Throws Error(usage).
SceneSetting parseSceneSetting(const std::string& text);

// Adds a setting to those that are applied in their order. A member that is set again and again
// stays one setting.
void addSceneSetting(const std::string& text, std::vector<std::string>& settings);

// Puts the value into the description. Objects that lead to it are made where they are missing, and
// "-" stands for a new element of a list. The reader of the scene judges the member. Throws
// badScene with "file#/json/pointer".
void applySceneSetting(const SceneSetting& setting, JsonDocument& document);

// Returns what the settings of the model in `file` are applied to: its lights and the settings of
// `options`, with which it was read.
JsonDocument describeModel(const std::string& file, const Scene& scene, const LoadOptions& options);

// Kind of the warnings of warnOfSum().
inline constexpr const char* kSumWarning =
    "material whose parts exceed 1 in sum: what the mirror, then the glossy lobe and then the "
    "transmission leave is all that its diffuse color gets";

// Changes `scene` into the one that a reader makes of `document` and `options`, bit for bit, if the
// settings that were applied to the document since then are about lights, materials, sky or ambient
// light, or in scenes without instances about cameras or the image size; not about textures, and
// not about members of materials that triangles depend on. Sky images are read. Returns false, with
// nothing done, where the scene has to be read again. Throws as the reader does, with nothing done.
// Renderers of the scene have to be told (Renderer::shadingChanged, camerasChanged) before their
// next frame.
//
// Where materials are edited, `warnings` gets the sums of all of them (kSumWarning).
bool editScene(const std::vector<SceneSetting>& touched, const LoadOptions& options,
               const JsonDocument& document, Warnings& warnings, Scene& scene);

}  // namespace whit
