#include "io/gltf_schema.h"

#include <algorithm>
#include <string_view>

#include "core/error.h"
#include "io/gltf_rules.h"

namespace whit {
namespace {

const Json* find(const Json& object, std::string_view name) {
  if (!object.is_object()) return nullptr;
  const auto member = object.find(std::string(name));
  return member == object.end() ? nullptr : &*member;
}

class Checker {
 public:
  Checker(const Json& root, const std::string& file) : root_(root), file_(file) {}

  void check(const GltfRule& rule, const std::string& path) {
    rule_ = &rule;
    target_ = rule.list ? sizeOf(rule.list) : 0;
    walk(root_, path, "");
  }

 private:
  [[noreturn]] void fail(const std::string& pointer, const std::string& what) const {
    throwBadScene(file_ + "#" + pointer, "expected " + what);
  }

  // Of the list at the end of `path`, 0 where it is not there.
  std::uint64_t sizeOf(std::string_view path) const {
    const Json* value = &root_;
    while (value && !path.empty()) {
      const std::size_t end = std::min(path.find('/'), path.size());
      value = find(*value, path.substr(0, end));
      path.remove_prefix(std::min(end + 1, path.size()));
    }
    return value && value->is_array() ? value->size() : 0;
  }

  void walk(const Json& value, std::string_view path, const std::string& pointer) {
    if (path.empty()) return look(value, pointer);
    const std::size_t end = std::min(path.find('/'), path.size());
    std::string_view name = path.substr(0, end);
    path.remove_prefix(std::min(end + 1, path.size()));
    if (name == "*") return walkAll(value, path, pointer);
    const bool required = name.starts_with('+');
    if (required) name.remove_prefix(1);
    if (const Json* member = find(value, name)) {
      walk(*member, path, pointer + "/" + std::string(name));
    } else if (required && value.is_object()) {
      fail(pointer, "a member \"" + std::string(name) + "\"");
    }
  }

  void walkAll(const Json& value, std::string_view path, const std::string& pointer) {
    if (value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) {
        walk(value[i], path, pointer + "/" + std::to_string(i));
      }
    } else if (value.is_object()) {
      for (const auto& [key, member] : value.items()) {
        walk(member, path, pointer + "/" + escapePointer(key));
      }
    }
  }

  void look(const Json& value, const std::string& pointer) const {
    switch (rule_->kind) {
      case GltfKind::object:
        if (!value.is_object()) fail(pointer, "an object");
        break;
      case GltfKind::list:
        checkList(value, pointer);
        break;
      case GltfKind::number:
        if (!value.is_number()) fail(pointer, "a number");
        break;
      case GltfKind::text:
        if (!value.is_string()) fail(pointer, "a string");
        break;
      case GltfKind::flag:
        if (!value.is_boolean()) fail(pointer, "true or false");
        break;
      case GltfKind::whole:
        checkWhole(value, pointer, rule_->limit);
        break;
      case GltfKind::index:
        checkIndex(value, pointer);
        break;
      case GltfKind::indices:
        checkList(value, pointer);
        for (std::size_t i = 0; i < value.size(); ++i) {
          checkIndex(value[i], pointer + "/" + std::to_string(i));
        }
        break;
      case GltfKind::vector:
        checkVector(value, pointer);
        break;
    }
  }

  void checkList(const Json& value, const std::string& pointer) const {
    if (!value.is_array()) fail(pointer, "a list");
    if (value.size() > kGltfCountLimit) {
      throwLimit(file_ + "#" + pointer + ": a list of " + std::to_string(value.size()) +
                 ", more than " + std::to_string(kGltfCountLimit));
    }
  }
  void checkWhole(const Json& value, const std::string& pointer, std::uint64_t limit) const {
    if (value.is_number_unsigned() && value.get<std::uint64_t>() <= limit) return;
    fail(pointer, "a whole number from 0 to " + std::to_string(limit));
  }
  void checkIndex(const Json& value, const std::string& pointer) const {
    if (target_ == 0) fail(pointer, std::string("no index: there are no ") + rule_->list);
    if (value.is_number_unsigned() && value.get<std::uint64_t>() < target_) return;
    fail(pointer, std::string("an index into ") + rule_->list + ", from 0 to " +
                      std::to_string(target_ - 1));
  }
  void checkVector(const Json& value, const std::string& pointer) const {
    bool right = value.is_array() && value.size() == rule_->limit;
    for (std::size_t i = 0; right && i < value.size(); ++i) right = value[i].is_number();
    if (!right) fail(pointer, std::to_string(rule_->limit) + " numbers");
  }

  const Json& root_;
  const std::string& file_;
  const GltfRule* rule_ = nullptr;
  std::uint64_t target_ = 0;
};

}  // namespace

void checkGltf(const Json& json, const std::string& file) {
  Checker checker(json, file);
  for (const GltfRule& rule : gltfRules()) checker.check(rule, rule.path);
  for (const char* slot : gltfTextureSlots()) {
    for (const GltfRule& rule : gltfTextureRules()) {
      checker.check(rule, std::string("materials/*/") + slot + rule.path);
    }
  }
}

std::string gltfPlace(const std::string& file, const std::string& list, std::size_t index) {
  return file + "#/" + list + "/" + std::to_string(index);
}

}  // namespace whit
