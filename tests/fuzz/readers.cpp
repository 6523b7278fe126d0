#include "fuzz/readers.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "bake/scene.h"
#include "core/error.h"
#include "io/image/image_file.h"
#include "io/image/texture_from_image.h"
#include "io/load_scene.h"
#include "io/obj/mtl_reader.h"
#include "temporary_folder.h"
#ifdef WHIT_SERVE
#include "viewer/session/verbs.h"
#endif

namespace whit::fuzz {
namespace {

namespace fs = std::filesystem;

// Small enough for thousands of files a second, large enough for all of a corpus.
constexpr std::uint64_t kMemoryLimit = 64u << 20, kImageLimit = 8u << 20;

// A folder with a file to read and files beside it that the file may name. It is removed when the
// program ends.
class WorkFolder {
 public:
  WorkFolder() {
    ::setenv("WHIT_DATA", folder_.path().c_str(), 1);  // files that a file names are searched here
    for (const auto& [from, to] : {std::pair{"png/rgb.png", "t.png"},
                                   {"hdr/flat.hdr", "t.hdr"},
                                   {"obj/triangle.obj", "t.obj"},
                                   {"mtl/plain.mtl", "t.mtl"},
                                   {"ply/ascii.ply", "t.ply"}}) {
      fs::copy_file(corpusFolder() / from, folder_ / to);
    }
  }

  fs::path save(std::span<const std::uint8_t> bytes, const std::string& extension) const {
    const std::string file = folder_ / ("input" + extension);
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), std::ptrdiff_t(bytes.size()));
    if (!out.flush()) throw std::runtime_error("cannot write " + file);
    return file;
  }

 private:
  TemporaryFolder folder_;
};

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(std::string("the reader let through ") + what);
}

void requireNumbers(std::span<const float> numbers, const char* otherwise) {
  for (const float x : numbers) require(std::isfinite(x), otherwise);
}

void checkScene(const Scene& scene) {
  for (const TriangleRecord& triangle : scene.triangles) {
    for (const float x : triangle.position) {
      require(std::abs(x) <= kLargestCoordinate, "a corner that is not finite");
    }
    requireNumbers(triangle.uv, "a coordinate that is no number");
    require(triangle.material < scene.materials.size(), "a material that is not there");
  }

  for (const NormalRecord& record : scene.normals) {
    requireNumbers(record.normal, "a normal that is no number");
  }
  for (const UvRecord& record : scene.secondUvs) {
    requireNumbers(record.uv, "a coordinate that is no number");
  }

  for (const Geometry& geometry : scene.geometries) {
    for (const auto& triangle : geometry.index) {
      for (const std::uint32_t i : triangle) {
        require(i < geometry.position.size(), "an index out of range");
      }
    }
  }
  for (const InstanceRecord& instance : scene.instances) {
    require(instance.geometry < scene.geometries.size(), "an instance of nothing");
  }

  for (const Material& m : scene.materials) {
    for (const std::int32_t map : m.maps()) {
      require(map == kNoTexture || (map >= 0 && map < std::ssize(scene.textures)),
              "a texture that is not there");
    }
  }

  require(!scene.cameras.empty(), "a scene without a camera");
}

void checkTexture(const Texture& texture) {
  require(texture.width > 0 && texture.height > 0 && texture.rows().size() == texture.texelCount(),
          "a texture without its texels");
}

void readScene(const fs::path& file) {
  LoadOptions options;
  options.maxMemoryBytes = kMemoryLimit;
  options.threads = 1;

  // A scene that moves is also read at another time.
  for (const double seconds : {0.0, 0.5}) {
    if (seconds > 0) options.instant.seconds = seconds;
    Warnings warnings;
    const Scene scene = Scene::finalize(loadScene(file.string(), options, warnings), warnings);
    checkScene(scene);
    if (scene.animations.empty()) return;
  }
}

// Reads all materials of the file and their textures, whatever their names are.
void readMaterials(const fs::path& file) {
  Warnings warnings;
  std::map<std::string, MtlMaterial> materials;
  readMtl(file, materials, warnings);

  MemoryBudget budget(kMemoryLimit);
  TextureLoader textures(1, budget, warnings, nullptr);
  const PathRules rules(file.parent_path(), false);
  std::vector<GltfImageSource> images;
  std::vector<ObjMaterial> sources;
  for (const auto& [name, source] : materials) {
    sources.push_back(interpretMtl(source, file.parent_path(), rules, images, warnings));
  }

  GltfMapMaker maps(images, warnings);
  SceneDescription scene;
  std::vector<std::function<void(Material&)>> changes;
  for (const ObjMaterial& source : sources) {
    const auto shading = [&source](const GltfMeans& means) { return shadedAs(source, means); };
    TexturedMaterial made = maps.withMaps(source.surface, shading({}), {}, textures, shading);
    scene.materials.push_back(made.material);
    changes.push_back(made.whenDecoded);
  }

  textures.whenDone([&](SceneDescription& decoded) {
    for (const auto i : indices(changes)) changes[i](decoded.materials[i]);
  });
  textures.finish(scene);
  for (const Texture& texture : scene.textures) checkTexture(texture);

  // Every material gets a triangle, so that the scene keeps it.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (std::uint32_t i = 0; i < scene.materials.size(); ++i) {
    mesh.triangles.push_back({0, 1, 2});
    mesh.materials.push_back(i);
  }

  if (mesh.triangles.empty()) return;
  scene.objects.push_back({"", {mesh}});
  scene.instances.push_back({0, Affine()});
  checkScene(Scene::finalize(std::move(scene), warnings));
}

