// Compressed meshes of a glTF file.
#ifdef WHIT_DRACO
#include <draco/compression/decode.h>
#endif
#ifdef WHIT_MESHOPT
#include <meshoptimizer.h>
#endif

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/text.h"
#include "io/confined.h"
#include "io/gltf/document.h"

namespace whit {

#ifdef WHIT_DRACO

namespace {

constexpr int kIndices = -1;  // in place of the number of an attribute
constexpr int kSeconds = 60;

// An accessor whose elements are compressed.
struct DracoArray {
  std::string where, accessor;  // place of the compressed mesh, pointer of the accessor
  Bytes mesh;
  int id = kIndices;  // unique number of the attribute within the mesh
  std::uint64_t type = 0;
  std::size_t components = 1;
};

// Calls use(T()) with the type of an accessor's components.
template <typename Use>
void withComponentType(std::uint64_t code, const Use& use) {
  if (code == 5120) use(std::int8_t());
  if (code == 5121) use(std::uint8_t());
  if (code == 5122) use(std::int16_t());
  if (code == 5123) use(std::uint16_t());
  if (code == 5125) use(std::uint32_t());
  if (code == 5126) use(float());
}

// Lists the accessors whose data Draco has compressed. The arrays of one mesh follow each other, so
// that each mesh is decoded once.
std::vector<DracoArray> dracoArrays(const GltfDocument& document) {
  std::vector<DracoArray> all;
  for (const JsonValue& mesh : document.list("meshes").elements()) {
    for (const JsonValue& primitive : mesh["primitives"].elements()) {
      const JsonValue source = primitive["extensions"]["KHR_draco_mesh_compression"];
      if (!source) continue;
      const Bytes bytes = document.view(source.need("bufferView")).bytes;

      const auto add = [&](const JsonValue& reference, int id) {
        const JsonValue accessor = accessorOf(document, reference);
        if (accessor["bufferView"].exists()) return;  // for readers without Draco
        const std::string type = accessor.need("type").textOr("");
        all.push_back({source.where(), accessor.pointer(), bytes, id,
                       accessor.need("componentType").wholeOr(0),
                       type.starts_with("VEC") ? static_cast<std::size_t>(type.back() - '0') : 1});
      };

      for (const auto& [name, id] : source.need("attributes").members()) {
        add(primitive.need("attributes").need(name),
            id.integer(0, std::numeric_limits<int>::max()));
      }
      add(primitive.need("indices"), kIndices);
    }
  }
  return all;
}

// The following three run in the child.
template <typename T>
bool copyAttribute(const draco::Mesh& mesh, const DracoArray& array, std::vector<T>& all) {
  const draco::PointAttribute* const attribute =
      mesh.GetAttributeByUniqueId(static_cast<std::uint32_t>(array.id));
  all.resize(std::size_t{mesh.num_points()} * array.components);

  if (!attribute) return false;

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
  // The type of the accessor's components must be able to hold the largest index.
  const std::uint32_t last = std::max(mesh.num_points(), 1u) - 1;
  if (static_cast<std::uint32_t>(static_cast<T>(last)) != last) return false;

  for (std::uint32_t i = 0; i < mesh.num_faces(); ++i) {
    for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i))) {
      all.push_back(static_cast<T>(corner.value()));
    }
  }
  return true;
}

// Writes the size of each array and the array, up to the first that the data do not have.
void decodeArrays(const std::vector<DracoArray>& arrays, const ConfinedWriter& write) {
  const std::uint8_t* decoded = nullptr;
  std::unique_ptr<draco::Mesh> mesh;
  for (const DracoArray& array : arrays) {
    // All arrays of a mesh come from one decoding.
    if (std::exchange(decoded, array.mesh.data()) != array.mesh.data() || !mesh) {
      draco::DecoderBuffer buffer;
      buffer.Init(reinterpret_cast<const char*>(array.mesh.data()), array.mesh.size());
      mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer).value();
      if (!mesh) return;
    }

    bool copied = false;
    withComponentType(array.type, [&](auto kind) {
      std::vector<decltype(kind)> all;
      copied = array.id == kIndices ? copyIndices(*mesh, all) : copyAttribute(*mesh, array, all);
      if (!copied) return;

      const std::uint64_t size = all.size() * sizeof kind;
      write(&size, sizeof size);
      write(all.data(), size);
    });
    if (!copied) return;
  }
}

