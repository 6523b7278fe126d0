// Runs code that its input may break in a child process that can compute and answer, and nothing
// else.
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

// `work` runs in a copy of this process, so that it sees what it refers to and changes nothing of
// it. It may compute, allocate and answer, and must take no lock, because a thread that is not in
// the copy may have held it. The child may take `mostBytes` of memory beyond what this process has,
// and answer with as many, but no more than a quarter of the address space that is left here
// (ulimit -v); it lives for `seconds` at most. Where the kernel offers seccomp, every system call
// but those that take memory ends the child. Throws Error(limit), which begins with `where`, if no
// child can be started.
ConfinedAnswer runConfined(const std::string& where,
                           const std::function<void(const ConfinedWriter&)>& work,
                           std::uint64_t mostBytes, int seconds);

}  // namespace whit
