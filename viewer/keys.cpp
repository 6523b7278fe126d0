#include "viewer/keys.h"

namespace whit::view {

namespace {

constexpr KeyHelp kHelp[] = {{"W A S D, Q E", "fly; down and up"},
                             {"Shift", "four times as fast"},
                             {"wheel", "speed"},
                             {"left drag, arrows", "look around"},
                             {"right drag", "orbit"},
                             {"click; T", "the rays of that pixel; their lines, or not"},
                             {"I", "what the pixel under the pointer holds, or not"},
                             {"1 ... 9", "cameras of the scene"},
                             {"Space", "fly the camera path"},
                             {"P", "play or pause what moves"},
                             {"+ -", "finer, coarser pixels"},
                             {"[ ]", "exposure"},
                             {"F", "full screen"},
                             {"H", "this panel"},
                             {"V", "depth, normals and other views"},
                             {"N", "more samples at rest, or not"},
                             {"M", "measure what each knob and effect costs"},
                             {"X", "against the reference; drag the line"},
                             {"C", "print and copy the view as whit render makes it"},
                             {"F12", "save PNG, EXR, camera and command"},
                             {"F5 F9", "save, restore the camera"},
                             {"R", "reload the scene"},
                             {"Ctrl+S", "save what was edited as a scene file"},
                             {"drop a file", "open it; an HDR or EXR image as the sky"},
                             {"Esc", "quit"}};

}  // namespace

std::span<const KeyHelp> keyHelp() { return kHelp; }

}  // namespace whit::view
