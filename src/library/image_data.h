// A picture with what it says about itself.
#pragma once

#include "io/image/image_file.h"
#include "library/whit.h"
#include "render/film.h"

namespace whit::api {

struct Image::Data {
  Film film;
  ImageMetadata metadata, aboutChannels;
};

}  // namespace whit::api
