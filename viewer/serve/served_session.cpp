#include "viewer/serve/served_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <type_traits>

#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"
#include "io/image/image_layers.h"
#include "output/frame_summary.h"
#include "viewer/session/control.h"

namespace whit::serve {

namespace {

constexpr std::size_t kMostMessages = 4096;
constexpr int kLeastSide = 16, kLargestSide = 4096;
constexpr double kMostWindowPixels = 4e6;
constexpr double kHeldSeconds =
    1;  // keys are let go if the page does not repeat that they are held
constexpr double kIdleSeconds = 0.25, kLongestSeconds = 0.1;
constexpr std::chrono::milliseconds kWait{200};
constexpr std::chrono::seconds kDownloadTime{30};

// Errors of files may hold bytes that are no UTF-8.
std::string textOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

// How the page shows an option; null where it does not.
template <typename Field>
Json describeOption(const OptionSpec& spec, const Field& /*field*/) {
  using Kind = view::Control::Kind;
  const view::Control control = view::describeControl<Field>(spec);
  if (control.kind == Kind::none) return nullptr;

  Json json{{"name", spec.name},
            {"help", spec.help},
            {"tab", spec.tab == Tab::knobs ? "knobs" : "picture"}};

  if (!control.choices.empty()) {
    json["choices"] = control.choices;
    return json;
  }

  json["low"] = control.low;
  json["high"] = control.high;
  if (control.kind == Kind::exposure) {
    json["step"] = 0.25;
  } else {
    json["step"] = control.kind == Kind::integer ? Json(1) : Json("any");
  }
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
    : Session(options, scene, [alarm] { alarm->ring(); }),
      alarm_(std::move(alarm)),
      name_(scene->scene.name),
      tables_(textOf(tablesJson())),
      size_(
          options.common.render.size.value_or(ImageSize{scene->scene.width, scene->scene.height})),
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

std::string ServedSession::download(bool exr) {
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
  if (frame == before) return "";
  return exr ? encodeExr(frame->film.image, frame->metadata, layersOf(frame->film.channels))
             : encodePng(frame->film.display, frame->metadata);
}

void ServedSession::fail(const std::string& error) {
  error_ = error;
  changed_ = said_ = true;
}

void ServedSession::loop() {
  Stopwatch sinceStep;
  for (;;) {
    alarm_->wait(waitSeconds());

    {
      const std::lock_guard lock(mutex_);
      if (quit_) return;
    }

    // Steps are limited in time, so that the camera does not leap after a stall.
    const double seconds = std::exchange(sinceStep, Stopwatch()).ms() / 1000;
    try {
      step(std::min(seconds, kLongestSeconds));
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }
}

double ServedSession::waitSeconds() const {
  const bool active =
      !thread_.committed() && (isActive() || !sharp_ || heldSeconds_ < kHeldSeconds);
  return active ? 1 / resolution_.rate() : kIdleSeconds;
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

  // An error is shown until the user goes on.
  if (!messages.empty()) error_.clear();
  changed_ |= fetchFrame();

  // An error of one message does not keep the others from being served.
  for (const Message& message : messages) {
    try {
      serve(message);
    } catch (const std::exception& error) {
      fail(error.what());
    }
  }

  // Downloads get the first frame with full resolution and all samples.
  if (downloads) holdStill();
  if (downloads && isComplete()) {
    auto frame = std::make_shared<const view::TracedFrame>(shown_);
    const std::lock_guard lock(mutex_);
    frame_ = std::move(frame);
    fresh_.notify_all();
  }

  // Without a page that watches, neither the camera moves nor a picture is traced.
  if (!watched) return;

  heldSeconds_ += seconds;
  if (heldSeconds_ > kHeldSeconds) held_ = view::CameraMotion();
  const view::CameraMotion motion = motionOf(drags_, size_.height / pixelsForCss_, 1, held_);
  drags_ = view::Drags();

  resolution_.setMostPixels(mostPixels_);
  advance(motion, seconds);
  if (changed_ || sharp_ != wasSharp_ || notice() != told_) publish();
}

void ServedSession::serve(const Message& message) {
  const auto& n = message.numbers;
  const std::string& text = message.text;

  const auto drag = [&](view::Drag& sum) {
    sum.x += n[0];
    sum.y += n[1];
    if (sum.any()) pathTime_.reset();
  };

  const auto change = [&](auto&& make) {
    RenderOptions next = settings_.options;  // stays if the change is an error
    make(next);
    settings_.options = next;
    restSeconds_ = 0;
  };

  const std::map<std::string_view, std::function<void()>> acts{
      {"size", [&] { resize(n[0], n[1], n[2]); }},
      {"left", [&] { drag(drags_.left); }},
      {"middle", [&] { drag(drags_.middle); }},
      {"right", [&] { drag(drags_.right); }},
      {"wheel", [&] { drags_.wheel += n[0]; }},
      {"hold",
       [&] {
         held_ = {.forward = n[0],
                  .right = n[1],
                  .up = n[2],
                  .fast = n[5] > 0,
                  .turnRight = n[3],
                  .turnUp = n[4]};
         heldSeconds_ = 0;
         if (n[0] != 0 || n[1] != 0 || n[2] != 0) pathTime_.reset();
       }},
      {"click",
       [&] {
         pick(std::min(static_cast<int>(n[0]), size_.width - 1),
              std::min(static_cast<int>(n[1]), size_.height - 1));
       }},
      {"camera", [&] { jumpToNumber(static_cast<std::size_t>(n[0])); }},
      {"fit", [&] { fitView(size_); }},
      {"aside", [&] { settings_.rays.fromAside = true; }},
      {"forget", [&] { settings_.rays.forget = true; }},
      {"reload", [&] { reload(); }},
      {"play", [&] { playOrPause(); }},
      {"time", [&] { setTime(n[0]); }},
      {"animation", [&] { chooseAnimation(text); }},
      {"expose", [&] { expose(static_cast<float>(n[0])); }},
      {"measure", [&] { settings_.measureKnobs = !settings_.measureKnobs; }},
      {"view",
       [&] { change([&](auto&) { parseValue(view::kViewOption, text, settings_.view); }); }},
      {"preset",
       [&] {
         change([&](RenderOptions& next) {
           setOption(next, "quality", text);
           applyQuality(next, {"mode"});  // the reference is too slow here
         });
       }},
      {"effect",
       [&] {
         change([&](RenderOptions& next) {
           parseEffects(message.name).forEach([&](Effect effect) {
             next.disable = n[0] > 0 ? next.disable.without(effect) : next.disable.with(effect);
           });
         });
       }},
      {"set", [&] {
         change([&](RenderOptions& next) {
           bool known = false;
           forEachOption(next, [&](const OptionSpec& spec, const auto&) {
             known |= spec.tab != Tab::none && spec.name == message.name;
           });

           if (!known) throwUsage("the page has no option '" + message.name + "'");
           setOption(next, message.name, text);
         });
       }}};

  changed_ = said_ = true;
  acts.at(message.verb)();
}

void ServedSession::resize(double width, double height, double pixelsForCss) {
  const double shrink = std::sqrt(std::min(kMostWindowPixels / (width * height), 1.0));
  const auto side = [&](double pixels) {
    return std::clamp(static_cast<int>(pixels * shrink), kLeastSide, kLargestSide);
  };
  size_ = {side(width), side(height)};
  pixelsForCss_ = pixelsForCss;
}

void ServedSession::setTime(double seconds) {
  if (!settings_.timeline.there) throwUsage("nothing moves in this scene");
  settings_.timeline.seconds = std::min(seconds, settings_.timeline.length);
  settings_.timeline.playing = false;
  restSeconds_ = 0;
  followCamera();
}

void ServedSession::chooseAnimation(const std::string& name) {
  view::Timeline& timeline = settings_.timeline;
  if (std::ranges::find(timeline.animations, name) == timeline.animations.end()) {
    throwUsage("no animation is called '" + name + "'");
  }
  timeline.animation = name;
  changeAnimation();
}

void ServedSession::publish() {
  if (!shown_.scene) return;
  if (shown_.request.interruptible || sharp_) command_ = command(viewOptions());

  // The shot always holds the picture and the values that change with every picture.
  told_ = notice();
  auto shot = std::make_shared<Shot>();
  shot->picture = unfinished_ ? unfinished_->display : shown_.film.display;
  shot->exact = wasSharp_ = sharp_;
  shot->live = textOf(liveJson());

  // Settings and the ray tree are written only after an action of the user or at rest. Pages get
  // them only if they differ from the last ones.
  const bool said = std::exchange(said_, false) || shown_.request.interruptible || sharp_;
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
  Json json{{"scene", scene().name},
            {"options", Json::array()},
            {"presets", {"good", "standard", "reference"}},
            {"views", Json::array()}};

  for (const Camera& camera : scene().cameras) json["cameras"].push_back(camera.name);
  json["path"] = !scene().cameraPath.empty() && !settings_.timeline.there;
  for (const char* name : kDebugViewNames) json["views"].push_back(name);

  forEachOption(settings_.options, [&](const OptionSpec& spec, const auto& field) {
    if (spec.tab == Tab::none) return;
    if (Json option = describeOption(spec, field); !option.is_null())
      json["options"].push_back(option);
  });
  return json;
}

Json ServedSession::liveJson() const {
  // The status line states the sharpness of the picture and, in motion, the frame rate.
  const FrameStats& stats = shown_.stats;
  std::string status = unfinished_
                           ? samplesText(*unfinished_)
                           : sharpnessText(shown_.request) + view::errorText(shown_.sampleError);
  if (pictureMs_ > 0) status += formatted(", %.0f frames/s", 1000 / pictureMs_);

  const view::Timeline& timeline = settings_.timeline;
  Json json{{"status", status},
            {"message", told_},
            {"error", error_},
            {"sharp", sharp_},
            {"window", {size_.width, size_.height}},
            {"ms", stats.frameMs},
            {"embree", stats.embreeMs()}};
  if (timeline.there) json["time"] = {timeline.seconds, timeline.length, timeline.playing};

  // The frame's statistics are listed by stage and by kind of ray.
  for (std::size_t i = 0; i < kStageCount; ++i) {
    json["stages"].push_back({kStageNames[i], stats.stageMs(static_cast<Stage>(i))});
  }

  for (std::size_t i = 0; i < kRayKindCount; ++i) {
    const RayTally& tally = stats.meter.tally[i];
    if (!kRayKinds[i].calledForBy(shown_.effects)) continue;
    json["rays"].push_back({kRayKinds[i].name, static_cast<double>(tally.rays) / 1e3,
                            mraysPerSecond(tally.rays, stats.frameMs), 100 * lanesFilled(tally)});
  }
  if (shown_.debug) json["legend"] = shown_.debug->legend();
  if (settings_.measureKnobs) json["measured"] = shown_.measured;
  if (!rays_.scene) return json;

  // The rays of the picked pixel become lines in pixels of the page's picture; tenths of a pixel
  // are precise enough.
  const LineView view(shown_.request.camera, size_.width, size_.height);
  for (const RayLine& line : rays_.lines) {
    auto seen = view.see(line.from, line.to);
    if (!seen || !view::clip(*seen, size_.width, size_.height)) continue;

    const auto rounded = [](double x) { return std::round(10 * x) / 10; };
    json["lines"].push_back({rounded(seen->x1), rounded(seen->y1), rounded(seen->x2),
                             rounded(seen->y2), colorOf(line.look), isDashed(line.look),
                             rounded(line.width), line.node});
  }
  return json;
}

Json ServedSession::settledJson() const {
  // Every page sets its controls by these values.
  Json json{{"command", command_},
            {"view", kDebugViewNames[static_cast<std::size_t>(settings_.view)]},
            {"options", Json::object()}};

  forEachOption(settings_.options, [&](const OptionSpec& spec, const auto& field) {
    if (spec.tab != Tab::none) json["options"][std::string(spec.name)] = formatValue(spec, field);
  });

  // Each effect has a reason for being on or off. Costs are listed if they exceed the noise.
  for (std::size_t i = 0; i < kEffectNames.size(); ++i) {
    const EffectReason& reason = shown_.reasons[i];
    json["effects"].push_back({kEffectNames[i].name, reason.on,
                               !settings_.options.disable.has(static_cast<Effect>(i)),
                               reason.because});
  }

  for (const view::KnobCost& cost : view::toldFromNoise(costs_)) {
    json["costs"].push_back({cost.name, view::costText(cost)});
  }
  json["about"] = formatted("%s, %s; %s, packets of %d, %d threads", scene().name.c_str(),
                            shown_.surfaces.c_str(), shown_.machine.simd.c_str(),
                            shown_.machine.packet, shown_.machine.threads);

  if (!settings_.timeline.animations.empty()) {
    json["animations"] = settings_.timeline.animations;
    json["animation"] = settings_.timeline.animation;
  }

  // The ray tree of the picked pixel comes with the colors of its lines.
  if (rays_.scene) {
    json["tree"] = pageTree(rays_.words, rays_.rays, settings_.options);
    json["tree"]["pixel"] = {rays_.query.x, rays_.query.y};
    for (const RayLook look : looksOf(rays_.lines)) {
      json["tree"]["legend"].push_back({styleOf(look).name, colorOf(look)});
    }
  }
  return json;
}

}  // namespace whit::serve
