// A JSON value of which nothing is known: asking what it does not have gives nothing.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "io/scene/json_text.h"

namespace whit {

class LooseJson {
 public:
  LooseJson() = default;
  explicit LooseJson(const Json& value) : value_(&value) {}

  LooseJson operator[](std::string_view name) const {
    if (!value_ || !value_->is_object()) return {};
    const auto found = value_->find(std::string(name));
    return found == value_->end() ? LooseJson() : LooseJson(*found);
  }
  LooseJson at(std::size_t i) const {
    return isList() && i < value_->size() ? LooseJson((*value_)[i]) : LooseJson();
  }
  bool exists() const { return value_ != nullptr; }
  bool isObject() const { return value_ && value_->is_object(); }
  bool isList() const { return value_ && value_->is_array(); }
  // Elements of a list.
  std::size_t size() const { return value_ && value_->is_array() ? value_->size() : 0; }

  std::optional<double> number() const {
    return value_ && value_->is_number() ? std::optional(value_->get<double>()) : std::nullopt;
  }
  // 1e0 is as whole as 1.
  std::optional<std::uint64_t> whole() const {
    constexpr double kMost = 9007199254740992.0;  // what JSON numbers hold exactly
    const std::optional<double> x = number();
    const bool right = x && *x >= 0 && *x <= kMost && *x == std::floor(*x);
    return right ? std::optional(static_cast<std::uint64_t>(*x)) : std::nullopt;
  }
  std::uint64_t wholeOr(std::uint64_t fallback) const { return whole().value_or(fallback); }
  // Below `size`.
  std::optional<std::size_t> index(std::size_t size) const {
    const std::optional<std::uint64_t> i = whole();
    return i && *i < size ? std::optional(static_cast<std::size_t>(*i)) : std::nullopt;
  }
  std::string_view text() const {
    return value_ && value_->is_string() ? std::string_view(value_->get_ref<const std::string&>())
                                         : std::string_view();
  }
  bool flag() const { return value_ && value_->is_boolean() && value_->get<bool>(); }
  // Not there: null.
  const Json* json() const { return value_; }

 private:
  const Json* value_ = nullptr;
};

}  // namespace whit
