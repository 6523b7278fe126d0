// What keys, mouse and the panel do.
#include <cstdio>
#include <functional>
#include <map>
#include <string_view>

#include "core/text.h"
#include "io/files.h"
#include "viewer/app.h"
#include "viewer/session/verbs.h"

namespace whit::view {

namespace {

// Standard output gets the commands of pictures at once.
void printLine(const std::string& text) {
  std::printf("%s\n", text.c_str());
  std::fflush(stdout);
}

}  // namespace

void App::handleInput() {
  Input& input = window_.input;
  const auto clicked = window_.takeClick();
  if (hints_ && (clicked || !input.pressed.empty())) {
    hints_ = false;
    session_.say("");
  }

  move(input);
  const bool hasScene = !session_.choosesScene();
  for (const std::string& key : input.pressed) {
    // Before there is a scene, no other keys have anything to do.
    if (hasScene || key == "Esc" || key == "F11") act(lineOfKey(key));
  }
  if (clicked && hasScene) click(*clicked);
  if (!input.dropped.empty()) act("open " + input.dropped.front());
}

// Passes drags, the wheel and held keys on to the session.
void App::move(const Input& input) {
  for (const auto& [verb, drag] :
       {std::pair{"left", input.left}, {"middle", input.middle}, {"right", input.right}}) {
    if (drag.any()) act(formatted("%s %.17g %.17g", verb, drag.x, drag.y));
  }
  if (input.wheel != 0) act(formatted("wheel %.17g", input.wheel));

  // Keys that are held are told again and again, and that they were let go is told once.
  if (std::exchange(isHeld_, !input.held.empty()) || isHeld_) {
    // A pair of opposite keys gives -1, 0 or 1.
    const auto axis = [&](const char* positive, const char* negative) {
      return static_cast<int>(input.isHeld(positive)) - static_cast<int>(input.isHeld(negative));
    };
    act(formatted("hold %d %d %d %d %d %d", axis("W", "S"), axis("D", "A"), axis("E", "Q"),
                  axis("Right", "Left"), axis("Up", "Down"), axis("Shift", "")));
  }
}

// Carries out a line. The window's own verbs are those that the table of verbs leaves to it. Errors
// are shown.
void App::act(const std::string& line) try {
  const std::size_t end = line.find(' ');
  const std::string verb = line.substr(0, end);
  const std::string rest = end == std::string::npos ? "" : line.substr(end + 1);

  const std::map<std::string_view, std::function<void()>> own{
      {"cameras", [&] { toggle(Over::cameras); }},
      {"keys", [&] { toggle(Over::keys); }},
      {"panel", [&] { toggle(Over::panel); }},
      {"lines", [&] { shown_.lines = !shown_.lines; }},
      {"save-scene", [&] { saveScene(); }},
      {"save-picture", [&] { savePicture(); }},
      {"copy", [&] { copyCommand(); }},
      {"open", [&] { open(rest); }},
      {"full-screen", [&] { window_.toggleFullScreen(); }},
      {"close", [&] { close(); }}};

  const auto found = own.find(verb);
  if (found == own.end()) {
    session_.act(line);
  } else {
    found->second();
  }
} catch (const std::exception& error) {
  session_.fail(error.what());
}

// Opens what is not open, and closes what is.
void App::toggle(Over over) { shown_.over = shown_.over == over ? Over::nothing : over; }

void App::close() {
  if (session_.close()) return;

  if (std::exchange(savesPicture_, false)) {
    session_.say("the picture will not be saved");
  } else if (shown_.over != Over::nothing && !session_.choosesScene()) {
    shown_.over = Over::nothing;
  } else if (session_.hasPick()) {
    session_.act("forget");
  } else if (window_.isFullScreen()) {
    window_.toggleFullScreen();
  } else {
    window_.setClosing(true);
  }
}

// Warns once before edits are lost, and again after further edits. `howToLose` says what the user
// does to go on without them.
bool App::mayLoseEdits(const char* howToLose) {
  const std::vector<std::string>& settings = session_.state().edited.settings;
  if (!session_.hasUnsavedEdits() || settings == warnedOf_) return true;

  warnedOf_ = settings;
  session_.say(formatted(
      "the scene has unsaved edits: press Ctrl+S to save them, or %s to lose them", howToLose));
  return false;
}

// Saves the picture, or says that it will be saved when it is complete.
void App::savePicture() {
  savesPicture_ = !session_.isComplete();
  if (savesPicture_) {
    session_.holdStill();
    session_.say(
        "the picture will be saved when it has full resolution and all samples; press Esc to "
        "cancel");
    return;
  }

  const TracedFrame& frame = session_.state().shown;
  const std::string files = view::savePicture(frame);
  printLine(session_.command());

  const Image& image = frame.film.image;
  const int spp = frame.request.spp;
  session_.say(formatted("saved %s, %d x %d, %d %s a pixel", files.c_str(), image.width,
                         image.height, spp, spp == 1 ? "sample" : "samples"));
}

void App::copyCommand() {
  const std::string command = session_.command();
  if (command.empty()) return;

  printLine(command);
  window_.setClipboard(command);
  session_.say("the command that makes this picture was printed and copied to the clipboard");
}

void App::saveScene() {
  if (!session_.showsScene()) return;

  const SavedScene saved = session_.saveScene();
  printLine(saved.command);
  session_.say("saved the scene as " + saved.file + "; the command that renders it was printed" +
               (saved.leavesGround ? "; the shadow on the ground was left out" : ""));
}

void App::click(const Input::Click& place) {
  const auto [x, y] = window_.pixelAt(place);
  act(formatted("click %d %d", x, y));

  // The scene's tab stays, because it shows the material and the light of the pixel.
  const bool stays = shown_.over == Over::panel && shown_.tab == "scene";
  if (!stays) shown_.tab = "rays";
  shown_.over = Over::panel;
  shown_.lines = true;
  panel_.keepClear(place.x, place.y);
}

// Opens a scene, or shows an image as the sky.
void App::open(const std::string& file) {
  const std::string extension = extensionOf(file);
  const bool isSky = extension == ".hdr" || extension == ".exr";
  if (!isSky || session_.choosesScene()) {
    if (!mayLoseEdits("drop the file again")) return;
    savesPicture_ = false;  // a picture of the scene before is not completed any more
    session_.open(file);
    return;
  }

  EditedScene edited = session_.state().edited;
  edited.sky = skyFrom(file);
  std::vector<std::string> settings;
  addSkySetting(edited, settings);
  session_.edit(settings, edited);
  session_.say("sky: " + file);
}

}  // namespace whit::view
