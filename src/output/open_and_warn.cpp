#include "output/open_and_warn.h"

#include <cstdio>

#include "command_line/progress_bar.h"
#include "core/text.h"

namespace whit {

std::unique_ptr<OpenScene> openAndWarn(const std::string& name, const cli::CommonOptions& common,
                                       Progress* progress, const LookAtScene& look) {
  auto open = openScene({name, nullptr}, common.load, common.render.strict, progress, look);
  if (!common.warns) return open;

  cli::printWarnings(open->warnings);
  const std::string dark = noLightWarning(open->scene);
  if (!dark.empty()) std::fprintf(stderr, "whit: warning: %s\n", printable(dark).c_str());

  return open;
}

void printPictureWarnings(const RunSummary& run) {
  for (const std::string& warning : pictureWarnings(run)) {
    std::fprintf(stderr, "whit: warning: %s\n", warning.c_str());
  }
}

void printWrittenFiles(const std::vector<std::string>& files, const cli::CommonOptions& common) {
  if (common.quiet) return;

  std::vector<std::string> names;
  for (const std::string& file : files) {
    if (!file.empty() && file != "-") names.push_back(printable(file));
  }
  if (!names.empty()) std::fprintf(stderr, "wrote %s\n", joined(names).c_str());
}

}  // namespace whit
