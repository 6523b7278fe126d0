#include "io/obj_parser.h"

#include <tiny_obj_loader.h>

#include <istream>
#include <limits>
#include <map>
#include <streambuf>
#include <string>

namespace whit {
namespace {

// Reads the text where it lies, and knows how far the parser has come.
class TextBuffer : public std::streambuf {
 public:
  explicit TextBuffer(std::string& text) {
    setg(text.data(), text.data(), text.data() + text.size());
  }
  std::uint64_t offset() const { return static_cast<std::uint64_t>(gptr() - eback()); }
};

struct Collector {
  explicit Collector(ObjText& text) : buffer(text.text()) {
    const ObjSummary& summary = text.summary();
    contents.positions.reserve(summary.positions);
    contents.normals.reserve(summary.normals);
    contents.uvs.reserve(summary.uvs);
    contents.corners.reserve(summary.corners);
    contents.faces.reserve(summary.faces);
    std::uint32_t number = 0;
    for (const ObjSummary::Name& name : summary.materials) materials.emplace(name.text, number++);
    material = number;
  }

  // The format counts from 1, and back from the last one read for negative numbers.
  static std::int32_t fromZero(int index, std::size_t count) {
    if (index > 0) return index - 1;
    if (index == 0) return kNoIndex;
    const std::int64_t fromEnd = static_cast<std::int64_t>(count) + index;
    return fromEnd >= 0 ? static_cast<std::int32_t>(fromEnd)
                        : std::numeric_limits<std::int32_t>::max();  // before the first
  }

  void face(const tinyobj::index_t* indices, int count) {
    contents.faces.push_back(
        {contents.corners.size(), buffer.offset(), static_cast<std::uint32_t>(count), material});
    for (int i = 0; i < count; ++i) {
      contents.corners.push_back({fromZero(indices[i].vertex_index, contents.positions.size()),
                                  fromZero(indices[i].texcoord_index, contents.uvs.size()),
                                  fromZero(indices[i].normal_index, contents.normals.size())});
    }
  }

  TextBuffer buffer;
  ObjContents contents;
  std::map<std::string, std::uint32_t, std::less<>> materials;
  std::uint32_t material = 0;
};

Collector& collector(void* user) { return *static_cast<Collector*>(user); }

tinyobj::callback_t callbacks() {
  tinyobj::callback_t c;
  c.vertex_cb = [](void* user, float x, float y, float z, float) {
    collector(user).contents.positions.push_back({x, y, z});
  };
  c.normal_cb = [](void* user, float x, float y, float z) {
    collector(user).contents.normals.push_back({x, y, z});
  };
  c.texcoord_cb = [](void* user, float u, float v, float) {
    collector(user).contents.uvs.push_back({u, v});
  };
  c.index_cb = [](void* user, tinyobj::index_t* indices, int count) {
    collector(user).face(indices, count);
  };
  c.usemtl_cb = [](void* user, const char* name, int) {
    Collector& to = collector(user);
    const auto known = to.materials.find(trimmed(name));
    to.material = known != to.materials.end() ? known->second
                                              : static_cast<std::uint32_t>(to.materials.size());
  };
  return c;
}

}  // namespace

ObjContents parseObj(ObjText& text) {
  Collector to(text);
  std::istream stream(&to.buffer);
  std::string warning, error;
  tinyobj::LoadObjWithCallback(stream, callbacks(), &to, nullptr, &warning, &error);
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  // tinyobjloader reads what is not finite as 0.
  const ObjSummary& summary = text.summary();
  const auto spoil = [](auto& values, const std::vector<std::uint64_t>& numbers, const auto& nan) {
    for (const std::uint64_t i : numbers) {
      if (i < values.size()) values[i] = nan;
    }
  };
  spoil(to.contents.positions, summary.nonFinitePositions, Vec3f(kNan));
  spoil(to.contents.normals, summary.nonFiniteNormals, Vec3f(kNan));
  spoil(to.contents.uvs, summary.nonFiniteUvs, Vec2f{kNan, kNan});
  return std::move(to.contents);
}

}  // namespace whit
