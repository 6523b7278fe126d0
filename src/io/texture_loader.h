// The textures of a scene that is being read: each image is decoded once for each use that is made
// of it, beside the reading of everything else.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "core/warnings.h"
#include "io/image/decode_queue.h"
#include "io/image/image_file.h"
#include "io/memory_budget.h"
#include "io/scene/scene_parts.h"
#include "scene/description.h"

namespace whit {

struct TextureSource {
  std::string path;
  std::string where;  // who named it
  Wrap wrapU = Wrap::repeat, wrapV = Wrap::repeat;
  float bumpScale = 1;
  bool lenient = false;  // an image that cannot be read is a warning, and there is no texture
};

// Materials refer to slots until finish() numbers the textures that there are.
class TextureLoader {
 public:
  TextureLoader(int threads, MemoryBudget& budget, Warnings& warnings, Progress* progress);

  // Slots, one for each of `uses`; the image is decoded once for all of them. The same source and
  // use gives the same slot again; emission is color where the file cannot go beyond 1.
  std::vector<std::int32_t> add(const TextureSource& source, const std::vector<TextureUse>& uses);
  // Adds an image that a program hands over; `source` has no path.
  std::int32_t add(const GivenImage& image, const TextureSource& source, TextureUse use);
  // A texture that `make` computes, beside the rest.
  std::int32_t add(std::function<Texture()> make);
  // `count` of them, some of which there may turn out to be none of.
  std::vector<std::int32_t> add(std::size_t count,
                                std::function<std::vector<std::optional<Texture>>()> make);
  // The equirectangular map at `path`, in `sky` after finish().
  void addEnvironment(const std::string& path, EnvironmentImage& image);
  // `change` is called by finish() when all textures are there, before they are numbered.
  void whenDone(std::function<void(SceneDescription&)> change);
  // The limits of an image that is decoded now, and the budget that textures are charged to.
  ImageLimits limits() const;

  // Waits for all images, moves them to scene.textures and replaces the slots in its materials by
  // their indices there. Throws what the decoding of an image threw.
  void finish(SceneDescription& scene);

 private:
  using Key = std::tuple<std::string, TextureUse, Wrap, Wrap, float>;

  void decode(const TextureSource& source, const std::vector<TextureUse>& uses,
              const std::vector<std::optional<Texture>*>& targets);
  std::optional<Texture> make(const std::string& name, const RawImage& raw, TextureUse use,
                              const TextureSource& source);
  RawImage read(const std::string& path);
  MemoryHold holdCopy(const RawImage& raw, TextureUse use);  // of the alpha that it takes out

  MemoryBudget& budget_;
  Warnings& warnings_;
  std::deque<std::optional<Texture>> slots_;  // a deque: tasks keep references
  std::map<Key, std::int32_t> known_;
  std::vector<std::function<void(SceneDescription&)>> changes_;
  DecodeQueue queue_;  // last: its workers write to the rest
};

}  // namespace whit
