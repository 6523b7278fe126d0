// A libFuzzer target; WHIT_FUZZ_READER names its reader.
#include <cstddef>
#include <cstdint>

#include "fuzz/readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const whit::fuzz::Reader& reader = whit::fuzz::readerNamed(WHIT_FUZZ_READER);
  whit::fuzz::give(reader, {bytes, size});
  return 0;
}
