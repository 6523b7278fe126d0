#include "io/gltf/compressed.h"

#ifdef WHIT_DRACO
#include <draco/compression/decode.h>
#endif
#ifdef WHIT_MESHOPT
#include <meshoptimizer.h>
#endif

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/confined.h"
#include "io/read_file.h"

namespace whit {

#ifdef WHIT_MESHOPT

std::optional<std::string> decodeMeshopt(const GltfDocument& document, const JsonValue& view) {
  const JsonValue extensions = view["extensions"];
  const JsonValue khronos = extensions["KHR_meshopt_compression"];
  const JsonValue source = khronos ? khronos : extensions["EXT_meshopt_compression"];
  if (!source) return std::nullopt;
  const Bytes packed = document.range(source);
  constexpr std::uint64_t kLargestStride = 256;
  const std::uint64_t stride = source.need("byteStride").wholeOr(0, kLargestStride);
  const std::uint64_t count = source.need("count").wholeOr(0, kLargestJsonWhole / kLargestStride);
  const std::string mode = source.need("mode").word({"ATTRIBUTES", "TRIANGLES", "INDICES"});
  const std::string filter =
      source["filter"].exists()
          ? source["filter"].word({"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"})
          : "NONE";
  const bool isIndex = mode != "ATTRIBUTES", isOctahedral = filter == "OCTAHEDRAL";
  if (isIndex ? stride != 2 && stride != 4 : stride % 4 != 0 || stride == 0) {
    source["byteStride"].fail(isIndex ? "2 or 4" : "a multiple of 4");
  }
  if (mode == "TRIANGLES" && count % 3 != 0) source["count"].fail("a multiple of 3");
  if (filter != "NONE" && (isIndex || (isOctahedral && stride != 4 && stride != 8) ||
                           (filter == "QUATERNION" && stride != 8))) {
    source["filter"].fail("a filter that suits mode and stride");
  }
  // A byte stands for at most 64, so that small files do not take much memory.
  constexpr std::uint64_t kLargestRatio = 64;
  const bool isShort = count * stride / kLargestRatio > packed.size();
  const std::uint64_t size = isShort ? 0 : count * stride;
  document.budget().charge(1, size, source.where());
  std::string bytes(size, '\0');
  const auto* from = packed.data();
  const int failed =
      isShort ? 1
      : mode == "TRIANGLES"
          ? meshopt_decodeIndexBuffer(bytes.data(), count, stride, from, packed.size())
      : isIndex ? meshopt_decodeIndexSequence(bytes.data(), count, stride, from, packed.size())
                : meshopt_decodeVertexBuffer(bytes.data(), count, stride, from, packed.size());
  if (failed != 0) {
    throwBadScene(source.where(),
                  "libmeshoptimizer cannot decode these " + std::to_string(packed.size()) +
                      " bytes: they are damaged, or of a version that it does not know");
  }
  if (isOctahedral) meshopt_decodeFilterOct(bytes.data(), count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), count, stride);
  return bytes;
}

#else
std::optional<std::string> decodeMeshopt(const GltfDocument&, const JsonValue&) { return {}; }
#endif

#ifdef WHIT_DRACO

