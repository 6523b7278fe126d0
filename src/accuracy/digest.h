// Digests of all that a picture depends on, 128 bits of XXH3 as 32 hexadecimal digits.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "bake/scene.h"
#include "core/image.h"
#include "core/options.h"

namespace whit::accuracy {

class Digester {
 public:
  Digester();
  ~Digester();
  Digester(const Digester&) = delete;
  Digester& operator=(const Digester&) = delete;

  void bytes(const void* data, std::size_t size);
  // Preceded by its length, so that "ab", "c" and "a", "bc" differ.
  void text(std::string_view text);
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Every table of the finalized scene that a picture can depend on. Its name, its own size, its
// cameras and the reasons for its effects are left out: what is used of them comes from elsewhere.
std::string digestOf(const Scene& scene);
// Every option that can change a picture, but the name of the preset:
// what it stands for is in the others.
std::string digestOf(const RenderOptions& options);
std::string digestOf(const Camera& camera);
// Size, window and the bits of all pixels.
std::string digestOf(const Image& image);
// The program that is running, "unknown" where it cannot be read.
std::string digestOfProgram();

}  // namespace whit::accuracy