// Reads the image as a texture of every kind, a sky, and a picture to compare.
void readImageFile(const fs::path& file) {
  ImageLimits limits;
  limits.bytes = kImageLimit;
  MemoryBudget budget(kMemoryLimit);
  limits.budget = &budget;
  Warnings warnings;

  const RawImage raw = readStraightImage(file.string(), limits, warnings);
  for (const float value : raw.values) {
    require(value >= 0 && std::isfinite(value), "a texel that is no radiance");
  }

  checkTexture(makeTexture("t", raw, TexelFormat::color));
  checkTexture(makeTexture("t", raw, TexelFormat::data));
  checkTexture(makeEmissionTexture("t", raw, warnings));
  checkTexture(normalsFromHeights("t", raw, 1, Wrap::repeat, Wrap::clamp));
  if (hasTranslucentAlpha(raw)) checkTexture(makeAlphaTexture("t", raw));

  require(!makeEnvironment(raw).r.empty(), "a sky without pixels");
  readImage(file.string(), limits);
}

void readPng(const fs::path& file) {
  readImageFile(file);
  readPngMetadata(file.string());
}

void readExr(const fs::path& file) {
  readImageFile(file);
  readExrMetadata(file.string());
}

bool mayCause(ExitStatus status) {
  return status == ExitStatus::badScene || status == ExitStatus::limit || status == ExitStatus::io;
}

#ifdef WHIT_SERVE
// Reads what a page of `whit serve` sends. A value out of its verb's range is a finding.
void readInput(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = bytesOfFile(file);

  try {
    for (const view::Message& m :
         view::readMessages({reinterpret_cast<const char*>(bytes.data()), bytes.size()})) {
      const view::Numbers& numbers = m.verb->numbers;
      for (const auto i : indices(numbers.count)) {
        if (!(m.numbers[i] >= numbers.low && m.numbers[i] <= numbers.high)) {
          throw std::logic_error("a number out of range");
        }
      }
      for (const char c : m.name + m.text) {
        if (c >= 0 && (c < ' ' || c > '~')) throw std::logic_error("a control character");
      }
    }
  } catch (const Error& error) {
    if (error.status() != ExitStatus::usage) throw;
    throw Error(ExitStatus::badScene, error.what());
  }
}
#endif

}  // namespace

const std::vector<Reader>& readers() {
  static const std::vector<Reader> all = {
      {"scene", ".json", readScene},    {"obj", ".obj", readScene},
      {"mtl", ".mtl", readMaterials},   {"gltf", ".gltf", readScene},  // .glb by its signature
      {"ply", ".ply", readScene},       {"png", ".png", readPng},
#ifdef WHIT_ASSIMP
      {"stl", ".stl", readScene},       {"dae", ".dae", readScene},
      {"fbx", ".fbx", readScene},       {"3ds", ".3ds", readScene},
      {"off", ".off", readScene},
#endif
#ifdef WHIT_WEBP
      {"webp", ".webp", readImageFile},
#endif
      {"jpeg", ".jpg", readImageFile},  {"tga", ".tga", readImageFile},
      {"bmp", ".bmp", readImageFile},   {"hdr", ".hdr", readImageFile},
      {"exr", ".exr", readExr},
#ifdef WHIT_SERVE
      {"input", ".txt", readInput}
#endif
  };
  return all;
}

const Reader& readerNamed(const std::string& name) {
  const auto found = std::ranges::find(readers(), name, &Reader::name);
  if (found == readers().end()) throw std::logic_error("there is no reader " + name);
  return *found;
}

Answer give(const Reader& reader, std::span<const std::uint8_t> bytes) {
  static const WorkFolder folder;
  try {
    reader.read(folder.save(bytes, reader.extension));
  } catch (const Error& error) {
    if (mayCause(error.status())) return Answer::refused;
    throw std::logic_error(std::string("an error of the wrong kind: ") + error.what());
  } catch (const std::exception& error) {
    throw std::logic_error(reader.name + ": " + error.what());
  }
  return Answer::read;
}

fs::path corpusFolder() { return WHIT_FUZZ_CORPUS; }

std::vector<fs::path> corpusOf(const Reader& reader) {
  const fs::directory_iterator folder(corpusFolder() / reader.name);
  std::vector<fs::path> files(fs::begin(folder), fs::end(folder));
  std::ranges::sort(files);
  return files;
}

std::vector<std::uint8_t> bytesOfFile(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace whit::fuzz
