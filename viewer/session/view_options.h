// The options that the command lines of the window and of the page have in common.
#pragma once

#include <string>

#include "command_line/parse_options.h"
#include "core/machine_limits.h"
#include "inspect/debug_view.h"
#include "viewer/session/resolution_control.h"

namespace whit::view {

struct ViewOptions {
  cli::CommonOptions common;
  std::string scene;  // as on the command line
  DebugView view = DebugView::none;
  double rate = defaultRate(usableThreads());  // frames a second to hold in motion
};
void listViewOptions(cli::OptionList& list, ViewOptions& options);
inline constexpr OptionSpec kViewOption{.name = "view",
                                        .words =
                                            "none|depth|normals|albedo|rays|cost|occupancy|"
                                            "reference|difference"};
// Throws Error(usage) for options that a viewer cannot follow; the scene plays if it moves.
void settleViewOptions(ViewOptions& options);

}  // namespace whit::view
