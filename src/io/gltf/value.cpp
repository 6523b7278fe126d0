#include "io/gltf/value.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace whit {
namespace {

std::optional<std::uint64_t> wholeNumber(const nlohmann::ordered_json& value) {
  if (value.is_number_unsigned()) return value.get<std::uint64_t>();
  if (!value.is_number()) return std::nullopt;
  const auto number = value.get<double>();
  const bool whole = number >= 0 && number <= static_cast<double>(kGltfLargestWhole) &&
                     number == std::floor(number);
  return whole ? std::optional(static_cast<std::uint64_t>(number)) : std::nullopt;
}

}  // namespace

GltfValue::GltfValue(const GltfValue& parent, const nlohmann::ordered_json* value,
                     std::string_view token)
    : file_(parent.file_), value_(value), pointer_(parent.pointer_) {
  pointer_.append("/").append(token);
}

void GltfValue::fail(const std::string& expected) const {
  throwBadScene(where(), "expected " + expected);
}

GltfValue GltfValue::operator[](std::string_view name) const {
  if (value_ && !value_->is_object()) fail("an object");
  if (!value_) return {*this, nullptr, name};
  const auto found = value_->find(std::string(name));
  return {*this, found == value_->end() ? nullptr : &*found, name};
}

GltfValue GltfValue::need(std::string_view name) const {
  GltfValue member = (*this)[name];
  if (!member.exists()) fail("a member \"" + std::string(name) + "\"");
  return member;
}

std::size_t GltfValue::size() const {
  if (!value_) return 0;
  if (!value_->is_array()) fail("a list");
  if (value_->size() > kGltfCountLimit) {
    throwLimit(where() + ": a list of " + std::to_string(value_->size()) + ", more than " +
               std::to_string(kGltfCountLimit));
  }
  return value_->size();
}

GltfValue GltfValue::operator[](std::size_t i) const {
  return {*this, i < size() ? &(*value_)[i] : nullptr, std::to_string(i)};
}

double GltfValue::number(double fallback) const {
  if (!value_) return fallback;
  if (!value_->is_number()) fail("a number");
  return value_->get<double>();
}

std::uint64_t GltfValue::whole(std::uint64_t fallback, std::uint64_t limit) const {
  if (!value_) return fallback;
  const std::optional<std::uint64_t> number = wholeNumber(*value_);
  if (!number || *number > limit) fail("a whole number from 0 to " + std::to_string(limit));
  return *number;
}

bool GltfValue::flag() const {
  if (!value_) return false;
  if (!value_->is_boolean()) fail("true or false");
  return value_->get<bool>();
}

std::string GltfValue::text(const char* fallback) const {
  if (!value_) return fallback;
  if (!value_->is_string()) fail("a string");
  return value_->get<std::string>();
}

std::vector<double> GltfValue::numbers() const {
  std::vector<double> all(size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = (*this)[i].number(0);
  return all;
}

std::vector<double> GltfValue::numbers(std::size_t count) const {
  if (!value_) return {};
  bool right = value_->is_array() && value_->size() == count;
  for (std::size_t i = 0; right && i < count; ++i) right = (*value_)[i].is_number();
  if (!right) fail(std::to_string(count) + " numbers");
  return numbers();
}

std::optional<std::size_t> GltfValue::index(const GltfValue& list) const {
  if (!value_) return std::nullopt;
  const std::size_t size = list.size();
  const std::size_t slash = list.pointer_.rfind('/');
  const std::string expected = "an index into " + list.pointer_.substr(slash + 1);
  if (size == 0) fail(expected + ", which has no elements");
  const std::optional<std::uint64_t> number = wholeNumber(*value_);
  if (!number || *number >= size) fail(expected + ", from 0 to " + std::to_string(size - 1));
  return static_cast<std::size_t>(*number);
}

}  // namespace whit
