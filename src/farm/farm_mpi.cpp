#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "core/error.h"
#include "core/printable.h"
#include "core/stopwatch.h"
#include "farm/blocks.h"
#include "farm/farm.h"
#include "farm/messages_mpi.h"
#include "render/frame_setup.h"

namespace whit {

namespace {

// Blocks that a worker has at a time: it begins the next while the leader places the last.
constexpr int kBlocksAhead = 2;

// Set by what starts the ranks: Open MPI, PMIx (Slurm), and the PMI of MPICH and its kin. Without
// one MPI would start a daemon for a single process.
bool startedAsRank() {
  return std::getenv("OMPI_COMM_WORLD_RANK") || std::getenv("PMIX_RANK") || std::getenv("PMI_RANK");
}

[[noreturn]] void throwFailed(const Letter& letter) {
  std::int32_t status = 0;
  std::memcpy(&status, letter.bytes.data(), sizeof status);
  throw Error(static_cast<ExitStatus>(status),
              "rank " + std::to_string(letter.from) + ": " +
                  std::string(letter.bytes.begin() + sizeof status, letter.bytes.end()));
}

[[noreturn]] void waitForTheEnd() {
  for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
}

TracedBlock traceBlock(std::int32_t index, const Farm::Trace& trace, Film& film) {
  const Stopwatch stopwatch;
  TracedBlock traced;
  traced.index = index;
  traced.stats = trace(film);
  traced.ms = static_cast<float>(stopwatch.ms());
  return traced;
}

// The leader's own share, on a thread beside the one that talks to the others.
class OwnShare {
 public:
  OwnShare(const std::vector<Crop>& blocks, Film& whole, std::atomic<std::int32_t>& next,
           const Farm::Trace& trace)
      : thread_([this, &blocks, &whole, &next, &trace] {
          try {
            const auto count = static_cast<std::int32_t>(blocks.size());
            for (std::int32_t i = next++; i < count && !stop_; i = next++) {
              Film film = blockFilm(whole, blocks[static_cast<std::size_t>(i)]);
              traced_.push_back(traceBlock(i, trace, film));
              place(film, whole);  // its own pixels: nobody else writes them
            }
          } catch (...) {
            failure_ = std::current_exception();
          }
        }) {}
  ~OwnShare() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  const std::vector<TracedBlock>& finish() {
    thread_.join();
    if (failure_) std::rethrow_exception(failure_);
    return traced_;
  }

 private:
  std::atomic<bool> stop_{false};
  std::vector<TracedBlock> traced_;
  std::exception_ptr failure_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace

struct Farm::Parts {
  int rank = 0, ranks = 1;
  int left = 0;  // ranks that have nothing more to do

