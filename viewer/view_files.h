// The files that the viewer writes and reads, and the commands that make a picture again.
#pragma once

#include <string>

#include "viewer/frame_tracer.h"

namespace whit::view {

// Returns the command "whit render SCENE -o NAME.png ..." that makes a picture of the frame's scene
// and view with these options, bit for bit. It only states what differs from the scene's defaults.
// Words are quoted for a POSIX shell where needed.
std::string renderCommand(const std::string& scene, const cli::CommonOptions& common,
                          const TracedFrame& frame, RenderOptions options);

struct SavedScene {
  std::string file;
  std::string command;  // renders the scene with its view
};

// Writes NAME-edited.json, with the first number that is free, into the current folder. It is the
// file of the scene called `name` with its settings and edits, or a scene that holds the model
// called `name`; its first camera is `camera`. `load` holds the options that the scene was read
// with, and `options` are those of the command. Throws Error(io), and writes nothing then.
SavedScene saveScene(const LoadOptions& load, const std::string& name, const cli::OpenScene& scene,
                     const ShadingEdit& edit, const Camera& camera, RenderOptions options);

// Writes NAME-NNNN.png, .exr and .json (the camera, and the command that makes the picture) into
// the current folder, with the first number that is free; returns "NAME-NNNN". Throws Error(io).
std::string savePicture(const TracedFrame& frame, const std::string& command);

// Writes a camera as scene files have it, and "command" unless that is empty.
void writeCamera(const std::string& file, const Camera& camera, const std::string& command = "");
// Throws Error(io) when the file cannot be read, and Error(badScene) with the place and the
// expectation.
Camera readCamera(const std::string& file);

}  // namespace whit::view
