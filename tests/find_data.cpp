// Where the environment does not say so, the tests of an area and what they start find the sources
// above the build that the test is in, and real scenes beside them, in ../shared/data.
#include <cstdlib>
#include <filesystem>

namespace {

// Calls setenv() if there is the file or folder.
bool found(const char* variable, const std::filesystem::path& folder, const char* holds = "") {
  std::error_code none;
  return std::filesystem::exists(folder / holds, none) &&
         ::setenv(variable, folder.c_str(), 0) == 0;
}

[[maybe_unused]] const bool kFound = [] {
  std::error_code none;
  auto above = std::filesystem::read_symlink("/proc/self/exe", none);
  while (above.has_relative_path() && !found("WHIT_SOURCE_DIR", above, "tests/find_data.cpp")) {
    above = above.parent_path();
  }

  const char* const source = std::getenv("WHIT_SOURCE_DIR");
  return found("WHIT_DATA", std::filesystem::path(source ? source : ".") / "../shared/data");
}();

}  // namespace
