#include "io/texture_loader.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "core/error.h"
#include "core/index.h"
#include "core/machine_limits.h"
#include "io/files.h"
#include "io/image/texture_from_image.h"
#include "scene/members.h"

namespace whit {
namespace {

// Returns nothing if the image has no such texture.
std::optional<Texture> makeUse(const std::string& name, const RawImage& raw,
                               const TextureSource& source, TextureUse use, Warnings& warnings) {
  if (use == TextureUse::emission) return makeEmissionTexture(name, raw, warnings);
  if (use == TextureUse::color) {
    warnOfClampedColors(name, raw, warnings);
    return makeTexture(name, raw, TexelFormat::color);
  }

  if (use == TextureUse::bump && looksLikeHeights(raw)) {
    return normalsFromHeights(name, raw, source.bumpScale, source.wrapU, source.wrapV);
  }
  if (use == TextureUse::mask || use == TextureUse::colorAlpha) {
    if (hasTranslucentAlpha(raw)) return makeAlphaTexture(name, raw);
    if (use == TextureUse::colorAlpha) return std::nullopt;
  }

  return makeTexture(name, raw, TexelFormat::data);
}

}  // namespace

DecodeQueue::DecodeQueue(int threads, Progress* progress, std::string phase)
    : progress_(progress),
      phase_(std::move(phase)),
      threads_(std::max(threads > 0 ? threads : usableThreads(), 1)) {}

DecodeQueue::~DecodeQueue() {
  {
    const std::lock_guard lock(mutex_);
    begun_ = tasks_.size();
  }

  try {
    close();
  } catch (...) {  // thrown by the progress observer; the tasks are dropped anyway
    return;
  }
}

void DecodeQueue::add(std::function<void()> task) {
  if (!pool_) {
    pool_.emplace(threads_, Denormals::kept).begin(job_);
    running_ = true;
  }

  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back({std::move(task), nullptr});
  }
  wake_.notify_one();
}

void DecodeQueue::run(Task& task, std::unique_lock<std::mutex>& lock) {
  const bool isFirstRun = !std::exchange(task.failure, nullptr);
  bool again = false;

  lock.unlock();
  try {
    task.work();
  } catch (const Error& error) {
    task.failure = std::current_exception();
    again = isFirstRun && error.status() == ExitStatus::limit;
  } catch (...) {
    task.failure = std::current_exception();
  }

  lock.lock();
  // A task that exceeded the memory keeps its work, so that finish() can run it again.
  if (again) return;

  task.work = nullptr;
  const double fraction = static_cast<double>(++ended_) / static_cast<double>(tasks_.size());
  lock.unlock();
  reportProgress(progress_, phase_, fraction);
  lock.lock();
}

void DecodeQueue::work() {
  std::unique_lock lock(mutex_);

  try {
    for (;;) {
      wake_.wait(lock, [&] { return closing_ || begun_ < tasks_.size(); });
      if (begun_ == tasks_.size()) return;
      run(tasks_[begun_++], lock);
    }
  } catch (...) {  // thrown by the progress observer to cancel the work
    if (!lock.owns_lock()) lock.lock();
    begun_ = tasks_.size();
    throw;
  }
}

void DecodeQueue::close() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_all();
  if (std::exchange(running_, false)) pool_->finish();
}

void DecodeQueue::finish() {
  close();

  // Tasks that exceeded the memory run again when all others have given theirs back.
  std::unique_lock lock(mutex_);
  for (Task& task : tasks_) {
    if (task.work) run(task, lock);
  }

  for (const Task& task : tasks_) {
    if (task.failure) std::rethrow_exception(task.failure);
  }
}

TextureLoader::TextureLoader(int threads, MemoryBudget& budget, Warnings& warnings,
                             Progress* progress)
    : budget_(budget), warnings_(warnings), queue_(threads, progress, "making textures") {}

