#include "farm/messages_mpi.h"

#include <mpi.h>

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <type_traits>

#include "farm/blocks.h"

namespace whit {

namespace {

// Short against the milliseconds that a block takes; each worker has its next block in hand.
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

}  // namespace

bool lookForLetter(Letter& letter) {
  int there = 0;
  MPI_Status status;
  MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &there, &status);
  if (!there) return false;
  int count = 0;
  MPI_Get_count(&status, MPI_BYTE, &count);
  letter.from = status.MPI_SOURCE;
  letter.kind = static_cast<FarmMessage>(status.MPI_TAG);
  letter.bytes.resize(static_cast<std::size_t>(count));
  MPI_Recv(letter.bytes.data(), count, MPI_BYTE, letter.from, status.MPI_TAG, MPI_COMM_WORLD,
           MPI_STATUS_IGNORE);
  return true;
}

Letter waitForLetter() {
  Letter letter;
  while (!lookForLetter(letter)) std::this_thread::sleep_for(kNap);
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

}  // namespace whit
