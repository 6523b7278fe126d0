// The messages between the ranks of a farm. Every wait sleeps between looks: MPI's own spin, and
// would take the processor from those who trace.
#pragma once

#include <cstdint>
#include <vector>

#include "render/renderer.h"

namespace whit {

enum class FarmMessage : int {
  block = 1,  // leader to worker: the index of a block to trace, or kNoMoreBlocks
  traced,     // worker to leader: a block's pixels and what they cost
  failed,     // worker to leader: the exit status and what happened
  left,       // worker to leader: the command is done
};

inline constexpr std::int32_t kNoMoreBlocks = -1;  // in this frame

struct Letter {
  int from = 0;
  FarmMessage kind = FarmMessage::block;
  std::vector<char> bytes;
};

// The next message for this rank from anyone; false when there is none yet.
bool lookForLetter(Letter& letter);
Letter waitForLetter();
void sendLetter(int to, FarmMessage kind, const void* bytes, std::size_t count);

void sendBlockIndex(int to, std::int32_t index);

// A traced block as the bytes of a letter, and back. All ranks run the same program on the same
// kind of machine, so numbers travel as they lie in memory.
struct TracedBlock {
  std::int32_t index = 0;
  float ms = 0;
  FrameStats stats;
};
std::vector<char> packBlock(const TracedBlock& block, const Film& film);
// Puts the pixels where `blocks[index]` says. Throws std::runtime_error for a letter of the wrong
// length: the ranks were started with different options.
TracedBlock unpackBlock(const std::vector<char>& bytes, const std::vector<Crop>& blocks,
                        Film& whole);

}  // namespace whit
