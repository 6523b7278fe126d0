// The elements of a glTF file's accessors, whatever the accessors are for and however broken.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "io/gltf/faults.h"

namespace whit {

inline constexpr std::size_t kGltfMostComponents = 16;

// 0 for what is none.
std::size_t gltfComponents(std::string_view type);
std::size_t gltfBytesOf(std::uint64_t componentType);
double gltfLargest(std::uint64_t componentType);  // of integers

struct GltfAccessorShape {
  std::string_view type;
  std::uint64_t componentType = 0, count = 0;
  bool normalized = false;
  bool isFloat() const { return componentType == 5126; }
};

// One accessor's, with what a sparse one replaces.
class GltfRun {
 public:
  GltfRun(const GltfText& text, std::size_t accessor);
  // Which elements a sparse accessor replaces.
  static GltfRun indicesOf(const GltfText& text, const LooseJson& sparse);

  // False: nothing can be said of what it holds.
  bool isReadable() const { return readable_; }
  std::uint64_t count() const { return shape_.count; }
  std::size_t components() const { return components_; }
  const GltfAccessorShape& shape() const { return shape_; }
  // As it is stored.
  double raw(std::uint64_t element, std::size_t component) const;
  // Normalized integers become -1 to 1.
  double value(std::uint64_t element, std::size_t component) const;

 private:
  GltfRun() = default;
  struct Place {
    const char* first = nullptr;
    std::uint64_t stride = 0;
  };
  Place placeOf(const GltfText& text, const LooseJson& source, std::uint64_t stride,
                std::uint64_t bytes, std::uint64_t count) const;
  const char* replacement(std::uint64_t element) const;
  void readSparse(const GltfText& text, const LooseJson& sparse);

  GltfAccessorShape shape_;
  std::size_t components_ = 0, size_ = 0;
  bool readable_ = false;
  Place dense_;
  // Elements that are replaced, in increasing order, and by what.
  Place indices_, values_;
  std::uint64_t indexType_ = 0, replaced_ = 0;
};

struct GltfBounds {
  bool known = false, finite = true;
  std::array<double, kGltfMostComponents> low{}, high{};
};

// Of all accessors, up to a number of elements that no real file reaches.
class GltfElements {
 public:
  explicit GltfElements(const GltfText& text);

  std::size_t size() const { return shapes_.size(); }
  const GltfAccessorShape& shape(std::size_t accessor) const { return shapes_[accessor]; }
  const GltfBounds& bounds(std::size_t accessor) const { return bounds_[accessor]; }

 private:
  std::vector<GltfAccessorShape> shapes_;
  std::vector<GltfBounds> bounds_;
};

}  // namespace whit