// Draco's decoder runs in a process of its own (runConfined), because damaged data can break it.
void decodeDraco(const GltfDocument& document, std::map<std::string, std::string>& decoded) {
  const std::vector<DracoArray> arrays = dracoArrays(document);
  if (arrays.empty()) return;

  const ConfinedAnswer answer = runConfined(
      arrays[0].where, [&](const ConfinedWriter& write) { decodeArrays(arrays, write); },
      document.budget().left() / 2, kSeconds);

  // The answer holds the arrays in the same order, each behind its size.
  std::string_view left = answer.bytes;
  for (const DracoArray& array : arrays) {
    std::uint64_t size = 0;
    if (left.size() >= sizeof size) std::memcpy(&size, left.data(), sizeof size);
    if (left.size() < sizeof size || size > left.size() - sizeof size) {
      throwBadScene(array.where,
                    "expected a mesh that Draco's decoder can read, but " +
                        (answer.failure.empty() ? "it found damaged data" : answer.failure));
    }

    document.budget().charge(size, 1, array.where);
    decoded[array.accessor] = left.substr(sizeof size, size);
    left.remove_prefix(sizeof size + size);
  }
}

}  // namespace

#endif
#ifdef WHIT_MESHOPT

namespace {

// Tells whether elements may have the size of `stride` bytes (EXT_meshopt_compression).
bool suits(const std::string& mode, const std::string& filter, std::size_t stride) {
  if (mode != "ATTRIBUTES") return filter == "NONE" && (stride == 2 || stride == 4);
  if (filter == "QUATERNION") return stride == 8;
  if (filter == "OCTAHEDRAL") return stride == 4 || stride == 8;
  return stride % 4 == 0;
}

// The decoders of meshoptimizer are made for damaged data, but rely on the arguments checked here.
std::string decodeView(const GltfDocument& document, const JsonValue& view,
                       const JsonValue& source) {
  const std::string mode = source.need("mode").word({"ATTRIBUTES", "TRIANGLES", "INDICES"});
  const JsonValue named = source["filter"];
  const std::string filter =
      named ? named.word({"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"}) : "NONE";
  const std::uint64_t count = source.need("count").wholeOr(0);
  const std::size_t stride = source.need("byteStride").integer(2, 256);

  if (!suits(mode, filter, stride)) {
    source["byteStride"].fail("a size of elements that mode and filter have");
  }
  if (view.need("byteLength").wholeOr(0) != count * stride) {
    view["byteLength"].fail(concat("the ", count * stride, " bytes that are compressed"));
  }
  if (mode == "TRIANGLES" && count % 3 != 0) source["count"].fail("a multiple of 3");

  document.budget().charge(count, stride, source.where());
  std::string all(count * stride, '\0');
  const Bytes from = document.range(source);
  auto* decode = &meshopt_decodeVertexBuffer;
  if (mode == "TRIANGLES") decode = &meshopt_decodeIndexBuffer;
  if (mode == "INDICES") decode = &meshopt_decodeIndexSequence;
  if (decode(all.data(), count, stride, from.data(), from.size()) != 0) {
    source.fail("data that meshoptimizer can decode", "damaged data");
  }

  // The filters turn quantized directions, rotations and numbers into their final form in place.
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(all.data(), count, stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(all.data(), count, stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(all.data(), count, stride);
  return all;
}

}  // namespace

#endif

std::map<std::string, std::string> decodeCompressed([[maybe_unused]] const GltfDocument& document) {
  std::map<std::string, std::string> decoded;
#ifdef WHIT_MESHOPT
  for (const JsonValue& view : document.list("bufferViews").elements()) {
    const JsonValue source = view["extensions"]["EXT_meshopt_compression"];
    if (source) decoded[view.pointer()] = decodeView(document, view, source);
  }
#endif
#ifdef WHIT_DRACO
  decodeDraco(document, decoded);
#endif
  return decoded;
}

}  // namespace whit
