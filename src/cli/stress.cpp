// whit stress: the catalogue of hard cases on this machine and build.
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/app/image_output.h"
#include "cli/app/interrupt.h"
#include "cli/app/parse_options.h"
#include "cli/app/progress_bar.h"
#include "cli/commands.h"
#include "cli/stress_report.h"
#include "core/display.h"
#include "core/error.h"
#include "core/nearest_name.h"
#include "core/progress.h"
#include "io/atomic_file.h"
#include "io/image/image_file.h"
#include "io/load_scene.h"
#include "io/paths.h"
#include "stress/probe.h"

namespace whit::cli {

namespace {

constexpr int kWidth = 320, kHeight = 240, kColumns = 4, kSheetGap = 4;

Image pictureOf(const std::string& scene) {
  Warnings warnings;
  const Scene loaded = Scene::finalize(loadScene(scene, LoadOptions{}, warnings), warnings);
  RenderOptions options;
  options.size = ImageSize{kWidth, kHeight};
  options.depth = 16;
  options.spp = 1;
  return stress::pictureOf(loaded, loaded.cameras.front(), options);
}

// Each scene of scenes/hard at 320x240, in order of their names. Throws Error(io) when there is
// none.
std::vector<StressPicture> hardPictures(Progress* progress) {
  const std::vector<std::filesystem::path> scenes = hardScenes();
  if (scenes.empty()) throwIo("no scenes of hard cases found; is $WHIT_SCENES set?");
  std::vector<StressPicture> pictures;
  for (const std::filesystem::path& scene : scenes) {
    const std::string name = scene.stem().string();
    reportProgress(progress, name,
                   static_cast<double>(pictures.size()) / static_cast<double>(scenes.size()));
    pictures.push_back({name, pictureOf(scene.string())});
  }
  return pictures;
}

// Side by side, four a row.
void writeStressSheet(const std::string& path, const std::vector<StressPicture>& pictures) {
  const int count = static_cast<int>(pictures.size());
  const int columns = std::min(count, kColumns), rows = (count + kColumns - 1) / kColumns;
  Image sheet(columns * (kWidth + kSheetGap) + kSheetGap, rows * (kHeight + kSheetGap) + kSheetGap);
  for (int i = 0; i < count; ++i) {
    const Image& picture = pictures[static_cast<std::size_t>(i)].image;
    const int left = kSheetGap + i % kColumns * (kWidth + kSheetGap);
    const int top = kSheetGap + i / kColumns * (kHeight + kSheetGap);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) sheet.at(left + x, top + y) = picture.at(x, y);
    }
  }
  const WriteScope scope;
  writePng(path, toDisplay(sheet, 0, ToneCurve::none), {});
}

constexpr const char* kStressUsage = "whit stress [options]";
constexpr const char* kStressSummary =
    "Runs the catalogue of hard cases with every SIMD target and packet width of this machine.\n"
    "Exit status 1 when a bound is broken.";

struct StressJob {
  CommonOptions common;
  std::vector<std::string> only, operands;
  std::string json, html, sheet;
};

std::vector<std::string> namesOf(const std::vector<std::string>& lists) {
  std::vector<std::string> names, known;
  for (const stress::Family& family : stress::families()) {
    for (const stress::Case& c : family.cases) known.emplace_back(c.name);
  }
  for (const std::string& list : lists) {
    std::istringstream words(list);
    for (std::string name; std::getline(words, name, ',');) {
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        throwUsage("there is no case '" + name + "'; nearest: '" + nearestName(name, known) + "'");
      }
      names.push_back(name);
    }
  }
  return names;
}

Machine thisMachine() {
  Warnings warnings;
  const Scene nothing = Scene::finalize({}, warnings);
  return Renderer(nothing, RenderOptions{}).machine();
}

}  // namespace

int stressCommand(const Words& words) {
  StressJob job;
  OptionList list;
  list.group("Running");
  list.many({"only", "H1,H2a"}, "these cases; may be given more than once", job.only);
  list.value({"json", "FILE"}, "all runs for machines; - is standard output", job.json);
  list.value({"html", "FILE.html"},
             "the table as a page, with pictures of the scenes in scenes/hard", job.html);
  list.value({"sheet", "FILE.png"}, "instead, pictures of the scenes in scenes/hard on one sheet",
             job.sheet);
  listReportOptions(list, job.common);
  list.operands("Cases", "tests/README.md has the list", 0, 0, job.operands);
  if (parseOptions(kStressUsage, kStressSummary, list, words) == Parsed::helpShown) return 0;
  requireJsonWritable(job.json);
  if (!job.html.empty()) requireWritable(job.html, {".html"});
  if (!job.sheet.empty()) requireWritable(job.sheet, {".png"});
  const std::vector<std::string> only = namesOf(job.only);
  auto progress = makeProgressBar(job.common);
  if (!job.sheet.empty()) {
    const std::vector<StressPicture> pictures = hardPictures(progress.get());
    progress.reset();
    writeStressSheet(job.sheet, pictures);
    for (const StressPicture& picture : pictures) std::printf("%s\n", picture.name.c_str());
    return 0;
  }
  const std::vector<StressRow> rows = runCatalogue(only, progress.get());
  std::vector<StressPicture> pictures;
  if (!job.html.empty()) pictures = hardPictures(progress.get());
  progress.reset();
  FILE* const people = job.json == "-" ? stderr : stdout;
  if (people == stdout || !job.common.quiet) std::fprintf(people, "%s", stressTable(rows).c_str());
  const Machine machine = thisMachine();
  if (!job.json.empty()) writeJson(job.json, stressJson(machine, rows));
  if (!job.html.empty()) {
    const WriteScope scope;
    writeTextFile(job.html, stressHtml(machine, rows, pictures));
  }
  const bool allHold = std::all_of(rows.begin(), rows.end(),
                                   [](const StressRow& row) { return row.finding.holds(); });
  return static_cast<int>(allHold ? ExitStatus::done : ExitStatus::checkFailed);
}

}  // namespace whit::cli
