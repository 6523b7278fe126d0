// Members of a scene's description that are given apart from its file: --set POINTER=VALUE.
#pragma once

#include <string>
#include <vector>

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

// Sets the member in `document` and changes `scene`, which was read from it with `options`, as a
// reader would have, bit for bit: lights, colors of the sky, ambient light, numbers of materials,
// and in scenes without instances cameras and the image size. Without a document (a model) only
// lights. Returns false, with nothing done, where the scene has to be read again with the setting.
// Throws as the reader does, with nothing done. Renderers of the scene have to be told
// (Renderer::shadingChanged, camerasChanged) before their next frame.
bool editScene(const SceneSetting& setting, const LoadOptions& options, JsonDocument* document,
               Scene& scene);

}  // namespace whit