std::vector<std::int32_t> TextureLoader::add(const TextureSource& source,
                                             const std::vector<TextureUse>& uses) {
  std::vector<std::int32_t> slots;
  std::vector<std::pair<TextureUse, std::optional<Texture>*>> targets;

  for (TextureUse use : uses) {
    // Images that cannot exceed 1 emit as color textures do, and share their slots.
    if (use == TextureUse::emission && !source.given && !holdsRadiance(source.path)) {
      use = TextureUse::color;
    }

    const Key key{source.given ? source.where : source.path,
                  use,
                  source.wrapU,
                  source.wrapV,
                  source.nearest,
                  use == TextureUse::bump ? source.bumpScale : 1.0f};

    const auto [entry, isNew] = known_.emplace(key, static_cast<std::int32_t>(slots_.size()));
    slots.push_back(entry->second);
    if (isNew) targets.emplace_back(use, &slots_.emplace_back());
  }

  if (targets.empty()) return slots;
  queue_.add([this, source, targets] {
    RawImage raw;
    MemoryHold copy;

    try {
      if (source.given) {
        copy = MemoryHold(&budget_, 1, source.given->bytes(), source.where);
        raw = imageOf(*source.given, source.where);
      } else {
        raw = readNamedAt(source.lenient ? "" : source.where,
                          [&] { return readStraightImage(source.path, limits(), warnings_); });
      }
    } catch (const Error& error) {
      if (!source.lenient || error.status() == ExitStatus::limit) throw;
      warnings_.add("texture left out", source.where + ": " + error.what());
      return;
    }

    const std::string name =
        source.given ? source.where : std::filesystem::path(source.path).filename().string();
    for (const auto& [use, target] : targets) *target = make(name, raw, source, use);
  });

  return slots;
}

std::vector<std::int32_t> TextureLoader::add(
    std::size_t count, std::function<std::vector<std::optional<Texture>>()> make) {
  std::vector<std::int32_t> slots;
  std::vector<std::optional<Texture>*> targets;
  for (std::size_t i = 0; i < count; ++i) {
    slots.push_back(static_cast<std::int32_t>(slots_.size()));
    targets.push_back(&slots_.emplace_back());
  }

  queue_.add([this, make = std::move(make), targets] {
    std::vector<std::optional<Texture>> made = make();
    for (const auto i : indices(targets)) {
      if (!made[i]) continue;
      budget_.charge(made[i]->texelCount(), sizeof(std::uint32_t), "texture " + made[i]->name);
      *targets[i] = std::move(made[i]);
    }
  });

  return slots;
}

void TextureLoader::whenDone(std::function<void(SceneDescription&)> change) {
  changes_.push_back(std::move(change));
}

void TextureLoader::addEnvironment(const std::string& path, const std::string& where,
                                   EnvironmentImage& image) {
  queue_.add([this, path, where, &image] {
    const RawImage raw =
        readNamedAt(where, [&] { return readRawImage(path, limits(), warnings_); });

    // An image made from a cube has 8/6 of its pixels; twice as many are an upper bound.
    const std::size_t pixels = raw.isCube ? 2 * raw.pixels() : raw.pixels();
    MemoryHold planes(&budget_, pixels, 3 * sizeof(float), path);
    image = makeEnvironment(raw);
    planes.keep();
  });
}

ImageLimits TextureLoader::limits() const {
  ImageLimits limits;
  limits.budget = &budget_;
  return limits;
}

std::optional<Texture> TextureLoader::make(const std::string& name, const RawImage& raw,
                                           const TextureSource& source, TextureUse use) {
  MemoryHold texels(&budget_, raw.pixels(), sizeof(std::uint32_t), name);
  std::optional<Texture> texture = makeUse(name, raw, source, use, warnings_);
  if (!texture) return texture;

  texels.keep();
  texture->wrapU = source.wrapU;
  texture->wrapV = source.wrapV;
  texture->nearest = source.nearest;
  return texture;
}

void TextureLoader::finish(SceneDescription& scene) {
  queue_.finish();
  for (const auto& change : changes_) change(scene);

  // Unused slots are dropped: a color without alpha leaves an empty one, and an override may have
  // replaced a map.
  std::vector<std::int32_t> number(slots_.size(), kNoTexture);
  for (Material& material : scene.materials) {
    forEachMap([&](const auto& member) {
      std::int32_t& map = material.*member.field;
      if (map == kNoTexture) return;
      const std::size_t slot = static_cast<std::size_t>(map);

      if (number[slot] == kNoTexture && slots_[slot]) {
        number[slot] = static_cast<std::int32_t>(scene.textures.size());
        scene.textures.push_back(std::move(*slots_[slot]));
      }
      map = number[slot];
    });
  }
}

}  // namespace whit
