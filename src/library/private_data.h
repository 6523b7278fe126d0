// Private data of the scenes and images that the library hands out.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "bake/scene.h"
#include "io/image/image_file.h"
#include "io/load_scene.h"
#include "library/whit.h"
#include "render/film.h"

namespace whit::api {

using SceneSource = std::variant<std::string, std::shared_ptr<const SceneText>>;

struct Scene::Data {
  whit::Scene scene;
  SceneSource source;
  whit::LoadOptions load;
  bool strict = false;
  std::vector<std::string> warnings;

  // Loads and bakes.
  static std::shared_ptr<Data> read(SceneSource source, const whit::LoadOptions& load, bool strict,
                                    whit::Progress* progress);
  // The document that settings are put into; none for a model without a scene file.
  std::optional<JsonDocument> document() const;
};

struct Image::Data {
  Film film;
  ImageMetadata metadata, aboutChannels;
};

whit::LoadOptions loadOptions(const LoadOptions& options, const char* shippedScenes);

}  // namespace whit::api
