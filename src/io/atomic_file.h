// Files that appear under their name only when complete.
#pragma once

#include <string>

namespace whit {

// A temporary name beside `path`. commit() renames it to `path`; without commit the destructor
// removes it, so that an error or an interruption leaves nothing half-written.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);  // throws Error(io) when the folder is not writable
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporaryPath() const { return temporary_; }
  void commit();  // throws Error(io)

 private:
  std::string path_, temporary_;
  bool committed_ = false;
};

// The whole text at once.
void writeTextFile(const std::string& path, const std::string& text);

}  // namespace whit
