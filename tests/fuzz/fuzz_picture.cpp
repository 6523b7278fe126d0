// The libFuzzer target of random pictures. WHIT_FUZZ_TARGET names the SIMD target (--simd).
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "fuzz/random_picture.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const char* const target = std::getenv("WHIT_FUZZ_TARGET");
  whit::fuzz::renderPicture({bytes, size}, target ? target : "auto");
  return 0;
}
