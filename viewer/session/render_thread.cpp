#include "viewer/session/render_thread.h"

#include <exception>
#include <utility>

namespace whit::view {

RenderThread::RenderThread(std::shared_ptr<OpenScene> scene, const cli::CommonOptions& common,
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

// Changes the requests and wakes the tracing thread.
template <typename Change>
void RenderThread::post(const Change& change) {
  {
    const std::lock_guard lock(mutex_);
    change();
    busy_ = busy_ || hasWork();
  }
  wake_.notify_one();
}

// Changes the results and tells the window.
template <typename Change>
void RenderThread::report(const Change& change) {
  {
    const std::lock_guard lock(mutex_);
    change();
  }
  onChange_();
}

bool RenderThread::ask(const FrameRequest& request) {
  bool taken = false;
  post([&] {
    taken = !fresh_ && !isCommitted();
    if (taken) asked_ = request;
  });
  return taken;
}

void RenderThread::load(std::unique_ptr<Engine> scene) {
  post([&] {
    scene_ = std::move(scene);
    edit_.reset();
  });
}

void RenderThread::edit(const SceneEdit& edit) {
  post([&] { edit_ = edit; });
}

void RenderThread::query(const RayQuery& query) {
  post([&] { query_ = query; });
}

bool RenderThread::take(TracedFrame& frame) {
  const std::lock_guard lock(mutex_);
  if (!fresh_) return false;
  std::swap(frame, ready_);
  fresh_ = false;
  return true;
}

bool RenderThread::busy() const {
  const std::lock_guard lock(mutex_);
  return busy_;
}

bool RenderThread::committed() const {
  const std::lock_guard lock(mutex_);
  return isCommitted();
}

void RenderThread::loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    busy_ = hasWork();
    wake_.wait(lock, [this] { return hasWork() || quit_; });
    if (quit_) return;

    try {
      serve(lock);
    } catch (const std::exception& error) {
      // The work may have failed while the lock was released.
      if (!lock.owns_lock()) lock.lock();
      tracing_.reset();
      unfinished_.reset();
      error_ = error.what();
    }

    lock.unlock();
    progress_.clear();
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

  // Changes of the scene come before queries and pictures, which then are of the new state.
  if (auto scene = std::move(scene_)) {
    unlocked([&] { tracer_.load(std::move(scene)); });
  } else if (const auto edit = std::exchange(edit_, std::nullopt)) {
    unlocked([&] { tracer_.edit(*edit); });
  } else if (query_) {
    unlocked([&] { answerQuery(); });
  } else {
    tracing_ = std::exchange(asked_, std::nullopt);
    unlocked([&] { trace(*tracing_); });
  }
}

TraceCalls RenderThread::calls() {
  // The workers call these functions from several threads, so each call takes the lock.
  const auto locked = [this](auto&& of) {
    return [this, of] {
      const std::lock_guard lock(mutex_);
      return of();
    };
  };

  TraceCalls calls;
  calls.superseded = locked([this] { return isWaiting() || quit_; });
  calls.stopped = locked([this] { return quit_ || (!isCommitted() && hasWork()); });
  calls.answer = [this] { answerQuery(); };
  calls.progress = &progress_;

  calls.publish = [this](const TracedFrame& frame) {
    TracedFrame copy = frame;
    report([&] {
      std::swap(copy, ready_);
      fresh_ = true;
    });
  };

  calls.showUnfinished = [this](UnfinishedFrame frame) {
    report([&] { unfinished_ = std::move(frame); });
  };
  return calls;
}

void RenderThread::trace(const FrameRequest& request) {
  const bool complete = tracer_.trace(request, back_, calls());

  // A picture in motion is always shown. One at rest is dropped if another request waits.
  const std::lock_guard lock(mutex_);
  if (complete && (isCommitted() || !isWaiting())) {
    std::swap(back_, ready_);
    fresh_ = true;
  } else if (!complete && !isWaiting()) {
    asked_ = request;  // only a query interrupted it
  }

  tracing_.reset();
  unfinished_.reset();
}

void RenderThread::answerQuery() {
  const std::optional<RayQuery> query = taken(query_);
  if (!query) return;

  try {
    RayPick pick = tracer_.explain(*query);
    report([&] { pick_ = std::move(pick); });
  } catch (const std::exception& error) {
    report([&] { error_ = error.what(); });  // the picture under way goes on
  }
}

}  // namespace whit::view
