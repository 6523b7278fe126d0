// A value of a glTF file's JSON that knows its place. Readers check each value when they read it,
// so that an error names the file, the JSON pointer and what was expected there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace whit {

// A longer list is refused: it is far beyond any real file.
inline constexpr std::uint64_t kGltfCountLimit = 1u << 20;
// Whole numbers up to this are exact in JSON.
inline constexpr std::uint64_t kGltfLargestWhole = std::uint64_t{1} << 53;

// Members that a file does not have are values that do not exist; they have no members, no elements
// and the fallback's content. All functions throw badScene where an existing value is of another
// type. The JSON and the name of the file outlive the value.
class GltfValue {
 public:
  GltfValue(const std::string& file, const nlohmann::ordered_json& root)
      : file_(&file), value_(&root) {}

  bool exists() const { return value_ != nullptr; }
  std::string where() const { return *file_ + "#" + pointer_; }
  [[noreturn]] void fail(const std::string& expected) const;

  GltfValue operator[](std::string_view name) const;
  // Throws badScene where the member is missing.
  GltfValue need(std::string_view name) const;

  // Number of elements of a list. Throws limit beyond kGltfCountLimit.
  std::size_t size() const;
  GltfValue operator[](std::size_t i) const;

  double number(double fallback) const;
  // Accepts 1e0 and 1.0 as well as 1.
  std::uint64_t whole(std::uint64_t fallback, std::uint64_t limit = kGltfLargestWhole) const;
  bool flag() const;  // fallback: false
  std::string text(const char* fallback = "") const;
  // Empty where the list does not exist.
  std::vector<double> numbers() const;
  std::vector<double> numbers(std::size_t count) const;
  // Index of an element of `list`.
  std::optional<std::size_t> index(const GltfValue& list) const;

 private:
  GltfValue(const GltfValue& parent, const nlohmann::ordered_json* value, std::string_view token);

  const std::string* file_;
  const nlohmann::ordered_json* value_;
  std::string pointer_;
};

}  // namespace whit
