// The program gets real files that are cut short or have flipped bits. It makes a scene or reports
// an error, and never crashes, hangs or takes more memory than is allowed.
//   WHIT_DAMAGED_VERSIONS=200 WHIT_DAMAGED_BYTES=30000000 build/tests/fuzz_test
//   --gtest_filter=DamagedData.*
// tries more versions of each file, and larger files.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <map>

#include "cli/run_program.h"
#include "fuzz/damage.h"
#include "io/files.h"
#include "sanitized.h"

namespace whit::fuzz {
namespace {

namespace fs = std::filesystem;
using cli::Outcome;
using cli::TemporaryFolder;

std::uint64_t setting(const char* name, std::uint64_t fallback) {
  const char* text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 10) : fallback;
}

// Returns the smallest file of every kind, or all files of up to WHIT_DAMAGED_BYTES.
std::vector<fs::path> filesToDamage() {
  const std::uint64_t most = setting("WHIT_DAMAGED_BYTES", 0);
  std::map<std::string, std::vector<fs::path>> kinds;
  for (const auto& entry : fs::recursive_directory_iterator(dataFolder())) {
    if (entry.is_regular_file()) kinds[entry.path().extension()].push_back(entry.path());
  }

  std::vector<fs::path> chosen;
  for (const char* kind : {".obj", ".mtl", ".gltf", ".glb", ".bin", ".ply", ".png", ".jpg", ".jpeg",
                           ".tga", ".hdr", ".exr"}) {
    std::vector<fs::path>& files = kinds[kind];
    std::ranges::sort(files, {},
                      [](const fs::path& file) { return std::pair(fs::file_size(file), file); });
    for (std::size_t i = 0; i < files.size(); ++i) {
      if (i == 0 || fs::file_size(files[i]) <= most) chosen.push_back(files[i]);
    }
  }
  return chosen;
}

// Returns a scene that uses the file in `folder`, where links to all files beside the original are
// made.
std::string sceneWith(const fs::path& original, const TemporaryFolder& folder) {
  const std::string kind = original.extension(), name = original.filename();
  for (const auto& entry : fs::directory_iterator(original.parent_path())) {
    if (entry.path() != original) {
      fs::create_symlink(entry.path(), folder.path() / entry.path().filename());
    }
  }

  if (kind == ".obj" || kind == ".gltf" || kind == ".glb" || kind == ".ply") return folder / name;
  if (kind == ".mtl" || kind == ".bin") {
    const std::string user = kind == ".mtl" ? ".obj" : ".gltf";
    for (const auto& entry : fs::directory_iterator(original.parent_path())) {
      if (entry.path().extension() == user) return folder / entry.path().filename().string();
    }
  }

  // An image becomes a sky and a texture.
  const std::string image = "{\"image\": \"" + name + "\"}";
  std::ofstream(folder / "s.json")
      << "{\"whit\": 1, \"sky\": " << image << ", \"textures\": {\"t\": " << image << "}}";
  return folder / "s.json";
}

void limitChild() {
  constexpr rlim_t kMemory = rlim_t{6} << 30;  // of addresses: the limit below and the program
  const rlimit memory{kMemory, kMemory};
  if (!kSanitized) setrlimit(RLIMIT_AS, &memory);
  const rlimit seconds{60, 60};  // far longer than any run takes
  setrlimit(RLIMIT_CPU, &seconds);
}

void tryVersionsOf(const fs::path& original, std::uint32_t versions) {
  const TemporaryFolder folder;
  const std::string scene = sceneWith(original, folder);
  const std::string text = cli::readFile(original);
  const Bytes whole(text.begin(), text.end());
  for (std::uint32_t seed = 0; seed < versions; ++seed) {
    const Bytes bytes = damaged(whole, seed);
    std::ofstream(folder / original.filename(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));

    const Outcome outcome =
        cli::runWhit({"info", scene, "--quiet", "--max-memory", "2"}, limitChild);
    // The statuses mean 3: a bad file, 4: a file that is not there, 5: more memory than the limit.
    EXPECT_TRUE(outcome.status == 0 || (outcome.status >= 3 && outcome.status <= 5))
        << "status " << outcome.status << ", seed " << seed << " of " << original << "\n"
        << outcome.err.substr(0, 2000);
  }
}

TEST(DamagedData, GivesASceneOrAnError) {
  if (!fs::exists(dataFolder())) {
    GTEST_SKIP() << "no damaged versions of real files: there is no " << dataFolder();
  }
  const std::vector<fs::path> files = filesToDamage();
  EXPECT_FALSE(files.empty());
  const auto versions = static_cast<std::uint32_t>(setting("WHIT_DAMAGED_VERSIONS", 6));
  for (const fs::path& file : files) tryVersionsOf(file, versions);
  std::printf("%u versions of each of %zu files\n", versions, files.size());
}

}  // namespace
}  // namespace whit::fuzz
