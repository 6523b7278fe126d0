#include "io/scene_transform.h"

#include <cmath>

namespace whit {
namespace {

Affine readScale(const JsonValue& value) {
  const Vec3d scale = value.isNumber() ? Vec3d(value.number()) : value.vector();
  if (scale.x == 0 || scale.y == 0 || scale.z == 0) value.fail("a scale other than 0");
  return Affine::scaling(scale);
}

Affine readRotation(const JsonValue& value) {
  const auto e = value.elements(4, "a rotation [x, y, z, degrees] or a list of such");
  const Vec3d axis{e[0].number(), e[1].number(), e[2].number()};
  if (axis == Vec3d()) value.fail("an axis other than 0");
  return Affine::rotation(axis, e[3].number());
}

Affine readRotations(const JsonValue& value) {
  const auto elements = value.elements();
  if (elements.empty() || !elements[0].isArray()) return readRotation(value);
  Affine result;
  for (const JsonValue& element : elements) result = readRotation(element) * result;
  return result;
}

Affine readMatrix(const JsonValue& value) {
  const auto e = value.elements(12, "12 numbers: a matrix of 3 rows of 4");
  const auto column = [&](std::size_t i) {
    return Vec3d{e[i].number(), e[i + 4].number(), e[i + 8].number()};
  };
  return {column(0), column(1), column(2), column(3)};
}

Affine readOne(const JsonValue& value) {
  JsonObject object(value);
  Affine result;
  if (const auto matrix = object.find("matrix")) {
    result = readMatrix(*matrix);
  } else {
    if (const auto scale = object.find("scale")) result = readScale(*scale);
    if (const auto rotate = object.find("rotate")) result = readRotations(*rotate) * result;
    if (const auto translate = object.find("translate")) {
      result = Affine::translation(translate->vector()) * result;
    }
  }
  object.finish();
  return result;
}

}  // namespace

Affine readTransform(const JsonValue& value) {
  Affine result;
  if (value.isArray()) {
    for (const JsonValue& element : value.elements()) result = readOne(element) * result;
  } else {
    result = readOne(value);
  }
  const double volume = result.determinant();
  if (!std::isfinite(volume) || volume == 0) value.fail("a transform that can be undone");
  return result;
}

std::vector<Affine> readPlacements(JsonObject& item) {
  const auto transform = item.find("transform");
  const Affine once = transform ? readTransform(*transform) : Affine();
  const auto value = item.find("repeat");
  if (!value) return {once};
  JsonObject repeat(*value);
  const JsonValue countValue = repeat.need("count");
  const auto counts = countValue.elements(3, "three numbers of copies [nx, ny, nz]");
  const Vec3d step = repeat.need("step").vector();
  repeat.finish();
  int n[3];
  double total = 1;
  for (std::size_t i = 0; i < 3; ++i) total *= n[i] = counts[i].integer(1, kRepeatLimit);
  if (total > kRepeatLimit) {
    countValue.fail("at most " + std::to_string(kRepeatLimit) + " copies");
  }
  std::vector<Affine> result;
  result.reserve(static_cast<std::size_t>(total));
  for (int z = 0; z < n[2]; ++z) {
    for (int y = 0; y < n[1]; ++y) {
      for (int x = 0; x < n[0]; ++x) {
        result.push_back(Affine::translation(step * Vec3d(x, y, z)) * once);
      }
    }
  }
  return result;
}

}  // namespace whit
