#include "viewer/render_thread.h"

#include <chrono>
#include <exception>
#include <utility>

namespace whit::view {

// The view is at rest when nothing has been asked for this long.
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

bool RenderThread::ask(const FrameRequest& request) {
  bool taken = false;
  post([&] {
    taken = !fresh_ && !isCommitted();
    if (taken) asked_ = request;
  });
  return taken;
}

void RenderThread::load(const SceneChoice& scene) {
  post([&] { scene_ = scene; });
}

void RenderThread::edit(ShadingEdit edit) {
  post([&] { edit_ = std::move(edit); });
}

void RenderThread::query(const RayQuery& query) {
  post([&] { query_ = query; });
}

std::optional<RayPick> RenderThread::takePick() {
  const std::lock_guard lock(mutex_);
  return std::exchange(pick_, std::nullopt);
}

bool RenderThread::take(TracedFrame& frame) {
  const std::lock_guard lock(mutex_);
  if (!fresh_) return false;
  std::swap(frame, ready_);
  fresh_ = false;
  return true;
}

std::optional<UnfinishedFrame> RenderThread::takeUnfinished() {
  const std::lock_guard lock(mutex_);
  return std::exchange(unfinished_, std::nullopt);
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
  return isCommitted();
}

void RenderThread::loop() {
  std::unique_lock lock(mutex_);
  for (;;) {
    busy_ = hasWork();
    waitForWork(lock);
    if (quit_) return;
    try {
      serve(lock);
    } catch (const std::exception& error) {
      if (!lock.owns_lock()) lock.lock();
      tracing_.reset();
      unfinished_.reset();
      error_ = error.what();
    }
    lock.unlock();
    onChange_();
    lock.lock();
  }
}

// At rest the thread fills the shadow cache, which makes the next pictures faster.
void RenderThread::waitForWork(std::unique_lock<std::mutex>& lock) {
  const auto wanted = [this] { return hasWork() || quit_; };
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
  if (const auto scene = std::exchange(scene_, std::nullopt)) {
    unlocked([&] { tracer_.load(*scene); });
  } else if (auto edit = std::exchange(edit_, std::nullopt)) {
    unlocked([&] { tracer_.edit(std::move(*edit)); });
  } else if (query_) {
    unlocked([&] { answerQuery(); });
  } else {
    tracing_ = std::exchange(asked_, std::nullopt);
    unlocked([&] { trace(*tracing_); });
  }
}

TraceCalls RenderThread::calls() {
  const auto locked = [this](auto&& of) {
    return [this, of] {
      const std::lock_guard lock(mutex_);
      return of();
    };
  };
  TraceCalls calls;
  calls.superseded = locked([this] { return isWaiting() || quit_; });
  calls.queried = locked([this] { return query_.has_value(); });
  calls.leaving = locked([this] { return quit_; });
  calls.answer = [this] { answerQuery(); };
  calls.publish = [this](const TracedFrame& frame) {
    TracedFrame copy = frame;
    {
      const std::lock_guard lock(mutex_);
      std::swap(copy, ready_);
      fresh_ = true;
    }
    onChange_();
  };
  calls.showUnfinished = [this](UnfinishedFrame frame) {
    {
      const std::lock_guard lock(mutex_);
      unfinished_ = std::move(frame);
    }
    onChange_();
  };
  return calls;
}

void RenderThread::trace(const FrameRequest& request) {
  const bool complete = tracer_.trace(request, back_, calls());
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
  std::optional<RayQuery> query;
  {
    const std::lock_guard lock(mutex_);
    query = std::exchange(query_, std::nullopt);
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
    if (pick) pick_ = std::move(pick);
    if (!error.empty()) error_ = error;
  }
  onChange_();
}

}  // namespace whit::view
