#include "io/gltf/accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

#include "core/error.h"

namespace whit {
namespace {

// Of an accessor without data, whose elements are zero but for the sparse ones.
constexpr std::uint64_t kZeroElementLimit = 1u << 24;

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

float component(const std::uint8_t* from, int type, bool normalized) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return floatAt<std::int8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return floatAt<std::uint8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return floatAt<std::int16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return floatAt<std::uint16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return floatAt<std::uint32_t>(from, normalized);
    default:
      return floatAt<float>(from, normalized);
  }
}

std::uint32_t indexAt(const std::uint8_t* from, int type) {
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return *from;
  if (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return loadAs<std::uint16_t>(from);
  return loadAs<std::uint32_t>(from);
}

bool isIndexType(int type) {
  return type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
         type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

std::uint64_t bytesPerComponent(int type) {
  switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return 4;
    default:
      return 0;
  }
}

// Equally spaced elements that are known to lie within their buffer view.
struct Run {
  const std::uint8_t* first = nullptr;
  std::uint64_t stride = 0;
  const std::uint8_t* at(std::uint64_t i) const { return first + i * stride; }
};

class Reader {
 public:
  Reader(const GltfDocument& document, std::size_t index, int type, const char* typeName)
      : document_(document),
        accessor_(document.model().accessors[index]),
        where_(document.where("accessors", index)) {
    components_ = static_cast<std::uint64_t>(
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
    size_ = bytesPerComponent(accessor_.componentType);
    if (accessor_.type != type)
      throwBadScene(where_ + "/type", std::string("expected ") + typeName);
    if (size_ == 0) {
      throwBadScene(where_ + "/componentType", "expected 5120 to 5123, 5125 or 5126");
    }
    if (accessor_.bufferView >= 0) {
      const auto view = static_cast<std::size_t>(accessor_.bufferView);
      dense_ = within(view, accessor_.byteOffset, document.model().bufferViews[view].byteStride,
                      size_ * components_, count(), where_);
    } else if (count() > kZeroElementLimit) {
      throwBadScene(where_, "expected a buffer view for " + std::to_string(count()) + " elements");
    }
  }

  const std::string& where() const { return where_; }
  int componentType() const { return accessor_.componentType; }
  std::uint64_t count() const { return accessor_.count; }

  // Calls set(element, pointer to its components) for all that are not zero: for those that a
  // sparse accessor replaces, twice.
  template <typename Set>
  void read(Set&& set) const {
    for (std::uint64_t i = 0; dense_.first && i < count(); ++i) set(i, dense_.at(i));
    if (accessor_.sparse.isSparse) readSparse(set);
  }

  float componentAt(const std::uint8_t* element, std::uint64_t i) const {
    return component(element + i * size_, accessor_.componentType, accessor_.normalized);
  }

 private:
  // `stride` 0: tightly packed.
  Run within(std::size_t view, std::uint64_t offset, std::uint64_t stride,
             std::uint64_t elementBytes, std::uint64_t count, const std::string& where) const {
    const Bytes bytes = document_.view(view);
    if (stride == 0) stride = elementBytes;
    if (stride < elementBytes) {
      throwBadScene(document_.where("bufferViews", view, "/byteStride"),
                    "expected at least the " + std::to_string(elementBytes) +
                        " bytes of an element of " + where);
    }
    const bool first = offset <= bytes.size() && elementBytes <= bytes.size() - offset;
    const std::uint64_t fit = first ? (bytes.size() - offset - elementBytes) / stride + 1 : 0;
    if (count > fit) {
      throwBadScene(where, "expected at most " + std::to_string(fit) +
                               " elements, as many as fit into buffer view " +
                               std::to_string(view) + ", found " + std::to_string(count));
    }
    return {count > 0 ? bytes.data() + offset : nullptr, stride};
  }

  template <typename Set>
  void readSparse(Set&& set) const {
    const auto& sparse = accessor_.sparse;
    const std::string where = where_ + "/sparse";
    if (!isIndexType(sparse.indices.componentType)) {
      throwBadScene(where + "/indices/componentType", "expected 5121, 5123 or 5125");
    }
    const auto count = static_cast<std::uint64_t>(sparse.count);
    const Run indices =
        within(static_cast<std::size_t>(sparse.indices.bufferView),
               static_cast<std::uint64_t>(sparse.indices.byteOffset), 0,
               bytesPerComponent(sparse.indices.componentType), count, where + "/indices");
    const Run values = within(static_cast<std::size_t>(sparse.values.bufferView),
                              static_cast<std::uint64_t>(sparse.values.byteOffset), 0,
                              size_ * components_, count, where + "/values");
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint32_t index = indexAt(indices.at(i), sparse.indices.componentType);
      if (index >= accessor_.count) {
        throwBadScene(where + "/indices", "expected indices below the accessor's count of " +
                                              std::to_string(accessor_.count) + ", found " +
                                              std::to_string(index));
      }
      set(index, values.at(i));
    }
  }

  const GltfDocument& document_;
  const tinygltf::Accessor& accessor_;
  std::string where_;
  std::uint64_t components_ = 0, size_ = 0;
  Run dense_;
};

// A vector of `Element`s, zero where the file says nothing.
template <typename Element>
std::vector<Element> makeElements(const GltfDocument& document, const Reader& reader) {
  document.budget().charge(reader.count(), sizeof(Element), reader.where());
  return std::vector<Element>(reader.count());
}

}  // namespace

