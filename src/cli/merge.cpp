// whit merge: crops of one image, put together.
#include "io/image/image_layers.h"

#include "cli/commands.h"
#include "command_line/program.h"
#include "command_line/progress_bar.h"
#include "output/image_output.h"
#include "output/open_and_warn.h"

namespace whit::cli {

int mergeCommand(const Words& words) {
  CommonOptions common;
  std::vector<std::string> files;
  OptionList list;
  list.group("Merging");
  list.flag("strict", "crops that disagree where they overlap are an error", common.render.strict);
  listReportOptions(list, common);
  list.operands("OUT.exr PART.exr...", "the image to write, and the crops it is made of", 2,
                OptionList::kAnyNumber, files);

  if (!parseOptions(
          "whit merge OUT.exr PART.exr... [options]",
          "Merges crops of one image, with their channels, which all crops must have. The "
          "crops must cover the image; where they overlap the later one counts. EXR crops that "
          "whit made must show one scene with the same options.",
          list, words)) {
    return 0;
  }

  // The first file is written, and the others are read.
  requireWritable(files[0], {".exr"});
  const Words parts(files.begin() + 1, files.end());
  requireSeparateFiles({files[0]}, common, {}, parts);
  Warnings warnings(common.render.strict);
  const MergedImage merged = mergeImages(parts, ImageLimits(), warnings);
  printWarnings(warnings);

  const WriteScope scope;
  writeExr(files[0], merged.image, merged.metadata, ExrStorage::zip, 1, merged.layers);
  printWrittenFiles({files[0]}, common);
  return 0;
}

}  // namespace whit::cli
