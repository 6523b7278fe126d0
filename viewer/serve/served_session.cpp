#include "viewer/serve/served_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"
#include "io/image/image_layers.h"
#include "output/frame_summary.h"
#include "viewer/session/control.h"

namespace whit::serve {

namespace {

constexpr std::size_t kMostMessages = 4096;          // messages that may wait for the loop
constexpr int kLeastSide = 16, kLargestSide = 4096;  // pixels of a page's picture
constexpr double kMostWindowPixels = 4e6;            // largest number of pixels
constexpr double kIdleSeconds = 0.25;                // longest wait of the loop
constexpr std::chrono::milliseconds kWait{200};      // longest wait of a page for a shot
constexpr std::chrono::seconds kDownloadTime{30};    // longest wait for a picture to download

// Errors of files may hold bytes that are no UTF-8.
std::string textOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// How the page shows an option.
Json describe(const view::Control& control) {
  Json json{{"name", control.name}, {"help", control.help}, {"first", control.first}};

  if (!control.choices.empty()) {
    json["choices"] = control.choices;
    return json;
  }

  json["low"] = control.low;
  json["high"] = control.high;
  json["step"] = control.step > 0 ? Json(control.step) : Json("any");
  return json;
}

}  // namespace

void ServedSession::Alarm::ring() {
  {
    const std::lock_guard lock(mutex);
    rung = true;
  }
  wake.notify_one();
}

void ServedSession::Alarm::wait(double seconds) {
  std::unique_lock lock(mutex);
  wake.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return rung; });
  rung = false;
}

ServedSession::ServedSession(const view::ViewOptions& options,
                             const std::shared_ptr<OpenScene>& scene, std::shared_ptr<Alarm> alarm)
    : alarm_(std::move(alarm)),
      session_(options, scene, [alarm = alarm_] { alarm->ring(); }),
      size_(options.common.render.size.value_or(view::sizeOf(session_.state().scene->scene))),
      loop_([this] { loop(); }) {}

ServedSession::~ServedSession() {
  quit();
  loop_.join();
}

void ServedSession::quit() {
  {
    const std::lock_guard lock(mutex_);
    quit_ = true;
  }
  fresh_.notify_all();
  alarm_->ring();
}

bool ServedSession::post(std::vector<Message> messages) {
  {
    const std::lock_guard lock(mutex_);
    if (messages_.size() + messages.size() > kMostMessages) return false;
    std::move(messages.begin(), messages.end(), std::back_inserter(messages_));
  }
  alarm_->ring();
  return true;
}

std::shared_ptr<const Shot> ServedSession::wait(std::uint64_t number) {
  std::unique_lock lock(mutex_);
  fresh_.wait_for(lock, kWait, [&] { return quit_ || (shot_ && shot_->number > number); });
  return shot_;
}

void ServedSession::watch(int more) {
  {
    const std::lock_guard lock(mutex_);
    pages_ += more;
  }
  alarm_->ring();
}

Download ServedSession::download(bool exr) {
  std::unique_lock lock(mutex_);
  ++downloads_;
  alarm_->ring();

  // The loop hands over the frame as soon as it has one at full resolution.
  const std::shared_ptr<const view::TracedFrame> before = frame_;
  fresh_.wait_for(lock, kDownloadTime, [&] { return quit_ || frame_ != before; });

  // The last download that waits gives the memory of the frame back.
  const std::shared_ptr<const view::TracedFrame> frame = frame_;
  if (--downloads_ == 0) frame_.reset();
  lock.unlock();
  if (frame == before) return {};
  return {frame->scene->scene.name,
          exr ? encodeExr(frame->film.image, frame->metadata, layersOf(frame->film.channels))
              : encodePng(frame->film.display, view::pngMetadata(*frame))};
}

void ServedSession::loop() {
  session_.setWindow(size_, size_.height, 1);
  Stopwatch sinceStep;
  for (;;) {
    alarm_->wait(waitSeconds());

    {
      const std::lock_guard lock(mutex_);
      if (quit_) return;
    }

    const double seconds = std::exchange(sinceStep, Stopwatch()).ms() / 1000;
    try {
      step(seconds);
    } catch (const std::exception& error) {
      session_.fail(error.what());
      changed_ = true;
    }
  }
}

double ServedSession::waitSeconds() const {
  const bool active = !session_.isCommitted() && (session_.isActive() || !session_.state().sharp);
  return active ? 1 / session_.rate() : kIdleSeconds;
}

