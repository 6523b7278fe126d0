#include <mpi.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <type_traits>
#include <vector>

#include "core/error.h"
#include "core/printable.h"
#include "core/stopwatch.h"
#include "farm/blocks.h"
#include "farm/farm.h"
#include "render/frame.h"

namespace whit {

namespace {

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

struct TracedBlock {
  std::int32_t index = 0;
  float ms = 0;
  FrameStats stats;
};
// Every wait sleeps this long between two looks, because MPI's own waiting spins and would take the
// processor from the threads that trace. Short against the milliseconds that a block takes; each
// worker has its next block in hand.
constexpr std::chrono::microseconds kNap{50};

static_assert(std::is_trivially_copyable_v<TracedBlock> && std::is_trivially_copyable_v<Rgb>);

// use(values) for each channel that is there.
template <typename Layers, typename Use>
void forEachLayer(Layers& layers, Use&& use) {
  layers.channels().forEach([&](Channel c) {
    if (infoOf(c).countsThings) {
      use(layers.numbers(c));
    } else {
      use(layers.floats(c));
    }
  });
}

// Receives the next message for this rank from anyone.
Letter waitForLetter() {
  int there = 0;
  MPI_Status status;
  for (;;) {
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
    if (there) break;
    std::this_thread::sleep_for(kNap);
  }
  int count = 0;
  MPI_Get_count(&status, MPI_BYTE, &count);
  Letter letter{status.MPI_SOURCE, static_cast<FarmMessage>(status.MPI_TAG), {}};
  letter.bytes.resize(static_cast<std::size_t>(count));
  MPI_Recv(letter.bytes.data(), count, MPI_BYTE, letter.from, status.MPI_TAG, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return letter;
}

void sendLetter(int to, FarmMessage kind, const void* bytes, std::size_t count) {
  MPI_Request request;
  MPI_Isend(bytes, static_cast<int>(count), MPI_BYTE, to, static_cast<int>(kind), MPI_COMM_WORLD,
            &request);
  for (int done = 0;;) {
    MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    if (done) return;  // NOLINT(clang-analyzer-optin.mpi.MPI-Checker): MPI_Test ends it too
    std::this_thread::sleep_for(kNap);
  }
}

void sendBlockIndex(int to, std::int32_t index) {
  sendLetter(to, FarmMessage::block, &index, sizeof index);
}

// A traced block as the bytes of a message. All ranks run the same program on the same kind of
// machine, so numbers travel as they are in memory.
std::vector<char> packBlock(const TracedBlock& block, const Film& film) {
  const std::size_t linear = film.image.pixels.size() * sizeof(Rgb);
  const std::vector<std::uint8_t>& rgba = film.display.rgba;
  std::vector<char> bytes(sizeof block + linear + rgba.size());
  bytes.reserve(bytes.size() + film.channels.bytes());
  std::memcpy(bytes.data(), &block, sizeof block);
  std::memcpy(bytes.data() + sizeof block, film.image.pixels.data(), linear);
  if (!rgba.empty()) std::memcpy(bytes.data() + sizeof block + linear, rgba.data(), rgba.size());
  forEachLayer(film.channels, [&](const auto& values) {
    const auto* const first = reinterpret_cast<const char*>(values.data());
    bytes.insert(bytes.end(), first, first + values.size_bytes());
  });
  return bytes;
}

// Stores the pixels at the place of blocks[index]. Throws std::runtime_error for a message of the
// wrong length: the ranks were started with different options.
TracedBlock unpackBlock(const std::vector<char>& bytes, const std::vector<Crop>& blocks,
                        Film& whole) {
  const auto wrong = [] {
    throw std::runtime_error("a block of another size came: all ranks need the same options");
  };
  TracedBlock block;
  if (bytes.size() < sizeof block) wrong();
  std::memcpy(&block, bytes.data(), sizeof block);
  if (block.index < 0 || static_cast<std::size_t>(block.index) >= blocks.size()) wrong();
  const Crop& crop = blocks[static_cast<std::size_t>(block.index)];
  const auto count =
      static_cast<std::size_t>(crop.x1 - crop.x0) * static_cast<std::size_t>(crop.y1 - crop.y0);
  ChannelLayers channels;
  channels.resize(whole.channels.channels(), count);
  const std::size_t linear = count * sizeof(Rgb);
  if (bytes.size() < sizeof block + linear + channels.bytes()) wrong();
  const std::size_t rest = bytes.size() - sizeof block - channels.bytes();
  if (rest != linear && rest != linear + 4 * count) wrong();
  std::vector<Rgb> pixels(count);
  std::memcpy(pixels.data(), bytes.data() + sizeof block, linear);
  const auto* rgba = reinterpret_cast<const std::uint8_t*>(bytes.data() + sizeof block + linear);
  place(crop, pixels.data(), rest == linear ? nullptr : rgba, whole);
  const char* next = bytes.data() + sizeof block + rest;
  forEachLayer(channels, [&](auto values) {
    std::memcpy(values.data(), next, values.size_bytes());
    next += values.size_bytes();
  });
  place(crop, channels, whole);
  return block;
}

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
