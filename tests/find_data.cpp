// Where $WHIT_DATA is not set, the tests of an area and what they start find real scenes beside the
// checkout, in ../shared/data.
#include <cstdlib>
#include <filesystem>

namespace {

[[maybe_unused]] const bool kFound = [] {
  const char* const source = std::getenv("WHIT_SOURCE_DIR");
  const auto folder = std::filesystem::path(source ? source : ".") / "../shared/data";
  std::error_code none;
  return std::filesystem::exists(folder, none) && ::setenv("WHIT_DATA", folder.c_str(), 0) == 0;
}();

}  // namespace
