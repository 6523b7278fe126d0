// The options of the viewer's command line.
#pragma once

#include <string>

#include "app/parse_options.h"
#include "render/debug_view.h"
#include "viewer/resolution_control.h"

namespace whit::view {

struct ViewOptions {
  cli::CommonOptions common;
  std::string scene;   // as given
  std::string script;  // file; empty: none
  std::string record;  // folder; empty: none
  bool benchmark = false;
  DebugView view = DebugView::none;
  double rate = kDefaultRate;  // frames a second to hold in motion
};

}  // namespace whit::view
