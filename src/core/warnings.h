// Things that were repaired while loading: counted by kind, with the first place of each.
// `--strict` turns the first one into an error. Thread-safe, because textures are decoded in
// parallel.
#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "core/error.h"

namespace whit {

class Warnings {
 public:
  struct Entry {
    std::uint64_t count = 0;
    std::string first;  // where it was seen first
  };

  explicit Warnings(bool strict = false) : strict_(strict) {}

  // `kind` is a fixed phrase such as "degenerate triangle dropped".
  void add(const std::string& kind, const std::string& where, std::uint64_t count = 1) {
    if (count == 0) return;
    if (strict_) throwBadScene(where, kind + " (refused by --strict)");
    note(kind, where, count);
  }

  // Adds something that is as the file has it, but perhaps not as it is expected: never refused.
  void note(const std::string& kind, const std::string& where, std::uint64_t count = 1) {
    const std::lock_guard lock(mutex_);
    Entry& entry = entries_[kind];
    if (entry.count == 0) entry.first = where;
    entry.count += count;
  }

  void forget(const std::string& kind) {
    const std::lock_guard lock(mutex_);
    entries_.erase(kind);
  }

  std::map<std::string, Entry> entries() const {
    const std::lock_guard lock(mutex_);
    return entries_;
  }

 private:
  bool strict_;
  mutable std::mutex mutex_;
  std::map<std::string, Entry> entries_;
};

}  // namespace whit