void ServedSession::step(double seconds) {
  // Messages from other threads are taken over under the lock and served without it.
  std::vector<Message> messages;
  bool watched = false, downloads = false;
  {
    const std::lock_guard lock(mutex_);
    messages.swap(messages_);
    watched = pages_ > 0;
    downloads = downloads_ > 0;
  }

  const view::ViewState& state = session_.state();
  const int errors = state.errors, selections = state.selections;
  changed_ |= session_.fetchFrame();
  for (const Message& message : messages) serve(message);
  said_ |= !messages.empty() || state.errors != errors || state.selections != selections;
  changed_ |= said_;

  // Downloads get the first frame with full resolution and all samples.
  if (downloads) session_.holdStill();
  if (downloads && session_.isComplete()) {
    auto frame = std::make_shared<const view::TracedFrame>(state.shown);
    const std::lock_guard lock(mutex_);
    frame_ = std::move(frame);
    fresh_.notify_all();
  }

  // Where nobody waits for a picture, neither the camera moves nor one is traced.
  if (!watched && !downloads) return;

  session_.limitPixels(mostPixels_);
  session_.advance(seconds);
  if (changed_ || state.sharp != wasSharp_ || session_.notice() != told_) publish();
}

void ServedSession::serve(const Message& message) {
  const auto& n = message.numbers;
  if (message.verb->act) {
    isCameraChosen_ |= message.verb->name == "camera" || message.verb->name == "home";
    session_.act(message);
  } else if (message.verb->name == "size") {
    resize(n[0], n[1], n[2]);
  }
}

void ServedSession::resize(double width, double height, double pixelsForCss) {
  const double shrink = std::sqrt(std::min(kMostWindowPixels / (width * height), 1.0));
  const auto side = [&](double pixels) {
    return std::clamp(static_cast<int>(pixels * shrink), kLeastSide, kLargestSide);
  };
  size_ = {side(width), side(height)};
  session_.setWindow(size_, height / pixelsForCss, 1);
  fitUpright();
}

// Shows all of a model in a page that is narrower than the scene's own picture, as telephones are,
// and undoes that in a wide page. A view that somebody has chosen stays.
void ServedSession::fitUpright() {
  if (isCameraChosen_) return;
  const std::optional<std::size_t> followed = session_.state().followed;
  if (!followed && !(upright_ && sameView(*upright_, session_.camera()))) return;
  const Scene& scene = session_.state().scene->scene;
  const bool narrow = size_.width * scene.height < size_.height * scene.width;

  if (narrow && session_.orbits()) {
    if (followed) uprightFrom_ = *followed;
    session_.act("fit");
    upright_ = session_.camera();
  } else if (!followed) {
    session_.act(concat("camera ", uprightFrom_));
  }
}

// Returns whether the picture shown is at rest, as the one of the command is.
bool ServedSession::rests() const {
  const view::ViewState& state = session_.state();
  return state.shown.request.interruptible || state.sharp;
}

void ServedSession::publish() {
  const view::ViewState& state = session_.state();
  if (!state.shown.scene) return;
  if (rests()) command_ = session_.command();

  // The shot always holds the picture and the values that change with every picture.
  told_ = session_.notice();
  auto shot = std::make_shared<Shot>();
  const std::shared_ptr<const OpenScene> tabled = std::exchange(tabled_, state.scene);
  if (tabled != state.scene) {
    tables_ = std::make_shared<const std::string>(textOf(tablesJson()));
    if (tabled) fitUpright();  // the page tells its size once
  }
  shot->tables = tables_;
  shot->picture = state.unfinished ? state.unfinished->display : state.shown.film.display;
  shot->exact = wasSharp_ = state.sharp;
  shot->live = textOf(liveJson());

  // Settings and the ray tree are written only after an action of the user, when the rays of a
  // pixel come, at rest, and with the first picture of a scene, which may play at once. Pages get
  // them only if they differ from the last ones.
  const std::shared_ptr<const OpenScene> settled = std::exchange(settled_, state.shown.scene);
  const bool said = std::exchange(said_, false) || rests() || settled != settled_;
  changed_ = false;
  const std::shared_ptr<const Shot> before = shot_;  // only this thread writes it
  shot->settled = said || !before ? textOf(settledJson()) : before->settled;

  shot->number = before ? before->number + 1 : 1;
  const bool same = before && before->settled == shot->settled;
  shot->settledNumber = same ? before->settledNumber : shot->number;

  {
    const std::lock_guard lock(mutex_);
    shot_ = std::move(shot);
  }
  fresh_.notify_all();
}

