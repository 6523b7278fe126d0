#include "io/gltf/accessor.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "core/error.h"

namespace whit {
namespace {

// An accessor without a buffer view consists of zeros, so that the size of the file does not limit
// the number of its elements.
constexpr std::uint64_t kZeroElementLimit = 1u << 24;

// Values of componentType.
enum GltfComponent : std::uint64_t {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126
};

constexpr std::pair<std::string_view, std::size_t> kComponentsOfType[] = {
    {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};

std::size_t componentsIn(std::string_view type) {
  return std::find_if(std::begin(kComponentsOfType), std::end(kComponentsOfType),
                      [&](const auto& known) { return known.first == type; })
      ->second;
}

template <typename T>
T loadAs(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

// Section 3.11 of the specification for normalized integers.
template <typename T>
float floatAt(const std::uint8_t* from, bool normalized) {
  const T value = loadAs<T>(from);
  if constexpr (std::is_floating_point_v<T>) {
    return value;
  } else {
    if (!normalized) return static_cast<float>(value);
    const double unit = static_cast<double>(value) / std::numeric_limits<T>::max();
    return static_cast<float>(std::max(unit, -1.0));
  }
}

float component(const std::uint8_t* from, std::uint64_t type, bool normalized) {
  switch (type) {
    case kByte:
      return floatAt<std::int8_t>(from, normalized);
    case kUnsignedByte:
      return floatAt<std::uint8_t>(from, normalized);
    case kShort:
      return floatAt<std::int16_t>(from, normalized);
    case kUnsignedShort:
      return floatAt<std::uint16_t>(from, normalized);
    case kUnsignedInt:
      return floatAt<std::uint32_t>(from, normalized);
    default:
      return floatAt<float>(from, normalized);
  }
}

std::uint32_t indexAt(const std::uint8_t* from, std::uint64_t type) {
  if (type == kUnsignedByte) return *from;
  if (type == kUnsignedShort) return loadAs<std::uint16_t>(from);
  return loadAs<std::uint32_t>(from);
}

std::uint64_t bytesPerComponent(const JsonValue& componentType) {
  switch (componentType.wholeOr(0)) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      componentType.fail("5120 to 5123, 5125 or 5126");
  }
}

std::uint64_t indexTypeOf(const JsonValue& componentType) {
  const std::uint64_t type = componentType.wholeOr(0);
  if (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt) {
    componentType.fail("5121, 5123 or 5125");
  }
  return type;
}

// Equally spaced elements that are known to lie within their buffer view.
struct Run {
  const std::uint8_t* first = nullptr;
  std::uint64_t stride = 0;
  const std::uint8_t* at(std::uint64_t i) const { return first + i * stride; }
};

// Elements of the buffer view that `source`, an accessor or a part of a sparse one, refers to.
Run elementsWithin(const GltfDocument& document, const JsonValue& source, bool strided,
                   std::uint64_t elementBytes, std::uint64_t count) {
  const GltfBufferView view = document.view(source.need("bufferView"));
  const std::uint64_t stride = strided && view.stride > 0 ? view.stride : elementBytes;
  const std::uint64_t size = view.bytes.size(), offset = source["byteOffset"].wholeOr(0);
  if (stride < elementBytes) {
    document.list("bufferViews")[view.index]["byteStride"].fail(
        "at least the " + std::to_string(elementBytes) + " bytes of an element of " +
        source.where());
  }
  const bool first = offset <= size && elementBytes <= size - offset;
  const std::uint64_t fit = first ? (size - offset - elementBytes) / stride + 1 : 0;
  if (count > fit) {
    source.fail("at most " + std::to_string(fit) + " elements, as many as fit into buffer view " +
                    std::to_string(view.index),
                std::to_string(count));
  }
  return {count > 0 ? view.bytes.data() + offset : nullptr, stride};
}

class AccessorReader {
 public:
  AccessorReader(const GltfDocument& document, const JsonValue& accessor, std::string_view type,
                 std::string_view expected)
      : document_(document),
        accessor_(accessor),
        components_(componentsIn(type)),
        size_(bytesPerComponent(accessor.need("componentType"))),
        count_(accessor.need("count").wholeOr(0)),
        componentType_(accessor["componentType"].wholeOr(0)),
        normalized_(accessor["normalized"].flagOr(false)) {
    if (accessor.need("type").textOr("") != type) accessor["type"].fail(std::string(expected));
    if (accessor["bufferView"].exists()) {
      dense_ = elementsWithin(document, accessor, true, size_ * components_, count_);
    } else if (count_ > kZeroElementLimit) {
      accessor.fail("a buffer view for " + std::to_string(count_) + " elements", "none");
    }
  }

  std::uint64_t count() const { return count_; }
  std::size_t components() const { return components_; }

  // Calls set(i, bytes) for each element that is not zero, and again for each one that a sparse
  // accessor replaces. Elements that are not set are zero.
  template <typename Element, typename Set>
  std::vector<Element> read(std::size_t perElement, const Set& set) const {
    document_.budget().charge(count_, perElement * sizeof(Element), accessor_.where());
    std::vector<Element> all(count_ * perElement);
    for (std::uint64_t i = 0; dense_.first && i < count_; ++i) {
      set(&all[i * perElement], dense_.at(i));
    }
    if (accessor_["sparse"].exists()) {
      readSparse(
          [&](std::uint64_t i, const std::uint8_t* from) { set(&all[i * perElement], from); });
    }
    return all;
  }

  float at(const std::uint8_t* element, std::uint64_t i) const {
    return component(element + i * size_, componentType_, normalized_);
  }

 private:
  template <typename Set>
  void readSparse(const Set& set) const {
    const JsonValue sparse = accessor_["sparse"], indices = sparse.need("indices");
    const std::uint64_t count =
        sparse.need("count").wholeOr(0, std::numeric_limits<std::int32_t>::max());
    const std::uint64_t type = indexTypeOf(indices.need("componentType"));
    const Run which = elementsWithin(document_, indices, false,
                                     bytesPerComponent(indices["componentType"]), count);
    const Run values =
        elementsWithin(document_, sparse.need("values"), false, size_ * components_, count);
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint32_t index = indexAt(which.at(i), type);
      if (index >= count_) {
        indices.fail("indices below the accessor's count of " + std::to_string(count_),
                     std::to_string(index));
      }
      set(index, values.at(i));
    }
  }

  const GltfDocument& document_;
  JsonValue accessor_;
  std::size_t components_;
  std::uint64_t size_, count_, componentType_;
  bool normalized_;
  Run dense_;
};

AccessorReader readerOf(const GltfDocument& document, const JsonValue& reference,
                        std::string_view type) {
  return {document, accessorOf(document, reference), type, type};
}

}  // namespace

JsonValue accessorOf(const GltfDocument& document, const JsonValue& reference) {
  const JsonValue accessors = document.list("accessors");
  const std::optional<std::size_t> index = reference.indexInto(accessors);
  if (!index) reference.fail("an accessor");
  return accessors[*index];
}

std::vector<Vec3f> readVectors(const GltfDocument& document, const JsonValue& reference) {
  const AccessorReader reader = readerOf(document, reference, "VEC3");
  return reader.read<Vec3f>(1, [&](Vec3f* to, const std::uint8_t* from) {
    *to = {reader.at(from, 0), reader.at(from, 1), reader.at(from, 2)};
  });
}

std::vector<Vec2f> readUvs(const GltfDocument& document, const JsonValue& reference) {
  const AccessorReader reader = readerOf(document, reference, "VEC2");
  return reader.read<Vec2f>(1, [&](Vec2f* to, const std::uint8_t* from) {
    *to = {reader.at(from, 0), reader.at(from, 1)};
  });
}

GltfColors readColors(const GltfDocument& document, const JsonValue& reference) {
  const JsonValue accessor = accessorOf(document, reference);
  const bool alpha = accessor["type"].textOr("") == "VEC4";
  const AccessorReader reader(document, accessor, alpha ? "VEC4" : "VEC3", "VEC3 or VEC4");
  GltfColors result;
  result.colors = reader.read<Rgb>(1, [&](Rgb* to, const std::uint8_t* from) {
    *to = {reader.at(from, 0), reader.at(from, 1), reader.at(from, 2)};
    if (alpha) result.translucent = result.translucent || reader.at(from, 3) < 1;
  });
  return result;
}

std::vector<float> readTuples(const GltfDocument& document, const JsonValue& reference,
                              std::string_view type) {
  const AccessorReader reader = readerOf(document, reference, type);
  return reader.read<float>(reader.components(), [&](float* to, const std::uint8_t* from) {
    for (std::size_t k = 0; k < reader.components(); ++k) to[k] = reader.at(from, k);
  });
}

std::vector<std::uint32_t> readIndices(const GltfDocument& document, const JsonValue& reference) {
  const AccessorReader reader = readerOf(document, reference, "SCALAR");
  const std::uint64_t type = indexTypeOf(accessorOf(document, reference)["componentType"]);
  return reader.read<std::uint32_t>(
      1, [&](std::uint32_t* to, const std::uint8_t* from) { *to = indexAt(from, type); });
}

}  // namespace whit
