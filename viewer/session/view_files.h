// The files that the viewer writes and reads, and the commands that make a picture again.
#pragma once

#include <string>

#include "viewer/session/frame_tracer.h"

namespace whit::view {

// Returns the command "whit render SCENE -o NAME.png ..." that makes a picture of the frame's scene
// and view with these options, bit for bit; for a debug view "whit-view SCENE --view=NAME ...". It
// only states what differs from the scene's defaults. Words are quoted for a POSIX shell where
// needed.
std::string viewCommand(const std::string& scene, const cli::CommonOptions& common,
                        const TracedFrame& frame, RenderOptions options);

struct SavedScene {
  std::string file;
  std::string command;        // renders the scene with its view
  bool leavesGround = false;  // the shadow on the ground is left out: a scene file cannot hold it
};

// Writes NAME-edited.json, with the first number that is free, into the current folder. It is the
// file of the scene called `name` with the settings of the frame, or a scene that holds the model
// called `name`; its first camera is `camera`, and it states the options `chosen`. `load` holds the
// options that the scene was read with, and `options` are those of the command. Throws Error(io),
// and writes nothing then.
SavedScene saveScene(const LoadOptions& load, const std::string& name, const TracedFrame& frame,
                     const Camera& camera, RenderOptions options, const RenderOptions& chosen);

// Returns the metadata of the PNG, which also name the debug view that it shows.
ImageMetadata pngMetadata(const TracedFrame& frame);

// Writes NAME-NNNN.png and .exr into the current folder, with the first number that is free; of a
// debug view NAME-VIEW-NNNN.png, and of the reference the EXR as well. Returns
// "NAME-NNNN.png and .exr". Throws Error(io).
std::string savePicture(const TracedFrame& frame);

// Settings that stay from one run to the next, in whit/viewer.json below $XDG_CONFIG_HOME.
struct KeptSettings {
  bool panel = false;               // the panel is shown
  std::string tab = "picture";      // the panel's tab
  ImageSize window;                 // zero: the user has not changed it
  std::vector<std::string> recent;  // names of scenes, the last one first
};
// Returns the default settings where there is no file, or none that can be read.
KeptSettings readKeptSettings();
// Reports a failure on standard error.
void writeKeptSettings(const KeptSettings& kept);
// Moves a scene to the front of the list. A file is listed by its absolute path.
void rememberRecent(const std::string& scene, std::vector<std::string>& recent);

}  // namespace whit::view
