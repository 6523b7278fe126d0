#include "viewer/session/view_options.h"

#include "core/error.h"

namespace whit::view {

void listViewOptions(cli::OptionList& list, ViewOptions& options) {
  list.value({"rate", "N", kLeastRate, kLargestRate},
             "frames a second to hold while something moves (default: 60, on up to four cores 30)",
             options.rate);
  list.value(kViewOption, "what to show instead of the picture", options.view);
  cli::listCommonOptions(list, options.common);
}

void settleViewOptions(ViewOptions& options) {
  if (options.common.given.contains("crop")) {
    throwUsage("--crop: the viewer shows whole images; use whit render");
  }
  if (options.common.render.mode == Mode::reference) {
    throwUsage("--mode reference is too slow to look around with; use whit render");
  }
  options.common.load.instant.plays = true;
}

}  // namespace whit::view