Json ServedSession::tablesJson() const {
  const view::ViewState& state = session_.state();
  const Scene& scene = state.scene->scene;
  Json json{{"scene", scene.name},
            {"presets", view::presetNames()},
            {"views", kDebugViewNames},
            {"path", !scene.cameraPath.empty() && !state.timeline.there}};
  for (const Camera& camera : scene.cameras) json["cameras"].push_back(camera.name);
  if (session_.choosesScene()) json["scenes"] = view::shippedNames();

  for (const view::Control& control : view::controlsOf(state.options)) {
    json["options"].push_back(describe(control));
  }

  // The page lists what it can do, and knows the line of each key.
  for (const view::Verb& verb : view::verbs()) {
    if (verb.keys.empty() || !(verb.act || verb.onPage)) continue;

    json["keys"].push_back({verb.keys, verb.help});
    for (const std::string& key : split(std::string(verb.keys), ' ')) {
      if (const std::string line = view::lineOfKey(key); !line.empty()) json["lines"][key] = line;
    }
  }
  return json;
}

Json ServedSession::liveJson() const {
  // The status line states the sharpness of the picture and, in motion, the frame rate.
  const view::ViewState& state = session_.state();
  const FrameStats& stats = state.shown.stats;
  const view::Timeline& timeline = state.timeline;
  Json json{{"status", view::statusText(state)},
            {"message", told_},
            {"error", state.error},
            {"errors", state.errors},
            {"sharp", state.sharp},
            {"rests", rests()},
            {"window", {size_.width, size_.height}},
            {"ms", stats.frameMs},
            {"embree", stats.embreeMs()}};
  json["closes"] =
      !state.error.empty() || session_.hasPick() || session_.isReading() || session_.choosesScene();
  if (state.followed) json["camera"] = *state.followed;
  if (timeline.there) json["time"] = {timeline.seconds, timeline.length, timeline.playing};

  // The frame's statistics are listed by stage and by kind of ray.
  for (std::size_t i = 0; i < kStageCount; ++i) {
    json["stages"].push_back({kStageNames[i], stats.stageMs(static_cast<Stage>(i))});
  }

  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    const RayTally& tally = stats.meter.tally[i];
    if (!kRayKinds[i].calledForBy(state.shown.effects)) continue;
    json["rays"].push_back({kRayKinds[i].name, static_cast<double>(tally.rays) / 1e3,
                            mraysPerSecond(tally.rays, stats.frameMs), 100 * lanesFilled(tally)});
  }
  if (state.shown.debug) json["legend"] = state.shown.debug->legend();
  if (state.measures) json["measured"] = state.shown.measured;
  if (!state.rays.scene) return json;

  // The rays of the picked pixel become lines in pixels of the page's picture; tenths of a pixel
  // are precise enough.
  const LineView view(state.shown.request.camera, size_.width, size_.height);
  for (const RayLine& line : state.rays.lines) {
    auto seen = view.see(line.from, line.to);
    if (!seen || !clip(*seen, size_.width, size_.height)) continue;

    const auto rounded = [](double x) { return std::round(10 * x) / 10; };
    json["lines"].push_back({rounded(seen->x1), rounded(seen->y1), rounded(seen->x2),
                             rounded(seen->y2), colorOf(line.look), isDashed(line.look),
                             rounded(line.width), line.node});
  }
  return json;
}

Json ServedSession::settledJson() const {
  const view::ViewState& state = session_.state();
  const view::TracedFrame& shown = state.shown;

  // Every page sets its controls by these values.
  Json json{{"command", command_},
            {"view", entryOf(kDebugViewNames, state.view)},
            {"preset", view::presetOf(state.options)}};
  for (const view::Control& control : view::controlsOf(state.options)) {
    json["options"][control.name] = control.value;
  }

  // Each effect has a reason for being on or off. Costs are listed if they exceed the noise.
  for (std::size_t i = 0; i < kEffectNames.size(); ++i) {
    const EffectReason& reason = shown.reasons[i];
    json["effects"].push_back({kEffectNames[i].name, reason.on,
                               !state.options.disable.has(static_cast<Effect>(i)), reason.because});
  }

  for (const view::KnobCost& cost : view::significantCosts(state.costs)) {
    json["costs"].push_back({cost.name, view::costText(cost)});
  }
  json["about"] = view::aboutText(shown);

  if (!state.timeline.animations.empty()) {
    json["animations"] = state.timeline.animations;
    json["animation"] = state.timeline.animation;
  }

  // The ray tree of the picked pixel comes with the colors of its lines.
  const view::RayPick& rays = state.rays;
  if (rays.scene) {
    json["tree"] = pageTree(rays.words, rays.rays, state.options);
    json["tree"]["pixel"] = {rays.query.x, rays.query.y};
    for (const RayLook look : looksOf(rays.lines)) {
      json["tree"]["legend"].push_back({styleOf(look).name, colorOf(look)});
    }
  }
  return json;
}

}  // namespace whit::serve
