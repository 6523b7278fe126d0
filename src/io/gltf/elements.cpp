#include "io/gltf/elements.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace whit {
namespace {

constexpr std::uint64_t kMostExamined = 1u << 28;  // components in all
constexpr std::uint64_t kMostZeros = 1u << 24;     // elements of what has no buffer view

constexpr std::pair<std::string_view, std::size_t> kTypes[] = {
    {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};

template <typename T>
double loadFrom(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return static_cast<double>(value);
}

double loadComponent(const char* from, std::uint64_t componentType) {
  switch (componentType) {
    case 5120:
      return loadFrom<std::int8_t>(from);
    case 5121:
      return loadFrom<std::uint8_t>(from);
    case 5122:
      return loadFrom<std::int16_t>(from);
    case 5123:
      return loadFrom<std::uint16_t>(from);
    case 5125:
      return loadFrom<std::uint32_t>(from);
    default:
      return loadFrom<float>(from);
  }
}

GltfAccessorShape shapeOf(const LooseJson& accessor) {
  return {accessor["type"].text(), accessor["componentType"].wholeOr(0),
          accessor["count"].wholeOr(0), accessor["normalized"].flag()};
}

GltfBounds boundsOf(const GltfRun& run) {
  GltfBounds bounds;
  bounds.known = true;
  bounds.low.fill(std::numeric_limits<double>::infinity());
  bounds.high.fill(-std::numeric_limits<double>::infinity());
  for (std::uint64_t i = 0; i < run.count(); ++i) {
    for (std::size_t k = 0; k < run.components(); ++k) {
      const double x = run.raw(i, k);
      bounds.finite = bounds.finite && std::isfinite(x);
      bounds.low[k] = std::min(bounds.low[k], x);
      bounds.high[k] = std::max(bounds.high[k], x);
    }
  }
  return bounds;
}

}  // namespace

std::size_t gltfComponents(std::string_view type) {
  for (const auto& [name, components] : kTypes) {
    if (name == type) return components;
  }
  return 0;
}

std::size_t gltfBytesOf(std::uint64_t componentType) {
  return componentType == 5120 || componentType == 5121   ? 1
         : componentType == 5122 || componentType == 5123 ? 2
         : componentType == 5125 || componentType == 5126 ? 4
                                                          : 0;
}

double gltfLargest(std::uint64_t componentType) {
  return componentType == 5120   ? 127
         : componentType == 5121 ? 255
         : componentType == 5122 ? 32767
         : componentType == 5123 ? 65535
                                 : 4294967295.0;
}

GltfRun::GltfRun(const GltfText& text, std::size_t accessor) {
  const LooseJson source = text.list("accessors").at(accessor);
  shape_ = shapeOf(source);
  components_ = gltfComponents(shape_.type);
  size_ = gltfBytesOf(shape_.componentType);
  // Columns of matrices of small numbers are padded, which nobody here uses.
  const bool padded = shape_.type.starts_with("MAT") && size_ < 4;
  if (components_ == 0 || size_ == 0 || shape_.count == 0 || padded) return;
  if (source["bufferView"].exists()) {
    const std::optional<std::size_t> view =
        source["bufferView"].index(text.list("bufferViews").size());
    if (!view) return;
    const std::uint64_t stride = text.list("bufferViews").at(*view)["byteStride"].wholeOr(0);
    dense_ = placeOf(text, source, stride, size_ * components_, shape_.count);
    if (!dense_.first) return;
  } else if (shape_.count > kMostZeros || !source["sparse"].isObject()) {
    return;
  }
  readable_ = true;
  if (source["sparse"].isObject()) readSparse(text, source["sparse"]);
}

GltfRun::Place GltfRun::placeOf(const GltfText& text, const LooseJson& source, std::uint64_t stride,
                                std::uint64_t bytes, std::uint64_t count) const {
  const LooseJson views = text.list("bufferViews");
  const std::optional<std::size_t> index = source["bufferView"].index(views.size());
  if (!index || count == 0) return {};
  const LooseJson view = views.at(*index);
  const std::optional<std::size_t> buffer = view["buffer"].index(text.buffers.size());
  if (!buffer) return {};
  const std::string& data = text.buffers[*buffer];
  const std::uint64_t start = view["byteOffset"].wholeOr(0),
                      offset = source["byteOffset"].wholeOr(0);
  const std::uint64_t length = view["byteLength"].wholeOr(0);
  if (start > data.size() || length > data.size() - start) return {};
  if (offset > length || bytes > length - offset) return {};
  if (stride == 0) stride = bytes;
  if ((count - 1) > (length - offset - bytes) / stride) return {};
  return {data.data() + start + offset, stride};
}

GltfRun GltfRun::indicesOf(const GltfText& text, const LooseJson& sparse) {
  GltfRun run;
  run.shape_ = shapeOf(sparse["indices"]);
  run.shape_.count = sparse["count"].wholeOr(0);
  run.components_ = 1;
  run.size_ = gltfBytesOf(run.shape_.componentType);
  if (run.size_ == 0) return run;
  run.dense_ = run.placeOf(text, sparse["indices"], 0, run.size_, run.shape_.count);
  run.readable_ = run.dense_.first != nullptr;
  return run;
}

// Unreadable where the order is another: nothing can be said then.
void GltfRun::readSparse(const GltfText& text, const LooseJson& sparse) {
  const GltfRun indices = indicesOf(text, sparse);
  readable_ = false;
  values_ = placeOf(text, sparse["values"], 0, size_ * components_, indices.shape_.count);
  if (!indices.isReadable() || !values_.first) return;
  for (std::uint64_t i = 1; i < indices.count(); ++i) {
    if (indices.raw(i, 0) <= indices.raw(i - 1, 0)) return;
  }
  indices_ = indices.dense_;
  indexType_ = indices.shape_.componentType;
  replaced_ = indices.count();
  readable_ = true;
}

const char* GltfRun::replacement(std::uint64_t element) const {
  const auto wanted = static_cast<double>(element);
  std::uint64_t low = 0, high = replaced_;
  while (low < high) {
    const std::uint64_t middle = low + (high - low) / 2;
    const double index = loadComponent(indices_.first + middle * indices_.stride, indexType_);
    if (index == wanted) return values_.first + middle * values_.stride;
    (index < wanted ? low : high) = index < wanted ? middle + 1 : middle;
  }
  return nullptr;
}

double GltfRun::raw(std::uint64_t element, std::size_t component) const {
  const char* from = dense_.first ? dense_.first + element * dense_.stride : nullptr;
  if (replaced_ > 0) {
    if (const char* other = replacement(element)) from = other;
  }
  return from ? loadComponent(from + component * size_, shape_.componentType) : 0;
}

double GltfRun::value(std::uint64_t element, std::size_t component) const {
  const double x = raw(element, component);
  if (shape_.isFloat() || !shape_.normalized) return x;
  return std::max(x / gltfLargest(shape_.componentType), -1.0);
}

GltfElements::GltfElements(const GltfText& text)
    : shapes_(text.list("accessors").size()), bounds_(shapes_.size()) {
  std::uint64_t left = kMostExamined;
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    const LooseJson source = text.list("accessors").at(i);
    shapes_[i] = shapeOf(source);
    const std::uint64_t replaced = source["sparse"]["count"].wholeOr(0);
    const std::uint64_t each = gltfComponents(shapes_[i].type);
    if (each == 0 || replaced > left || shapes_[i].count > (left - replaced) / each) continue;
    left -= replaced + shapes_[i].count * each;
    const GltfRun run(text, i);
    if (!run.isReadable()) continue;
    bounds_[i] = boundsOf(run);
  }
}

}  // namespace whit