std::vector<Vec3f> readVectors(const GltfDocument& document, std::size_t accessor) {
  const Reader reader(document, accessor, TINYGLTF_TYPE_VEC3, "VEC3");
  std::vector<Vec3f> elements = makeElements<Vec3f>(document, reader);
  reader.read([&](std::uint64_t i, const std::uint8_t* from) {
    elements[i] = {reader.componentAt(from, 0), reader.componentAt(from, 1),
                   reader.componentAt(from, 2)};
  });
  return elements;
}

std::vector<std::array<double, 4>> readQuaternions(const GltfDocument& document,
                                                   std::size_t accessor) {
  const Reader reader(document, accessor, TINYGLTF_TYPE_VEC4, "VEC4");
  auto elements = makeElements<std::array<double, 4>>(document, reader);
  reader.read([&](std::uint64_t i, const std::uint8_t* from) {
    for (std::size_t k = 0; k < 4; ++k) elements[i][k] = reader.componentAt(from, k);
  });
  return elements;
}

std::vector<Vec2f> readUvs(const GltfDocument& document, std::size_t accessor) {
  const Reader reader(document, accessor, TINYGLTF_TYPE_VEC2, "VEC2");
  std::vector<Vec2f> elements = makeElements<Vec2f>(document, reader);
  reader.read([&](std::uint64_t i, const std::uint8_t* from) {
    elements[i] = {reader.componentAt(from, 0), reader.componentAt(from, 1)};
  });
  return elements;
}

GltfColors readColors(const GltfDocument& document, std::size_t accessor) {
  const bool alpha = document.model().accessors[accessor].type == TINYGLTF_TYPE_VEC4;
  const Reader reader(document, accessor, alpha ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3,
                      "VEC3 or VEC4");
  GltfColors result{makeElements<Rgb>(document, reader), false};
  reader.read([&](std::uint64_t i, const std::uint8_t* from) {
    result.colors[i] = {reader.componentAt(from, 0), reader.componentAt(from, 1),
                        reader.componentAt(from, 2)};
    if (alpha) result.translucent = result.translucent || reader.componentAt(from, 3) < 1;
  });
  return result;
}

std::vector<float> readTuples(const GltfDocument& document, std::size_t accessor, int type) {
  const auto each =
      static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
  const Reader reader(document, accessor, type,
                      type == TINYGLTF_TYPE_SCALAR ? "SCALAR"
                      : type == TINYGLTF_TYPE_MAT4 ? "MAT4"
                      : type == TINYGLTF_TYPE_VEC3 ? "VEC3"
                                                   : "VEC4");
  document.budget().charge(reader.count(), each * sizeof(float), reader.where());
  std::vector<float> components(reader.count() * each);
  reader.read([&](std::uint64_t i, const std::uint8_t* from) {
    for (std::size_t k = 0; k < each; ++k) components[i * each + k] = reader.componentAt(from, k);
  });
  return components;
}

std::vector<std::uint32_t> readIndices(const GltfDocument& document, std::size_t accessor) {
  const Reader reader(document, accessor, TINYGLTF_TYPE_SCALAR, "SCALAR");
  if (!isIndexType(reader.componentType())) {
    throwBadScene(reader.where() + "/componentType", "expected 5121, 5123 or 5125");
  }
  std::vector<std::uint32_t> elements = makeElements<std::uint32_t>(document, reader);
  reader.read([&](std::uint64_t i, const std::uint8_t* from) {
    elements[i] = indexAt(from, reader.componentType());
  });
  return elements;
}

}  // namespace whit