  // Handles the messages to the leader that are not blocks.
  void heed(const Letter& letter) {
    if (letter.kind == FarmMessage::failed) throwFailed(letter);
    left += letter.kind == FarmMessage::left;
  }
  FrameStats lead(const std::vector<Crop>& blocks, Film& film, const Trace& trace,
                  FarmFrame& frame);
  void work(const std::vector<Crop>& blocks, const Film& film, const Trace& trace);
};

Farm::Farm() : parts_(std::make_unique<Parts>()) {
  if (!startedAsRank()) return;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &parts_->rank);
  MPI_Comm_size(MPI_COMM_WORLD, &parts_->ranks);
}

Farm::~Farm() {
  if (startedAsRank()) MPI_Finalize();
}

int Farm::rank() const { return parts_->rank; }
int Farm::ranks() const { return parts_->ranks; }

int Farm::run(const std::function<int(Farm&)>& command) {
  Farm farm;
  if (farm.ranks() == 1) return command(farm);
  try {
    const int status = command(farm);
    if (!farm.leads()) sendLetter(0, FarmMessage::left, nullptr, 0);
    while (farm.leads() && farm.parts_->left + 1 < farm.ranks()) {
      farm.parts_->heed(waitForLetter());
    }
    return status;
  } catch (const std::exception& error) {
    const Failure failure = failureOf(error);
    const auto status = static_cast<std::int32_t>(failure.status);
    if (farm.leads()) {
      std::fprintf(stderr, "whit: %s\n", printable(failure.what).c_str());
      MPI_Abort(MPI_COMM_WORLD, status);
    }
    std::vector<char> bytes(sizeof status);
    std::memcpy(bytes.data(), &status, sizeof status);
    bytes.insert(bytes.end(), failure.what.begin(), failure.what.end());
    sendLetter(0, FarmMessage::failed, bytes.data(), bytes.size());
    waitForTheEnd();  // that the leader makes
  }
}

void Farm::leaveOut() {
  for (int rank = 1; rank < ranks(); ++rank) sendBlockIndex(rank, kNoMoreBlocks);
}

FrameStats Farm::render(Film& film, int tile, int workers, const Trace& trace) {
  lastFrame_ = {};
  if (ranks() == 1) return trace(film);
  const int side = blockSide(tile, workers);
  const std::vector<Crop> blocks = blocksOf(film.image.window, side);
  if (!leads()) {
    parts_->work(blocks, film, trace);
    return {};
  }
  lastFrame_.ranks = ranks();
  lastFrame_.blockSide = side;
  const Stopwatch stopwatch;
  FrameStats stats = parts_->lead(blocks, film, trace, lastFrame_);
  stats.frameMs = stopwatch.ms();
  stats.workers = workers * ranks();
  return stats;
}

FrameStats Farm::Parts::lead(const std::vector<Crop>& blocks, Film& film, const Trace& trace,
                             FarmFrame& frame) {
  FrameStats sum;
  frame.blockMs.resize(blocks.size());
  const auto count = [&](const TracedBlock& block) {
    frame.blockMs[static_cast<std::size_t>(block.index)] = block.ms;
    sum.add(block.stats);
  };
  std::atomic<std::int32_t> next{0};
  std::vector<int> inHand(static_cast<std::size_t>(ranks), 0);
  int working = ranks - 1;
  const auto handOut = [&](int to) {
    const std::int32_t index = next++;
    const bool any = index < static_cast<std::int32_t>(blocks.size());
    int& held = inHand[static_cast<std::size_t>(to)];
    held += any;
    if (!any && held > 0) return;
    sendBlockIndex(to, any ? index : kNoMoreBlocks);
    if (!any) --working;
  };
  sizeDisplay(film);
  for (int ahead = 0; ahead < kBlocksAhead; ++ahead) {
    for (int to = 1; to < ranks; ++to) {
      if (ahead == 0 || inHand[static_cast<std::size_t>(to)] == ahead) handOut(to);
    }
  }
  OwnShare own(blocks, film, next, trace);
  while (working > 0) {
    const Letter letter = waitForLetter();
    if (letter.kind != FarmMessage::traced) {
      heed(letter);
      continue;
    }
    const Stopwatch stopwatch;
    count(unpackBlock(letter.bytes, blocks, film));
    frame.placeMs += stopwatch.ms();
    frame.messageBytes += letter.bytes.size();
    ++frame.messages;
    --inHand[static_cast<std::size_t>(letter.from)];
    handOut(letter.from);
  }
  for (const TracedBlock& block : own.finish()) count(block);
  return sum;
}

void Farm::Parts::work(const std::vector<Crop>& blocks, const Film& film, const Trace& trace) {
  for (;;) {
    const Letter letter = waitForLetter();
    std::int32_t index = kNoMoreBlocks;
    std::memcpy(&index, letter.bytes.data(), std::min(sizeof index, letter.bytes.size()));
    if (index == kNoMoreBlocks) return;
    Film block = blockFilm(film, blocks.at(static_cast<std::size_t>(index)));
    const TracedBlock traced = traceBlock(index, trace, block);
    const std::vector<char> bytes = packBlock(traced, block);
    sendLetter(0, FarmMessage::traced, bytes.data(), bytes.size());
  }
}

}  // namespace whit
