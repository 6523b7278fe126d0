// whit-verify: runs the catalogue of hard cases on this machine and reports how close each case
// comes to its bound, as a table, as JSON and as an HTML page.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "command_line/parse_options.h"
#include "command_line/program.h"
#include "command_line/progress_bar.h"
#include "core/display.h"
#include "core/error.h"
#include "core/text.h"
#include "io/files.h"
#include "io/image/image_file.h"
#include "io/load_scene.h"
#include "output/image_output.h"
#include "output/json_report.h"
#include "output/report_page.h"
#include "simd/kernels.h"
#include "verify/image_hashes.h"
#include "verify/probe.h"

namespace whit::verify {

namespace {

// One run of a case.
struct Row {
  std::string_view family;
  const Case* hardCase = nullptr;
  Setup setup;
  Finding finding;

  // A case without a bound cannot be broken.
  bool isReportedOnly() const { return std::isinf(finding.bound()); }
  std::string result() const {
    if (!finding.holds()) return "BROKEN";
    return isReportedOnly() ? "reported" : "yes";
  }
  std::string packet() const { return setup.packet == 0 ? "auto" : std::to_string(setup.packet); }
};

// Runs the cases with these names, or all cases if there are no names, in every setup of this
// machine that each case runs with.
std::vector<Row> runCatalogue(const std::vector<std::string>& only, Progress* progress) {
  std::vector<Row> rows;
  const std::vector<Family>& catalogue = families();
  std::size_t count = 0, done = 0;
  for (const Family& family : catalogue) count += family.cases.size();

  for (const Family& family : catalogue) {
    for (const Case& c : family.cases) {
      reportProgress(progress, std::string(c.name), double(done++) / double(count));
      if (!only.empty() && !contains(only, c.name)) continue;
      for (const Setup& setup : setupsOf(c.runs)) {
        rows.push_back({family.name, &c, setup, runCase(c, setup)});
      }
    }
  }
  return rows;
}

// Returns for each case the run that came closest to its bound, in the order of the catalogue.
std::vector<Row> worstRows(const std::vector<Row>& rows) {
  const auto isWorse = [](const Finding& a, const Finding& b) {
    return a.holds() != b.holds() ? !a.holds() : a.worst() > b.worst();
  };

  std::vector<Row> worst;
  for (const Row& row : rows) {
    if (worst.empty() || worst.back().hardCase != row.hardCase) {
      worst.push_back(row);
    } else if (isWorse(row.finding, worst.back().finding)) {
      worst.back() = row;
    }
  }
  return worst;
}

std::string numberText(double value) { return std::isinf(value) ? "-" : formatted("%.4g", value); }

// "205 cases in 3075 runs: 199 hold, 0 broken, 6 reported without a bound".
std::string summaryOf(const std::vector<Row>& rows) {
  const std::vector<Row> worst = worstRows(rows);
  const auto count = [&](const std::string& result) {
    return std::ranges::count(worst, result, &Row::result);
  };
  const auto reported = count("reported");

  std::string text = formatted("%zu cases in %zu runs: %td hold, %td broken", worst.size(),
                               rows.size(), count("yes"), count("BROKEN"));
  if (reported > 0) text += formatted(", %td reported without a bound", reported);
  return text;
}

std::string tableOf(const std::vector<Row>& rows) {
  std::string text = "case   worst       bound       holds     simd   packet  what must hold\n";
  for (const Row& row : worstRows(rows)) {
    text += formatted("%-6s %-11s %-11s %-9s %-6s %-7s %s\n", row.hardCase->name.data(),
                      numberText(row.finding.worst()).c_str(),
                      numberText(row.finding.bound()).c_str(), row.result().c_str(),
                      row.setup.simd.c_str(), row.packet().c_str(), row.hardCase->title.data());
    if (!row.finding.holds()) text += "       input: " + row.finding.input() + "\n";
  }
  return text + summaryOf(rows) + "\n";
}

// Contains every run. `bound` and `margin` (bound less worst) are null for a case that is only
// reported.
Json jsonOf(const Machine& machine, const std::vector<Row>& rows) {
  Json cases = Json::array();
  for (const Row& row : rows) {
    const double worst = row.finding.worst(), bound = row.finding.bound();
    const auto finite = [](double x) { return std::isfinite(x) ? Json(x) : Json(); };
    cases.push_back({{"case", row.hardCase->name},
                     {"title", row.hardCase->title},
                     {"construction", row.hardCase->construction},
                     {"family", row.family},
                     {"input", row.finding.input()},
                     {"worst", finite(worst)},
                     {"bound", finite(bound)},
                     {"margin", finite(bound - worst)},
                     {"simd", row.setup.simd},
                     {"packet", row.setup.packet == 0 ? Json("auto") : Json(row.setup.packet)},
                     {"tried", row.finding.seen()},
                     {"holds", row.finding.holds()},
                     {"result", row.result()}});
  }
  return {{"machine", machineJson(machine)}, {"cases", cases}};
}

// A scene of scenes/hard and its picture in linear radiance.
struct HardScene {
  std::string name;
  Image picture;
};

// The data of the page: for each case the run that came closest to its bound, as --json has it, a
// summary and the pictures.
Json reportOf(const Machine& machine, const std::vector<Row>& rows,
              const std::vector<HardScene>& scenes) {
  Json report = jsonOf(machine, worstRows(rows));
  report["report"] = "verify";
  report["summary"] = summaryOf(rows);

  report["pictures"] = Json::array();
  for (const HardScene& scene : scenes) {
    const auto png = encodePng(toDisplay(scene.picture, 0, ToneCurve::none));
    report["pictures"].push_back({{"name", scene.name}, {"png", base64(png)}});
  }
  return report;
}

constexpr int kWidth = 320, kHeight = 240, kColumns = 4, kSheetGap = 4;

// The scenes in the folder `hard` beside those that are shipped, in the order of their names.
std::vector<std::filesystem::path> hardScenes() {
  std::vector<std::filesystem::path> scenes;
  for (const std::filesystem::path& shipped : shippedScenes()) {
    std::error_code error;
    for (const auto& entry :
         std::filesystem::directory_iterator(shipped.parent_path() / "hard", error)) {
      if (entry.path().extension() == ".json") scenes.push_back(entry.path());
    }
    if (!scenes.empty()) break;
  }

  std::ranges::sort(scenes);
  return scenes;
}

// Renders every scene of scenes/hard at 320x240, in alphabetical order. Throws Error(io) when there
// is none.
std::vector<HardScene> renderHardScenes(Progress* progress) {
  const std::vector<std::filesystem::path> files = hardScenes();
  if (files.empty()) throwIo("no scenes of hard cases found; is $WHIT_SCENES set?");

  RenderOptions options;
  options.size = ImageSize{kWidth, kHeight};
  options.depth = 16;
  options.spp = 1;

  std::vector<HardScene> scenes;
  for (const std::filesystem::path& file : files) {
    const std::string name = file.stem().string();
    reportProgress(progress, name, double(scenes.size()) / double(files.size()));

    Warnings warnings;
    const Scene scene =
        Scene::finalize(loadScene(file.string(), LoadOptions{}, warnings), warnings);
    scenes.push_back({name, pictureOf(scene, scene.cameras.front(), options)});
  }
  return scenes;
}

// Writes the pictures side by side, four a row.
void writeSheet(const std::string& path, const std::vector<HardScene>& scenes) {
  const int count = static_cast<int>(scenes.size());
  const int columns = std::min(count, kColumns), rows = (count + kColumns - 1) / kColumns;
  Image sheet(columns * (kWidth + kSheetGap) + kSheetGap, rows * (kHeight + kSheetGap) + kSheetGap);

  for (int i = 0; i < count; ++i) {
    const Image& picture = scenes[i].picture;
    const int left = kSheetGap + i % kColumns * (kWidth + kSheetGap);
    const int top = kSheetGap + i / kColumns * (kHeight + kSheetGap);
    forEachPixel(kWidth, kHeight,
                 [&](int x, int y) { sheet.at(left + x, top + y) = picture.at(x, y); });
  }

  const cli::WriteScope scope;
  writePng(path, toDisplay(sheet, 0, ToneCurve::none), {});
}

// Splits the values of --only. Throws Error(usage) for the name of an unknown case.
std::vector<std::string> caseNames(const std::vector<std::string>& lists) {
  std::vector<std::string> names, known;
  for (const Family& family : families()) {
    for (const Case& c : family.cases) known.emplace_back(c.name);
  }

  for (const std::string& list : lists) {
    for (const std::size_t i : indicesOf(list, known, "case")) names.push_back(known[i]);
  }
  return names;
}

// Returns the published pictures of this size, of these scenes or of all. Throws Error(usage) if
// there are none.
std::vector<PublishedHash> picturesToHash(const std::string& size,
                                          const std::vector<std::string>& scenes) {
  std::vector<PublishedHash> pictures;
  std::vector<std::string> sizes, known;
  for (const PublishedHash& picture : publishedHashes()) {
    sizes.emplace_back(picture.size);
    if (picture.size != size) continue;
    known.emplace_back(picture.scene.substr(0, picture.scene.find(' ')));
    if (scenes.empty() || contains(scenes, known.back())) pictures.push_back(picture);
  }

  refuseIf(known.empty(), "--hashes takes " + sizes[0] + " or " + sizes[1] + ", not " + size);
  for (const std::string& scene : scenes) {
    refuseIf(!contains(known, scene),
             "no hash of '" + scene + "' is published" + didYouMean(scene, known));
  }
  return pictures;
}

// Prints a line for each picture. Returns false if a hash is not the published one.
bool comparesHashes(const std::vector<PublishedHash>& pictures, const std::string& simd) {
  std::vector<std::string> different, leftOut;
  for (const PublishedHash& picture : pictures) {
    const std::string name(picture.scene);
    std::string hash = "-", verdict = "left out";
    try {
      const HashedScene scene(picture);
      RenderOptions options = scene.options();
      options.simd = simd;
      hash = scene.hash(options);
      const std::string published(picture.hashWith(simd::chosenTarget()));
      verdict = "as published";
      if (hash != published) {
        verdict = published.empty() ? "NOT PUBLISHED" : "DIFFERS from " + published;
        different.push_back(name);
      }
    } catch (const Error& error) {
      // A scene whose files are missing is left out; every other error ends the run.
      if (error.status() != ExitStatus::io) throw;
      leftOut.push_back(name + " (" + error.what() + ")");
    }

    std::printf("%-20s %-7s %-32s %s\n", name.c_str(), picture.size.data(), hash.c_str(),
                verdict.c_str());
    std::fflush(stdout);
  }

  for (const std::string& name : leftOut) std::fprintf(stderr, "left out: %s\n", name.c_str());
  for (const std::string& name : different) {
    std::fprintf(stderr, "not as published: %s\n", name.c_str());
  }
  return different.empty() && leftOut.size() < pictures.size();
}

Machine thisMachine() {
  Warnings warnings;
  const Scene nothing = Scene::finalize({}, warnings);
  return Renderer(nothing, RenderOptions{}).machine();
}

int run(const std::vector<std::string>& words) {
  if (words == std::vector<std::string>{"--version"}) {
    std::printf("whit-verify %s\n", WHIT_VERSION);
    return 0;
  }

  cli::CommonOptions common;
  std::vector<std::string> only, hashed;
  std::string json, html, sheet, hashes, simd = "auto";

  cli::OptionList list;
  list.group("Running");
  list.many({"only", "H1,H2a"}, "run only these cases; may be given more than once", only);
  list.value({"json", "FILE"}, "write the result of every run as JSON; - is standard output", json);
  list.value({"html", "FILE.html"},
             "write the table as a page, with pictures of the scenes in scenes/hard", html);
  list.value({"sheet", "FILE.png"},
             "run no case: write pictures of the scenes in scenes/hard on one sheet", sheet);
  list.value({"hashes", "SIZE"},
             "run no case: compare the hashes of pictures of the shipped scenes, 480x300 or 48x30, "
             "with those that are published",
             hashes);
  list.value({"simd", "TARGET"}, "SIMD target of --hashes (default: auto)", simd);
  cli::listReportOptions(list, common);
  list.operands("[SCENE...]", "scenes of --hashes; without any, all of them", 0, 100, hashed);

  const bool runs = cli::parseOptions(
      "whit-verify [options] [SCENE...]",
      "Runs the catalogue of hard cases with every SIMD target and packet width of this machine.\n"
      "The exit status is 1 when a case breaks its bound, or when a hash is not the published one.",
      list, words);
  if (!runs) return 0;

  refuseIf(hashes.empty() && (!hashed.empty() || simd != "auto"),
           "scenes and --simd are for --hashes SIZE");
  refuseIf(!hashes.empty() && !sheet.empty(), "--hashes and --sheet are runs of their own");
  const bool reportsCases = !only.empty() || !json.empty() || !html.empty();
  refuseIf(reportsCases && (!hashes.empty() || !sheet.empty()),
           "--only, --json and --html are of cases, and --hashes and --sheet run none");
  if (!hashes.empty()) {
    const bool same = comparesHashes(picturesToHash(hashes, hashed), simd);
    return static_cast<int>(same ? ExitStatus::done : ExitStatus::checkFailed);
  }

  requireJsonWritable(json);
  if (!html.empty()) requireWritable(html, {".html"});
  if (!sheet.empty()) requireWritable(sheet, {".png"});
  cli::requireSeparateFiles({json, html}, common, {});
  const std::vector<std::string> names = caseNames(only);
  auto progress = cli::makeProgressBar(common);

  if (!sheet.empty()) {
    const std::vector<HardScene> scenes = renderHardScenes(progress.get());
    progress.reset();
    writeSheet(sheet, scenes);
    for (const HardScene& scene : scenes) std::printf("%s\n", scene.name.c_str());
    return 0;
  }

  const std::vector<Row> rows = runCatalogue(names, progress.get());
  std::vector<HardScene> scenes;
  if (!html.empty()) scenes = renderHardScenes(progress.get());
  progress.reset();

  // The table goes to standard error if the JSON takes standard output.
  FILE* const people = json == "-" ? stderr : stdout;
  if (people == stdout || !common.quiet) std::fprintf(people, "%s", tableOf(rows).c_str());

  const Machine machine = thisMachine();
  if (!json.empty()) writeJson(json, jsonOf(machine, rows));
  if (!html.empty()) {
    const cli::WriteScope scope;
    writeTextFile(html, reportPage(reportOf(machine, rows, scenes)));
  }

  const bool allHold =
      std::ranges::all_of(rows, [](const Row& row) { return row.finding.holds(); });
  return static_cast<int>(allHold ? ExitStatus::done : ExitStatus::checkFailed);
}

}  // namespace

}  // namespace whit::verify

int main(int argc, char** argv) {
  return whit::cli::runProgram("whit-verify",
                               [&] { return whit::verify::run(whit::cli::wordsOf(argc, argv)); });
}
