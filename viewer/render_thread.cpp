#include "viewer/render_thread.h"

#include <algorithm>
#include <exception>

#include "cli/image_output.h"

namespace whit::view {

namespace {

// Bands of interruptible frames are meant to take so long: what a new request waits at most.
constexpr double kBandMs = 30;
constexpr int kBandRows = 32;  // at least: a row of tiles

ImageSize filmSizeOf(const Film& film) { return {film.image.width, film.image.height}; }

void sizeFilm(Film& film, const ImageSize& size, const Crop& window) {
  if (filmSizeOf(film) == size && film.image.window == window) return;
  film.image = Image(size.width, size.height, window);
}

// Copies a band of whole rows to its place.
void copyBand(const Film& band, Film& film) {
  const auto row = static_cast<std::ptrdiff_t>(band.image.window.y0);
  const std::ptrdiff_t width = film.image.width;
  std::copy(band.image.pixels.begin(), band.image.pixels.end(),
            film.image.pixels.begin() + row * width);
  std::copy(band.display.rgba.begin(), band.display.rgba.end(),
            film.display.rgba.begin() + row * width * 4);
}

}  // namespace

RenderThread::RenderThread(std::shared_ptr<const cli::OpenScene> scene,
                           const cli::CommonOptions& common, std::function<void()> onChange)
    : common_(common),
      onChange_(std::move(onChange)),
      scene_(std::move(scene)),
      options_(common.render),
      renderer_(std::make_unique<Renderer>(scene_->scene, options_)),
      thread_([this] { loop(); }) {}

RenderThread::~RenderThread() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void RenderThread::ask(const FrameRequest& request) {
  {
    const std::lock_guard lock(mutex_);
    asked_ = request;
    busy_ = true;
  }
  wake_.notify_one();
}

void RenderThread::reload(const std::string& name) {
  {
    const std::lock_guard lock(mutex_);
    sceneToLoad_ = name;
    busy_ = true;
  }
  wake_.notify_one();
}

bool RenderThread::take(TracedFrame& frame) {
  const std::lock_guard lock(mutex_);
  if (!fresh_) return false;
  std::swap(frame, ready_);
  fresh_ = false;
  return true;
}

std::string RenderThread::takeError() {
  const std::lock_guard lock(mutex_);
  return std::exchange(error_, std::string());
}

bool RenderThread::busy() const {
  const std::lock_guard lock(mutex_);
  return busy_;
}

bool RenderThread::superseded() const {
  const std::lock_guard lock(mutex_);
  return asked_.has_value() || sceneToLoad_.has_value() || quit_;
}

void RenderThread::loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    busy_ = asked_.has_value() || sceneToLoad_.has_value();
    wake_.wait(lock, [this] { return asked_ || sceneToLoad_ || quit_; });
    if (quit_) return;
    try {
      serve(lock);
    } catch (const std::exception& error) {
      if (!lock.owns_lock()) lock.lock();
      error_ = error.what();
    }
    lock.unlock();
    onChange_();
    lock.lock();
  }
}

void RenderThread::serve(std::unique_lock<std::mutex>& lock) {
  if (sceneToLoad_) {
    const std::string name = *std::exchange(sceneToLoad_, std::nullopt);
    lock.unlock();
    loadScene(name);
    lock.lock();
    return;
  }
  const FrameRequest request = *std::exchange(asked_, std::nullopt);
  lock.unlock();
  const bool complete = trace(request);
  lock.lock();
  if (!complete) return;
  std::swap(back_, ready_);
  fresh_ = true;
}

void RenderThread::loadScene(const std::string& name) {
  std::shared_ptr<const cli::OpenScene> scene = cli::openScene(name, common_, nullptr);
  auto renderer = std::make_unique<Renderer>(scene->scene, options_);
  renderer_ = std::move(renderer);  // before the scene that the old one reads goes
  scene_ = std::move(scene);
}

void RenderThread::applyOptions(const FrameRequest& request) {
  RenderOptions next = options_;
  next.size = request.size;
  next.spp = request.spp;
  next.exposure = request.exposure;
  next.toneCurve = request.toneCurve;
  next.disable = request.disable;
  const bool masks = makePlan(scene_->scene, next).effects.has(Effect::alphaMasks);
  if (masks != renderer_->plan().effects.has(Effect::alphaMasks)) {
    renderer_ = std::make_unique<Renderer>(scene_->scene, next);
  } else {
    renderer_->setOptions(next);
  }
  options_ = next;
}

bool RenderThread::trace(const FrameRequest& request) {
  applyOptions(request);
  const ImageSize size = request.size;
  sizeFilm(back_.film, size, Crop{0, 0, size.width, size.height});
  const double samples =
      static_cast<double>(size.width) * static_cast<double>(size.height) * request.spp;
  if (request.interruptible && msPerSample_ * samples > kBandMs) {
    if (!traceInBands(request.camera, back_.stats)) return false;
  } else {
    back_.stats = renderer_->render(request.camera, back_.film);
  }
  msPerSample_ = back_.stats.frameMs / samples;
  back_.scene = scene_;
  back_.request = request;
  back_.options = options_;
  back_.metadata =
      cli::describeImage(scene_->scene, request.camera, *renderer_, back_.film, options_);
  back_.effects = renderer_->plan().effects;
  back_.machine = renderer_->machine();
  back_.triangles = scene_->scene.instancedTriangles;
  return true;
}

bool RenderThread::traceInBands(const Camera& camera, FrameStats& sum) {
  Film& film = back_.film;
  const ImageSize size = filmSizeOf(film);
  film.display.width = size.width;
  film.display.height = size.height;
  film.display.rgba.resize(film.image.pixels.size() * 4);
  const double msPerRow = msPerSample_ * size.width * options_.spp;
  const int rows =
      std::max(static_cast<int>(kBandMs / msPerRow) / kBandRows * kBandRows, kBandRows);
  sum = FrameStats();
  for (int y = 0; y < size.height; y += rows) {
    if (superseded()) return false;
    sizeFilm(band_, size, Crop{0, y, size.width, std::min(y + rows, size.height)});
    const FrameStats stats = renderer_->render(camera, band_);
    copyBand(band_, film);
    sum.add(stats);
    sum.frameMs += stats.frameMs;
    sum.workers = stats.workers;
  }
  return true;
}

}  // namespace whit::view
