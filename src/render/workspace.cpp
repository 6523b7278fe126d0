#include "render/workspace.h"

#include <algorithm>

namespace whit {

Workspace::Workspace(const Plan& plan, std::size_t capacity)
    : plan_(plan),
      capacity_(roundUpToBlock(capacity)),
      levels_(static_cast<std::size_t>(plan.depth) + 1),
      hits_(capacity_, plan.features),
      surfels_(capacity_, plan.features) {
  if (plan.writes(Part::unshadowed)) unshadowed_.allocate(capacity_, plan.features);
  if (plan.has(Stage::checkShadows)) shadows_.allocate(capacity_, plan.features);
  reserveRays(0, capacity_);
}

void Workspace::reserveCodes(std::size_t pixels) { codes_.resize(roundUpToBlock(pixels) + kBlock); }

void Workspace::reserveRays(int depth, std::size_t rays) {
  Level& at = level(depth);
  if (at.rays.capacity() >= rays) return;
  at.rays.allocate(rays, plan_.features);
  if (at.radiance.capacity() == 0) at.radiance.allocate(capacity_, plan_.features);
  if (plan_.writes(Part::rayCounts)) at.rayCounts.resize(capacity_);
}

void Workspace::startQueue(std::size_t rays) {
  Level& first = level(0);
  first.count = rays;
  first.segments[0] = {RayKind::primary, 0, rays};
  first.segmentCount = 1;
  first.cursor = 0;
}

void Workspace::takeChunk(int depth, Chunk& chunk) {
  Level& at = level(depth);
  at.chunk = std::min(capacity_, at.count - at.cursor);
  returnTo(depth, chunk);
  // A chunk may hold some of each kind.
  chunk.segmentCount = 0;
  for (std::size_t s = 0; s < at.segmentCount; ++s) {
    const auto within = [&](std::size_t i) {
      return std::clamp(i, at.cursor, at.cursor + at.chunk) - at.cursor;
    };
    const Segment& of = at.segments[s];
    const Segment part{of.kind, within(of.begin), within(of.end)};
    if (part.begin < part.end) chunk.segments[chunk.segmentCount++] = part;
  }
  chunk.coherent = depth <= plan_.coherentDepth;
  chunk.childCount = chunk.childSegmentCount = 0;
  chunk.shadowCount = 0;
  chunk.light = nullptr;
}

void Workspace::returnTo(int depth, Chunk& chunk) const {
  const Level& at = level(depth);
  chunk.depth = depth;
  chunk.first = at.cursor;
  chunk.n = at.chunk;
  chunk.rays = advanced(*at.rays, at.cursor);
  chunk.radiance = *at.radiance;
  chunk.parentRadiance = depth > 0 ? *level(depth - 1).radiance : RadianceColumns();
  const auto countsOf = [](const Level& l) {
    return const_cast<std::uint32_t*>(l.rayCounts.data());
  };
  chunk.rayCounts = countsOf(at);
  chunk.parentRayCounts = depth > 0 ? countsOf(level(depth - 1)) : nullptr;
  chunk.hits = *hits_;
  chunk.surfels = *surfels_;
  chunk.unshadowed = *unshadowed_;
  chunk.shadows = *shadows_;
  chunk.codes = const_cast<std::uint32_t*>(codes_.data());
}

void Workspace::returnToPixels(Chunk& chunk) {
  level(0).cursor = 0;
  returnTo(0, chunk);
}

void Workspace::reserveChildren(std::size_t count, Chunk& chunk) {
  reserveRays(chunk.depth + 1, count);
  chunk.children = *level(chunk.depth + 1).rays;
}

void Workspace::noteChildren(RayKind kind, std::size_t before, Chunk& chunk) {
  if (chunk.childCount == before) return;
  Segment* last =
      chunk.childSegmentCount > 0 ? &chunk.childSegments[chunk.childSegmentCount - 1] : nullptr;
  if (!last || last->kind != kind) {
    last = &chunk.childSegments[chunk.childSegmentCount++];
    *last = {kind, before, before};
  }
  last->end = chunk.childCount;
}

bool Workspace::startQueueOfChildren(const Chunk& chunk) {
  if (chunk.childCount == 0) return false;
  Level& next = level(chunk.depth + 1);
  next.count = chunk.childCount;
  next.segments = chunk.childSegments;
  next.segmentCount = chunk.childSegmentCount;
  next.cursor = 0;
  return true;
}

BufferBytes Workspace::bufferBytes() const {
  BufferBytes bytes;
  for (const Level& level : levels_) {
    bytes.rays += level.rays.bytes();
    bytes.radiance += level.radiance.bytes();
    bytes.rayCounts += level.rayCounts.capacity() * sizeof(std::uint32_t);
  }
  bytes.hits = hits_.bytes();
  bytes.surfels = surfels_.bytes();
  bytes.unshadowed = unshadowed_.bytes();
  bytes.shadows = shadows_.bytes();
  return bytes;
}

std::size_t Workspace::bytes() const {
  return bufferBytes().sum() + codes_.capacity() * sizeof(std::uint32_t);
}

}  // namespace whit
