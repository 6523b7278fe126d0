// The summary of a run: a scene, its settings, and what its frames cost. Tables and JSON follow
// from it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/event_counters.h"
#include "core/options.h"
#include "core/quantile.h"
#include "render/renderer.h"

namespace whit {

struct RunSummary {
  std::string scene;
  std::string name;  // tells runs of one scene apart: "effects all"; may be empty
  int width = 0, height = 0;
  RenderOptions options;
  Machine machine;
  EffectSet effects;
  std::uint64_t triangles = 0, spheres = 0;  // counted once for each instance
  double loadMs = 0, buildMs = 0;
  std::vector<FrameStats> frames;  // the frames that count; none if --resume kept all images
  std::vector<double> floorMs;     // empty without --floor
  // Sums over the frames of kProcessorEvents; empty where they were not counted.
  std::vector<double> events;
  std::string noEvents;  // why they were not counted; empty if they were, or nobody asked
  // Tasks of other programs that wanted a processor before each frame; empty if nobody looked.
  std::vector<double> otherTasks;
  int processors = 0;     // number of the machine's processors
  std::string imageHash;  // digestOf() the last frame's image
  // Images are written while the next frame is traced: the time of writing each image, and how
  // long the tracing waited for it.
  std::vector<double> writingMs, waitedMs;
  std::vector<double> updateMs;   // time to bring a scene that moves to each frame's instant
  double tracedAndWrittenMs = 0;  // time from the first frame to the last file
  std::size_t kept = 0;           // number of frames whose images existed already
};

RunSummary summarize(const Scene& scene, const RenderOptions& options, const Renderer& renderer,
                     const Film& film, double loadMs);

// Returns the frame of median duration, or the lower of the two middle ones; its stages add up.
const FrameStats& medianFrame(const RunSummary& run);
std::vector<double> frameTimes(const RunSummary& run);

// Returns one line that says why the times are longer than on an idle machine; empty if they are
// not.
std::string loadText(const RunSummary& run);

// Frames per second, traced and written.
double writtenPerSecond(const RunSummary& run);

// The frame's time that is not spent inside Embree's calls.
double outsideEmbreeMs(const FrameStats& frame);

struct RunRatio {
  double frame = 0, outsideEmbree = 0;
};
// Returns the times of `a` over those of `b`, two runs whose frames took turns: the medians over
// the turns, so that disturbances of both frames of a turn cancel. They are 0 if there are no
// frames.
RunRatio ratioOf(const RunSummary& a, const RunSummary& b);

// Live lanes over lanes sent to Embree; 0 where nothing was sent.
double lanesFilled(const RayTally& tally);
double mraysPerSecond(std::uint64_t rays, double ms);
// The counts of kProcessorEvents for a ray of the frames; empty where they were not counted.
std::vector<double> eventsPerRay(const RunSummary& run);

// "2 triangles", "3 spheres" or both.
std::string surfacesText(std::uint64_t triangles, std::uint64_t spheres);

// Returns the memory of scene, tables, queues and acceleration structure, in 10^6 bytes.
double memoryMb(const Scene& scene, const Renderer& renderer);

// Returns a table for people: one line about the run's settings, one about its frame times, the
// eight stages of the median frame, its rays of the kinds that the scene calls for, the time of
// writing its image if it was written, and the floor if it was measured.
std::string stageTable(const RunSummary& run);

// Returns a sentence for each kind of fault in the pictures of all frames: pixels whose rays were
// limited, and pixels that are not finite.
std::vector<std::string> pictureWarnings(const RunSummary& run);

// Returns the times of the second of two runs over those of the first, as text. Both are of one
// scene and their frames took turns.
std::string ratioText(const RunSummary& first, const RunSummary& second);

}  // namespace whit
