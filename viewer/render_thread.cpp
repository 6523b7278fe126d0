#include "viewer/render_thread.h"

#include <chrono>
#include <exception>
#include <utility>

namespace whit::view {

// The view is at rest when nothing has been asked for so long.
constexpr std::chrono::milliseconds kRest{200};

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

// Wakes the tracing thread, unless `change` says that nothing has changed for it.
bool RenderThread::post(const std::function<bool()>& change) {
  {
    const std::lock_guard lock(mutex_);
    if (!change()) return false;
    busy_ = true;
  }
  wake_.notify_one();
  return true;
}

bool RenderThread::ask(const FrameRequest& request) {
  return post([&] { return exchange_.ask(request); });
}

void RenderThread::load(const SceneChoice& scene) {
  post([&] { return exchange_.load(scene), true; });
}

void RenderThread::edit(ShadingEdit edit) {
  post([&] { return exchange_.edit(std::move(edit)), true; });
}

void RenderThread::query(const RayQuery& query) {
  post([&] { return exchange_.query(query), true; });
}

std::optional<RayPick> RenderThread::takePick() {
  const std::lock_guard lock(mutex_);
  return exchange_.takePick();
}

bool RenderThread::take(TracedFrame& frame) {
  const std::lock_guard lock(mutex_);
  return exchange_.take(frame);
}

std::optional<UnfinishedFrame> RenderThread::takeUnfinished() {
  const std::lock_guard lock(mutex_);
  return exchange_.takeUnfinished();
}

std::string RenderThread::takeError() {
  const std::lock_guard lock(mutex_);
  return std::exchange(error_, std::string());
}

bool RenderThread::busy() const {
  const std::lock_guard lock(mutex_);
  return busy_;
}

bool RenderThread::committed() const {
  const std::lock_guard lock(mutex_);
  return exchange_.committed();
}

bool RenderThread::superseded() const {
  const std::lock_guard lock(mutex_);
  return exchange_.waiting() || quit_;
}

bool RenderThread::leaving() const {
  const std::lock_guard lock(mutex_);
  return quit_;
}

void RenderThread::loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    busy_ = exchange_.hasWork();
    waitForWork(lock);
    if (quit_) return;
    try {
      serve(lock);
    } catch (const std::exception& error) {
      if (!lock.owns_lock()) lock.lock();
      exchange_.giveUp();
      error_ = error.what();
    }
    lock.unlock();
    onChange_();
    lock.lock();
  }
}

// At rest the time goes into what makes the next pictures quicker.
void RenderThread::waitForWork(std::unique_lock<std::mutex>& lock) {
  const auto wanted = [this] { return exchange_.hasWork() || quit_; };
  while (!wake_.wait_for(lock, kRest, wanted)) {
    bool more = true;
    while (more && !wanted()) {
      lock.unlock();
      more = tracer_.proveSome();
      lock.lock();
    }
    if (!more) return wake_.wait(lock, wanted);
  }
}

void RenderThread::serve(std::unique_lock<std::mutex>& lock) {
  const auto unlocked = [&](auto&& work) {
    lock.unlock();
    work();
    lock.lock();
  };
  if (const auto scene = exchange_.nextScene()) {
    unlocked([&] { tracer_.load(*scene); });
  } else if (auto edit = exchange_.nextEdit()) {
    unlocked([&] { tracer_.edit(std::move(*edit)); });
  } else if (const auto request = exchange_.begin()) {
    unlocked([&] { trace(*request); });
  } else {
    unlocked([&] { answerQuery(); });
  }
}

TraceCalls RenderThread::calls() {
  TraceCalls calls;
  calls.superseded = [this] {
    answerQuery();
    return superseded();
  };
  calls.leaving = [this] {
    answerQuery();
    return leaving();
  };
  calls.publish = [this](const TracedFrame& frame) { publish(frame); };
  calls.showUnfinished = [this](UnfinishedFrame frame) { publish(std::move(frame)); };
  return calls;
}

void RenderThread::trace(const FrameRequest& request) {
  const bool complete = tracer_.trace(request, back_, calls());
  const std::lock_guard lock(mutex_);
  if (complete) {
    exchange_.finish(back_);
  } else {
    exchange_.giveUp();
  }
}

void RenderThread::answerQuery() {
  std::optional<RayQuery> query;
  {
    const std::lock_guard lock(mutex_);
    query = exchange_.nextQuery();
  }
  if (!query) return;
  std::optional<RayPick> pick;
  std::string error;
  try {
    pick = tracer_.explain(*query);
  } catch (const std::exception& e) {
    error = e.what();  // the picture under way goes on
  }
  {
    const std::lock_guard lock(mutex_);
    if (pick) exchange_.answer(std::move(*pick));
    if (!error.empty()) error_ = error;
  }
  onChange_();
}

void RenderThread::publish(const TracedFrame& frame) {
  TracedFrame copy = frame;
  {
    const std::lock_guard lock(mutex_);
    exchange_.show(copy);
  }
  onChange_();
}

void RenderThread::publish(UnfinishedFrame frame) {
  {
    const std::lock_guard lock(mutex_);
    exchange_.showUnfinished(std::move(frame));
  }
  onChange_();
}

}  // namespace whit::view
