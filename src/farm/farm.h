// The processes that share the tracing of one image: the ranks of an MPI job where whit is built
// with WHIT_MPI=ON and started by mpirun or srun, else this process alone. All ranks run the same
// command with the same options; rank 0, the leader, hands out blocks of the image to whoever is
// free, itself included, and collects them. Only the leader writes files and talks to people.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "render/renderer.h"

namespace whit {

// How the last frame was shared; known to the leader.
struct FarmFrame {
  int ranks = 1;
  int blockSide = 0;                             // pixels; 0: one process, no blocks
  std::vector<float> blockMs;                    // tracing each block, wherever it was
  std::uint64_t messageBytes = 0, messages = 0;  // blocks that came from other ranks
  double placeMs = 0;  // the leader's time to receive these and put them in their places
};

class Farm {
 public:
  // Runs a command. A failure of any rank ends all of them with its exit status, and the leader
  // says what it was; alone, exceptions pass through.
  static int run(const std::function<int(Farm&)>& command);

  ~Farm();
  Farm(const Farm&) = delete;
  Farm& operator=(const Farm&) = delete;

  int rank() const;
  int ranks() const;
  bool leads() const { return rank() == 0; }

  // Traces the film's window by calls of `trace`, each for a film whose window is a block of whole
  // tiles; every rank has to call it for every frame. The leader's film is then complete, with the
  // same bits as from one process; what the others' hold is not defined.
  using Trace = std::function<FrameStats(Film&)>;
  FrameStats render(Film& film, int tile, int workers, const Trace& trace);
  // The leader's way to leave out a frame that the others call render() for.
  void leaveOut();

  const FarmFrame& lastFrame() const { return lastFrame_; }

 private:
  Farm();

  struct Parts;
  std::unique_ptr<Parts> parts_;
  FarmFrame lastFrame_;
};

}  // namespace whit
