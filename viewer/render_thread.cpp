#include "viewer/render_thread.h"

#include <exception>
#include <utility>

namespace whit::view {

RenderThread::RenderThread(std::shared_ptr<cli::OpenScene> scene, const cli::CommonOptions& common,
                           std::function<void()> onChange)
    : onChange_(std::move(onChange)),
      tracer_(std::move(scene), common),
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

void RenderThread::load(const std::string& name) {
  {
    const std::lock_guard lock(mutex_);
    sceneToLoad_ = name;
    busy_ = true;
  }
  wake_.notify_one();
}

void RenderThread::edit(ShadingEdit edit) {
  {
    const std::lock_guard lock(mutex_);
    edit_ = std::move(edit);
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
  return waiting() || quit_;
}

bool RenderThread::waiting() const { return asked_ || sceneToLoad_ || edit_; }

void RenderThread::loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    busy_ = waiting();
    wake_.wait(lock, [this] { return waiting() || quit_; });
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
  const auto unlocked = [&](auto&& work) {
    lock.unlock();
    work();
    lock.lock();
  };
  if (sceneToLoad_) {
    const std::string name = *std::exchange(sceneToLoad_, std::nullopt);
    unlocked([&] { tracer_.load(name); });
  } else if (edit_) {
    ShadingEdit edit = *std::exchange(edit_, std::nullopt);
    unlocked([&] { tracer_.edit(std::move(edit)); });
  } else {
    const FrameRequest request = *std::exchange(asked_, std::nullopt);
    unlocked([&] { trace(request); });
  }
}

void RenderThread::trace(const FrameRequest& request) {
  const bool complete = tracer_.trace(
      request, back_, [this] { return superseded(); },
      [this](const TracedFrame& frame) { publish(frame); });
  if (!complete) return;
  const std::lock_guard lock(mutex_);
  std::swap(back_, ready_);
  fresh_ = true;
}

void RenderThread::publish(const TracedFrame& frame) {
  TracedFrame copy = frame;
  {
    const std::lock_guard lock(mutex_);
    std::swap(ready_, copy);
    fresh_ = true;
  }
  onChange_();
}

}  // namespace whit::view
