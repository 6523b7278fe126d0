// Runs code that its input may break in a child process that can compute and answer, and nothing
// else.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace whit {

// Sends the bytes of an answer to the parent.
using ConfinedWriter = std::function<void(const void* bytes, std::size_t count)>;

struct ConfinedAnswer {
  std::string bytes;    // everything that the child wrote
  std::string failure;  // says why the child did not finish; empty: it did
};

// `work` runs in a copy of this process, so that it sees what it refers to and changes nothing of
// it. The child may take `mostBytes` of memory beyond what this process has, and answer with as
// many; it may run for `seconds`. Where the kernel offers seccomp, every system call but those that
// take memory and write the answer ends the child. Throws Error(limit) where no child can be
// started.
ConfinedAnswer runConfined(const std::function<void(const ConfinedWriter&)>& work,
                           std::uint64_t mostBytes, int seconds);

}  // namespace whit
