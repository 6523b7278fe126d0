// Reads accessors of a glTF document. glTF 2.0 specification, section 3.6.2.
#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

#include "core/index.h"
#include "core/text.h"
#include "io/gltf/document.h"

namespace whit {
namespace {

// An accessor without a buffer view consists of zeros, so that the size of the file does not limit
// the number of its elements.
constexpr std::uint64_t kZeroElementLimit = 1u << 24;

// Section 3.11 of the specification defines how normalized integers are decoded.
template <typename T>
double valueAs(const std::uint8_t* from, bool normalized) {
  T value;
  std::memcpy(&value, from, sizeof value);
  if (std::is_floating_point_v<T> || !normalized) return value;
  return std::max(static_cast<double>(value) / std::numeric_limits<T>::max(), -1.0);
}

struct ComponentType {
  std::uint64_t code, bytes;
  double (*value)(const std::uint8_t* from, bool normalized);
  bool isIndex;

  std::uint32_t index(const std::uint8_t* from) const {
    return static_cast<std::uint32_t>(value(from, false));
  }
};
constexpr ComponentType kComponentTypes[] = {
    {5120, 1, valueAs<std::int8_t>, false},  {5121, 1, valueAs<std::uint8_t>, true},
    {5122, 2, valueAs<std::int16_t>, false}, {5123, 2, valueAs<std::uint16_t>, true},
    {5125, 4, valueAs<std::uint32_t>, true}, {5126, 4, valueAs<float>, false}};

ComponentType componentTypeOf(const JsonValue& code, bool forIndices = false) {
  const std::uint64_t found = code.wholeOr(0);
  for (const ComponentType& type : kComponentTypes) {
    if (type.code == found && (type.isIndex || !forIndices)) return type;
  }
  code.fail(forIndices ? "5121, 5123 or 5125" : "5120 to 5123, 5125 or 5126");
}

// Returns the name of the accessor type with this number of components.
const char* typeOf(std::size_t components) {
  constexpr const char* kTypes[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
  return components > std::size(kTypes) ? "MAT4" : kTypes[components - 1];
}

// Equally spaced elements that are known to lie within their buffer view.
struct StridedElements {
  const std::uint8_t* first = nullptr;
  std::uint64_t stride = 0;
  const std::uint8_t* at(std::uint64_t i) const { return first + i * stride; }
};

// Only the elements of an accessor itself follow the stride of their buffer view.
enum class Spacing { packed, byView };

// Finds the elements of the buffer view that `source`, an accessor or a part of a sparse one,
// refers to.
StridedElements elementsWithin(const GltfDocument& document, const JsonValue& source,
                               Spacing spacing, std::uint64_t elementBytes, std::uint64_t count) {
  const GltfBufferView view = document.view(source.need("bufferView"));
  const bool hasStride = spacing == Spacing::byView && view.stride > 0;
  const std::uint64_t stride = hasStride ? view.stride : elementBytes;
  const std::uint64_t size = view.bytes.size(), offset = source["byteOffset"].wholeOr(0);
  if (stride < elementBytes) {
    document.list("bufferViews")[view.index]["byteStride"].fail(
        concat("at least the ", elementBytes, " bytes of an element of ", source.where()));
  }

  // `fit` is the number of elements up to the end of the view, where the last one needs no full
  // stride.
  const bool first = offset <= size && elementBytes <= size - offset;
  const std::uint64_t fit = first ? (size - offset - elementBytes) / stride + 1 : 0;
  if (count > fit) {
    source.fail(concat("at most ", fit, " elements, as many as fit into buffer view ", view.index),
                std::to_string(count));
  }
  return {count > 0 ? view.bytes.data() + offset : nullptr, stride};
}

class AccessorReader {
 public:
  AccessorReader(const GltfDocument& document, const JsonValue& accessor, std::size_t components,
                 const std::string& expected)
      : document_(document),
        accessor_(accessor),
        component_(componentTypeOf(accessor.need("componentType"))),
        bytes_(component_.bytes * components),
        count_(accessor.need("count").wholeOr(0)),
        normalized_(accessor["normalized"].flagOr(false)) {
    if (accessor.need("type").textOr("") != typeOf(components)) accessor["type"].fail(expected);

    // Elements come from compressed data or a buffer view; without either they are all zero.
    if (const std::optional<Bytes> bytes = document.decoded(accessor)) {
      count_ = bytes->size() / bytes_;  // the accessor's own count is often wrong
      dense_ = {bytes->data(), bytes_};
    } else if (accessor["bufferView"].exists()) {
      dense_ = elementsWithin(document, accessor, Spacing::byView, bytes_, count_);
    } else if (count_ > kZeroElementLimit) {
      accessor.fail(concat("a buffer view for ", count_, " elements"), "none");
    }
  }

  // Calls set(to, bytes) for each element that is not zero, and again for each one that a sparse
  // accessor replaces. Elements that are not set are zero.
  template <typename Element, typename Set>
  std::vector<Element> read(std::size_t perElement, const Set& set) const {
    document_.budget().charge(count_, perElement * sizeof(Element), accessor_.where());
    std::vector<Element> all(count_ * perElement);
    for (std::uint64_t i = 0; dense_.first && i < count_; ++i) {
      set(&all[i * perElement], dense_.at(i));
    }

    // A sparse accessor lists the indices and values of the elements that differ (section 3.6.2.3).
    const JsonValue sparse = accessor_["sparse"];
    if (!sparse.exists()) return all;
    const JsonValue replaced = sparse.need("indices");
    const std::uint64_t count =
        sparse.need("count").wholeOr(0, std::numeric_limits<std::int32_t>::max());

    const ComponentType type = componentTypeOf(replaced.need("componentType"), true);
    const StridedElements which =
        elementsWithin(document_, replaced, Spacing::packed, type.bytes, count);
    const StridedElements values =
        elementsWithin(document_, sparse.need("values"), Spacing::packed, bytes_, count);

    for (const auto i : indices(count)) {
      const std::uint32_t index = type.index(which.at(i));
      if (index >= count_) {
        replaced.fail(concat("indices below the accessor's count of ", count_),
                      std::to_string(index));
      }
      set(&all[index * perElement], values.at(i));
    }

    return all;
  }

  float at(const std::uint8_t* element, std::size_t i) const {
    return static_cast<float>(component_.value(element + i * component_.bytes, normalized_));
  }

 private:
  const GltfDocument& document_;
  JsonValue accessor_;
  ComponentType component_;
  std::uint64_t bytes_, count_;  // bytes of an element
  bool normalized_;
  StridedElements dense_;
};

template <typename Element>
std::vector<Element> readFloats(const GltfDocument& document, const JsonValue& reference,
                                std::size_t components) {
  const AccessorReader reader(document, accessorOf(document, reference), components,
                              typeOf(components));
  return reader.read<Element>(
      components * sizeof(float) / sizeof(Element), [&](Element* to, const std::uint8_t* from) {
        for (const auto k : indices(components)) {
          const float value = reader.at(from, k);
          std::memcpy(reinterpret_cast<char*>(to) + k * sizeof value, &value, sizeof value);
        }
      });
}

}  // namespace

JsonValue accessorOf(const GltfDocument& document, const JsonValue& reference) {
  const JsonValue accessors = document.list("accessors");
  const std::optional<std::size_t> index = reference.indexInto(accessors);
  if (!index) reference.fail("an accessor");
  return accessors[*index];
}

std::vector<Vec3f> readVectors(const GltfDocument& document, const JsonValue& reference) {
  return readFloats<Vec3f>(document, reference, 3);
}

std::vector<Vec2f> readUvs(const GltfDocument& document, const JsonValue& reference) {
  return readFloats<Vec2f>(document, reference, 2);
}

std::vector<float> readTuples(const GltfDocument& document, const JsonValue& reference,
                              std::size_t components) {
  return readFloats<float>(document, reference, components);
}

GltfColors readColors(const GltfDocument& document, const JsonValue& reference) {
  const JsonValue accessor = accessorOf(document, reference);
  const bool alpha = accessor["type"].textOr("") == "VEC4";
  const AccessorReader reader(document, accessor, alpha ? 4 : 3, "VEC3 or VEC4");

  GltfColors result;
  result.colors = reader.read<Rgb>(1, [&](Rgb* to, const std::uint8_t* from) {
    *to = {reader.at(from, 0), reader.at(from, 1), reader.at(from, 2)};
    if (alpha) result.translucent = result.translucent || reader.at(from, 3) < 1;
  });
  return result;
}

std::vector<std::uint32_t> readIndices(const GltfDocument& document, const JsonValue& reference) {
  const JsonValue accessor = accessorOf(document, reference);
  const AccessorReader reader(document, accessor, 1, "SCALAR");
  const ComponentType type = componentTypeOf(accessor["componentType"], true);
  return reader.read<std::uint32_t>(
      1, [&](std::uint32_t* to, const std::uint8_t* from) { *to = type.index(from); });
}

}  // namespace whit
