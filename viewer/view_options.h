// What the viewer is told on its command line.
#pragma once

#include <string>

#include "cli/parse_options.h"
#include "viewer/resolution_control.h"

namespace whit::view {

struct ViewOptions {
  cli::CommonOptions common;
  std::string scene;   // as given
  std::string script;  // file; empty: none
  std::string record;  // folder; empty: none
  bool benchmark = false;
  double rate = kDefaultRate;  // frames a second to hold in motion
};

}  // namespace whit::view
