// What pixels tell each other: the surfaces they see, and at half rates what their rays found.
#include "core/pixel.h"
#include "render/tile_pass.h"

namespace whit {

void TileTracer::recordSurfaces(const Pass& pass) {
  const SurfelColumns& s = *surfels_;
  for (std::size_t i = 0; i < pass.pixels.size(); ++i) {
    const std::uint32_t pixel = pass.pixels[i];
    PixelSurface& surface =
        (*pass.job.surfaces)[pass.job.film->image.index(pixelX(pixel), pixelY(pixel))];
    surface = {};
    if (s.material[i] == kMiss) continue;
    surface.material = s.material[i];
    if (hits_->instance) surface.instance = hits_->instance[i];
    surface.position = {s.posX[i], s.posY[i], s.posZ[i]};
    surface.normal = {s.ngX[i], s.ngY[i], s.ngZ[i]};
  }
}

void TileTracer::findLenders(const Pass& pass) {
  const std::size_t n = pass.pixels.size();
  lenders_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const int x = pixelX(pass.pixels[i]), y = pixelY(pass.pixels[i]);
    if (pass.job.lends) {
      pass.job.shares->at(x, y) = LightShare{};
    } else {
      const std::size_t own = pass.job.film->image.index(x, y);
      lenders_[i] = pass.job.shares->lendersOf(x, y, (*pass.job.surfaces)[own]);
    }
  }
}

// Settles the shadow rays whose answer the lenders agree on; the others move up.
void TileTracer::borrowVisibility(const Pass&, std::size_t light) {
  const ShadowColumns& shadows = *shadows_;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < shadowCount_; ++k) {
    const std::uint32_t slot = shadows.slot[k];
    if (const std::optional<bool> visible = lenders_[slot].visibility(light)) {
      unshadowed_->visible[slot] = *visible ? 1.0f : 0.0f;
      continue;
    }
    ShadowColumns::forEachColumn(
        shadows, [&](const char*, auto* column, Group) { column[kept] = column[k]; });
    ++kept;
  }
  shadowCount_ = kept;
}

void TileTracer::lendVisibility(const Pass& pass, std::size_t light) {
  for (std::size_t k = 0; k < shadowCount_; ++k) {
    const std::uint32_t slot = shadows_->slot[k], pixel = pass.pixels[slot];
    pass.job.shares->at(pixelX(pixel), pixelY(pixel)).saw(light, unshadowed_->visible[slot] > 0);
  }
}

void TileTracer::borrowImpulses(const Pass& pass) {
  const RadianceColumns& radiance = *levels_[0].radiance;
  for (std::size_t i = 0; i < pass.pixels.size(); ++i) {
    const std::optional<Rgb> borrowed = lenders_[i].impulses();
    if (!borrowed) continue;
    radiance.r[i] += borrowed->x;
    radiance.g[i] += borrowed->y;
    radiance.b[i] += borrowed->z;
    levels_[0].rays->throughput[i] = 0;
  }
}

void TileTracer::keepLocalRadiance(const Pass& pass) {
  const RadianceColumns& radiance = *levels_[0].radiance;
  local_.clear();
  for (std::size_t i = 0; i < pass.pixels.size(); ++i) {
    local_.push_back({radiance.r[i], radiance.g[i], radiance.b[i]});
  }
}

void TileTracer::lendImpulses(const Pass& pass) {
  const RadianceColumns& radiance = *levels_[0].radiance;
  for (std::size_t i = 0; i < pass.pixels.size(); ++i) {
    const std::uint32_t pixel = pass.pixels[i];
    const Rgb all{radiance.r[i], radiance.g[i], radiance.b[i]};
    pass.job.shares->at(pixelX(pixel), pixelY(pixel)).impulses = all - local_[i];
  }
}

}  // namespace whit
