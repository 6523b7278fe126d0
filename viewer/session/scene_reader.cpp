#include "viewer/session/scene_reader.h"

#include <chrono>
#include <utility>

#include "output/open_and_warn.h"

namespace whit::view {

std::unique_ptr<Engine> readScene(const SceneChoice& choice, cli::CommonOptions common,
                                  Progress* progress) {
  common.load.settings = choice.settings;
  common.load.instant.animation = choice.animation;
  if (!choice.isFirst) {
    common.load.camera.clear();
    common.load.instant.seconds.reset();
  }
  if (choice.sky) {
    common.load.sky = *choice.sky;
    common.load.allowOutside = true;  // the user chose the file of the sky
  }

  auto engine = std::make_unique<Engine>(openAndWarn(choice.name, common, progress));
  if (choice.options) {
    engine->setOptions(*choice.options);
  } else {
    engine->setOptions(common.render, common.given);
  }
  engine->prepare(progress);
  return engine;
}

void SceneReader::read(const SceneChoice& choice) {
  giveUp();
  text_ = "reading " + choice.name;
  progress_ = std::make_shared<LatestProgress>();

  // Two scenes are never read at the same time: together they may need too much memory.
  const auto work = [choice, common = common_, progress = progress_,
                     before = reading_.share()]() mutable {
    if (before.valid()) before.wait();
    before = {};
    return readScene(choice, common, progress.get());
  };
  reading_ = std::async(std::launch::async, work);
}

void SceneReader::giveUp() {
  if (progress_) progress_->givenUp = true;
}

std::unique_ptr<Engine> SceneReader::take() {
  if (!holds() || reading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    return nullptr;
  }

  // A scene that was read just before it was given up would stay in memory.
  if (progress_->givenUp) {
    reading_ = {};
    return nullptr;
  }
  return reading_.get();
}

}  // namespace whit::view
