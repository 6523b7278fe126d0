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

// "/lights/0/intensity=40". The value is everything after the first '=' that JSON follows, for
// names may hold that sign as well. Throws Error(usage).
SceneSetting parseSceneSetting(const std::string& text);

// Adds one to settings that are taken in their order, in place of those that it leaves nothing of:
// a member that is set again and again is one setting.
void addSceneSetting(const std::string& text, std::vector<std::string>& settings);

// Puts the value into the description, whatever was there; objects that lead to it are made
// where there are none, and "-" stands for a new element of a list. Whether such a member makes
// sense is for the reader of the scene to say. Throws badScene with "file#/json/pointer".
void applySceneSetting(const SceneSetting& setting, JsonDocument& document);

// Sets the member in `document` and does to `scene`, which was read of it with `options`, what a
// reader would have done, bit for bit: to lights, colors of the sky, ambient light, numbers of
// materials, and of scenes without instances to cameras and the image size. Without a document (a
// model) to lights. False, with nothing done: the scene has to be read again with the setting,
// since geometry, images, their number or what moves would be others. Throws as the reader does,
// with nothing done. Renderers of the scene have to be told (Renderer::shadingChanged,
// camerasChanged) before their next frame.
bool editScene(const SceneSetting& setting, const LoadOptions& options, JsonDocument* document,
               Scene& scene);

}  // namespace whit
