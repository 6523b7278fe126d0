// Hashes of pictures of the shipped scenes, which depend on no processor, compiler and number of
// threads. whit-verify --hashes compares them with what this machine renders.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "engine/open_scene.h"

namespace whit::verify {

struct PublishedHash {
  std::string_view scene;  // and its options: "orrery --time 3"
  std::string_view size;   // "480x300"
  std::string_view hash;   // image_hash in the JSON of whit render; empty: not published yet
  // The hash with SSE4 and scalar code if it is another one. Embree's code for processors without
  // fused multiply-add finds other triangles for a few rays that pass an edge within rounding.
  std::string_view hashWithoutFma = {};

  std::string_view hashWith(std::string_view simdTarget) const;
};
std::span<const PublishedHash> publishedHashes();

// The scene of one of these pictures, with the options of the picture.
class HashedScene {
 public:
  // Throws Error as the scene's reader does.
  explicit HashedScene(const PublishedHash& picture);

  // The options that a caller may change must not change the hash: simd, packet, threads.
  const RenderOptions& options() const { return options_; }
  std::string hash(const RenderOptions& options) const;

 private:
  std::unique_ptr<OpenScene> open_;
  RenderOptions options_;
};

}  // namespace whit::verify
