// Runs code that damaged input may crash in a child process, which can only compute and answer.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace whit {

// Adds bytes to the answer.
using ConfinedWriter = std::function<void(const void* bytes, std::size_t count)>;

struct ConfinedAnswer {
  std::string bytes;    // everything that the child wrote
  std::string failure;  // says why the child did not finish; empty: it did
};

// Runs `work` in a copy of this process, where it sees everything that it refers to but changes
// only the copy. It may compute, allocate and answer. It must take no lock, because a thread that
// is not in the copy may have held it. The child may take `mostBytes` of memory beyond what this
// process has, and answer with as many, but no more than a quarter of the address space that is
// left here (ulimit -v); it lives for `seconds` at most. Where the kernel offers seccomp, every
// system call but those that take memory ends the child. Throws Error(limit), which begins with
// `where`, if no child can be started.
ConfinedAnswer runConfined(const std::string& where,
                           const std::function<void(const ConfinedWriter&)>& work,
                           std::uint64_t mostBytes, int seconds);

}  // namespace whit