namespace {

constexpr int kIndices = -1;  // in place of the number of an attribute
constexpr int kSeconds = 60;

struct DracoArray {
  int id = kIndices;          // unique number of the attribute within the compressed mesh
  std::string accessor = {};  // its pointer
  std::uint64_t type = 0;     // of its components
  std::size_t components = 1;
};

struct DracoMesh {
  std::string where;
  Bytes bytes;
  std::vector<DracoArray> arrays;
};

// Calls use(T()) with the type of an accessor's components.
template <typename Use>
void withComponentType(std::uint64_t code, const Use& use) {
  if (code == 5120) return use(std::int8_t());
  if (code == 5121) return use(std::uint8_t());
  if (code == 5122) return use(std::int16_t());
  if (code == 5123) return use(std::uint16_t());
  if (code == 5125) return use(std::uint32_t());
  if (code == 5126) return use(float());
}

void add(const GltfDocument& document, const JsonValue& reference, int id, DracoMesh& mesh) {
  const JsonValue accessor = accessorOf(document, reference);
  if (accessor["bufferView"].exists()) return;  // uncompressed data for readers without Draco
  DracoArray array{id, accessor.pointer(), accessor.need("componentType").wholeOr(0)};
  const std::string type = accessor.need("type").textOr("");
  array.components = type.starts_with("VEC") ? static_cast<std::size_t>(type.back() - '0') : 1;
  mesh.arrays.push_back(array);
}

std::vector<DracoMesh> dracoMeshes(const GltfDocument& document) {
  std::vector<DracoMesh> all;
  const JsonValue meshes = document.list("meshes");
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const JsonValue primitives = meshes[i]["primitives"];
    for (std::size_t k = 0; k < primitives.size(); ++k) {
      const JsonValue primitive = primitives[k];
      const JsonValue source = primitive["extensions"]["KHR_draco_mesh_compression"];
      if (!source) continue;
      DracoMesh mesh{source.where(), document.view(source.need("bufferView")).bytes, {}};
      for (const auto& [name, id] : source.need("attributes").members()) {
        add(document, primitive.need("attributes").need(name),
            id.integer(0, std::numeric_limits<int>::max()), mesh);
      }
      add(document, primitive.need("indices"), kIndices, mesh);
      if (!mesh.arrays.empty()) all.push_back(std::move(mesh));
    }
  }
  return all;
}

// The following three run in the child.
template <typename T>
bool copyAttribute(const draco::Mesh& mesh, const DracoArray& array, std::vector<T>& all) {
  const draco::PointAttribute* const attribute =
      mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(array.id));
  if (!attribute) return false;
  all.resize(std::size_t{mesh.num_points()} * array.components);
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    const bool known = attribute->ConvertValue(attribute->mapped_index(draco::PointIndex(i)),
                                               static_cast<std::int8_t>(array.components),
                                               all.data() + i * array.components);
    if (!known) return false;
  }
  return true;
}

template <typename T>
bool copyIndices(const draco::Mesh& mesh, std::vector<T>& all) {
  const std::uint32_t last = std::max(mesh.num_points(), 1u) - 1;
  if (static_cast<std::uint32_t>(static_cast<T>(last)) != last) return false;
  for (std::uint32_t i = 0; i < mesh.num_faces(); ++i) {
    for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i))) {
      all.push_back(static_cast<T>(corner.value()));
    }
  }
  return true;
}

// Writes the size of each array and the array.
bool decodeMesh(const DracoMesh& source, const ConfinedWriter& write) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size());
  draco::Decoder decoder;
  const auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) return false;
  for (const DracoArray& array : source.arrays) {
    bool copied = false;
    withComponentType(array.type, [&](auto kind) {
      std::vector<decltype(kind)> all;
      copied = array.id == kIndices ? copyIndices(*mesh.value(), all)
                                    : copyAttribute(*mesh.value(), array, all);
      const std::uint64_t size = all.size() * sizeof kind;
      if (!copied) return;
      write(&size, sizeof size);
      write(all.data(), size);
    });
    if (!copied) return false;
  }
  return true;
}

}  // namespace

std::map<std::string, std::string> decodeDraco(const GltfDocument& document) {
  std::map<std::string, std::string> decoded;
  const std::vector<DracoMesh> meshes = dracoMeshes(document);
  if (meshes.empty()) return decoded;
  const auto decodeAll = [&](const ConfinedWriter& write) {
    for (const DracoMesh& mesh : meshes) {
      if (!decodeMesh(mesh, write)) return;
    }
  };
  const ConfinedAnswer answer = runConfined(decodeAll, document.budget().left() / 2, kSeconds);
  std::string_view left = answer.bytes;
  for (const DracoMesh& mesh : meshes) {
    for (const DracoArray& array : mesh.arrays) {
      std::uint64_t size = 0;
      if (left.size() >= sizeof size) std::memcpy(&size, left.data(), sizeof size);
      if (left.size() < sizeof size || size > left.size() - sizeof size) {
        throwBadScene(mesh.where,
                      "expected a mesh that Draco's decoder can read, but " +
                          (answer.failure.empty() ? "it found damaged data" : answer.failure));
      }
      document.budget().charge(size, 1, mesh.where);
      decoded[array.accessor] = left.substr(sizeof size, size);
      left.remove_prefix(sizeof size + size);
    }
  }
  return decoded;
}

#else
std::map<std::string, std::string> decodeDraco(const GltfDocument&) { return {}; }
#endif

}  // namespace whit
