// whit compare: packets against the scalar reference, or two images.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/commands.h"
#include "command_line/program.h"
#include "command_line/progress_bar.h"
#include "core/error.h"
#include "core/option_table.h"
#include "core/text.h"
#include "engine/engine.h"
#include "inspect/metrics.h"
#include "inspect/path_divergence.h"
#include "inspect/reference_frame.h"
#include "inspect/stage_comparison.h"
#include "io/files.h"
#include "io/image/image_layers.h"
#include "output/image_output.h"
#include "output/json_report.h"
#include "output/open_and_warn.h"
#include "render/renderer.h"

namespace whit::cli {

namespace {

constexpr const char* kCompareUsage = "whit compare SCENE [options], or whit compare A B [options]";
constexpr const char* kCompareSummary =
    "Renders SCENE by packets (A) and by the scalar reference (B) and compares the two. Without "
    "--tolerance up to 5 % of the pixels may differ by 2 codes or more, and the energy by 2 %. Or "
    "measures how the image file A differs from B, the reference: two files fail by --tolerance "
    "only. Channels are compared as well, alpha among them; without alpha a picture is opaque.";

struct CompareJob {
  CommonOptions common;
  std::vector<std::string> subjects;
  std::optional<double> tolerance;
  bool stages = false, colors = false;
  std::string heatmap, json;
};

// The comparison of a channel. A channel that one picture lacks differs everywhere.
struct ChannelDifference {
  std::string name;    // "depth.Z"
  std::string onlyIn;  // "A" or "B", if the other picture lacks it
  bool countsThings = false;
  ValueDifference difference;
};

struct Comparison {
  ImageDifference difference;
  std::optional<double> pathDivergencesPerMpx;         // unknown of two files
  std::optional<double> timeMsA, timeMsB;              // unknown of two files
  std::optional<std::vector<StageDifference>> stages;  // with --stages
  std::vector<ChannelDifference> channels;
};
struct Compared {  // NOLINT(bugprone-exception-escape): moving Json does not throw
  Comparison numbers;
  Image a, b;
  std::vector<ImageLayer> layersA, layersB;
  float exposure = 0;  // EV
  ToneCurve toneCurve = ToneCurve::none;
  Json about;  // the scene, or the files, and the options
};

OptionList listOptions(CompareJob& job) {
  OptionList list;
  list.group("Comparing");
  list.flag("stages", "also each vector stage with its scalar reference", job.stages);
  list.value(
      {"tolerance", "X", 0},
      "largest RMSE of the colors, and of each channel, that passes; else the exit status is "
      "1. Numbers of things have to be equal",
      job.tolerance);
  list.flag("colors", "the colors alone, without alpha and channels", job.colors);
  list.value({"heatmap", "FILE"},
             "PNG of the differences: black is 0, light yellow 16 8-bit steps or more",
             job.heatmap);
  list.value({"json", "FILE"}, "the numbers as JSON; - is standard output", job.json);

  listCommonOptions(list, job.common);
  list.operands("SCENE, or A B", "a scene, or two image files", 1, 2, job.subjects);
  return list;
}

Compared compareFiles(const CompareJob& job) {
  const CommonOptions& common = job.common;

  // Only a picture that is rendered can follow options other than those of the display.
  const auto refuse = [](bool isGiven, const std::string& option) {
    refuseIf(isGiven, "--" + option + " needs a scene, not two images");
  };
  for (const std::string& option : common.given) {
    refuse(option != "exposure" && option != "tonemap", option);
  }
  refuse(common.render.exposure.automatic, "exposure auto");
  refuse(common.load.instant.seconds.has_value(), "time");
  refuse(!common.load.settings.empty(), "set");
  refuse(!common.load.sky.empty(), "sky");
  refuse(job.stages, "stages");

  for (const std::string& file : job.subjects) {
    refuseIf(extensionOf(file).empty(), "'" + file + "': expected one scene, or two image files");
  }

  Compared result;
  result.exposure = common.render.exposure.ev;
  result.toneCurve = common.render.toneCurve;
  result.a = readImage(job.subjects[0], ImageLimits());
  result.b = readImage(job.subjects[1], ImageLimits());
  result.layersA = readLayers(job.subjects[0], ImageLimits());
  result.layersB = readLayers(job.subjects[1], ImageLimits());

  result.about = {{"a", job.subjects[0]}, {"b", job.subjects[1]}};
  for (const char* option : {"exposure", "tonemap"}) {
    result.about["options"][option] = optionText(common.render, option);
  }
  return result;
}

Compared compareModes(const CompareJob& job) {
  const auto progress = makeProgressBar(job.common);
  const std::shared_ptr<OpenScene> open = openAndWarn(job.subjects[0], job.common, progress.get());

  Engine engine(open);
  engine.setOptions(optionsToMeasure(open->scene, job.common));
  Renderer& renderer = engine.prepare(progress.get());
  const RenderOptions& options = engine.options();
  const Camera camera = engine.camera();

  // Both films have one size and the same channels, so they can be compared pixel by pixel.
  Film packets = makeFilm(open->scene, options, job.common.load.maxMemoryBytes);
  Film reference = packets;
  Compared result;
  result.exposure = options.exposure.ev;
  result.toneCurve = options.toneCurve;
  result.about = {{"scene", open->scene.name}, {"options", optionsJson(options)}};
  result.numbers.timeMsA = renderer.render(camera, packets).frameMs;
  result.numbers.timeMsB = renderReference(renderer, camera, reference, progress.get()).frameMs;

  // A path diverges where rounding decides between two branches.
  const double megapixels = static_cast<double>(packets.image.pixels.size()) / 1e6;
  result.numbers.pathDivergencesPerMpx =
      static_cast<double>(comparePaths(renderer, camera, packets).divergences) / megapixels;

  if (job.stages) {
    Film scratch = makeFilm(open->scene, options, job.common.load.maxMemoryBytes);
    result.numbers.stages = compareStages(renderer, camera, scratch);
  }

  result.layersA = layersOf(packets.channels);
  result.layersB = layersOf(reference.channels);
  result.a = std::move(packets.image);
  result.b = std::move(reference.image);
  return result;
}

// Adds a row for each channel of A; of B, with `isA` false, only for channels that A lacks. Both
// images have one size; an image without alpha is opaque.
void compareChannels(const std::vector<ImageLayer>& layers, const std::vector<ImageLayer>& others,
                     bool isA, std::vector<ChannelDifference>& rows) {
  for (const ImageLayer& layer : layers) {
    const auto other = std::ranges::find_if(others, [&](const ImageLayer& o) {
      return o.name == layer.name && o.countsThings == layer.countsThings;
    });
    const bool isAlone = other == others.end();
    if (!isAlone && !isA) continue;

    ChannelDifference& row = rows.emplace_back();
    row.name = layer.name;
    row.countsThings = layer.countsThings;
    if (isAlone && layer.name == "A") {
      row.difference = differenceOf(layer.floats(), std::vector<float>(layer.words.size(), 1.0f));
    } else if (isAlone) {
      row.onlyIn = isA ? "A" : "B";
      row.difference = {layer.words.size(), 0, kInfinity, kInfinity};
    } else if (layer.countsThings) {
      row.difference = differenceOf(layer.words, other->words);
      row.difference.incomparable = row.difference.differing;  // numbers have no distance
    } else {
      row.difference = differenceOf(layer.floats(), other->floats());
    }
  }
}

void printChannels(FILE* out, const std::vector<ChannelDifference>& channels) {
  if (channels.empty()) return;
  std::fprintf(out, "\n%-28s%18s%14s%14s%14s\n", "channel", "pixels differing", "incomparable",
               "largest", "RMS");
  for (const ChannelDifference& c : channels) {
    const std::string name = c.onlyIn.empty() ? c.name : c.name + ", only in " + c.onlyIn;
    std::fprintf(out, "%-28s%18llu", printable(name).c_str(),
                 static_cast<unsigned long long>(c.difference.differing));
    if (!c.countsThings) {
      std::fprintf(out, "%14llu%14.6g%14.6g",
                   static_cast<unsigned long long>(c.difference.incomparable), c.difference.largest,
                   c.difference.rms);
    }
    std::fputc('\n', out);
  }
}

Json orNull(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

// A number that sums up a comparison: its key in JSON, its title and format for people, and its
// value, which is null if it is unknown.
struct Number {
  const char *key, *title, *format;
  Json value;
};

std::vector<Number> numbersOf(const Comparison& c) {
  const ImageDifference& d = c.difference;
  return {{"rmse", "RMSE (linear)", "%.6g", d.rmse},
          {"relmse", "relMSE", "%.6g", d.relmse},
          {"psnr_db", "PSNR", "%.2f dB", d.psnrDb},
          {"flip_mean", "FLIP, mean", "%.6f", d.flipMean},
          {"max_code", "largest 8-bit difference", "%.0f", d.maxCode},
          {"pixels_ge_1_code_pct", "pixels off by 1 or more", "%.4f %%", d.pixelsGe1CodePct},
          {"pixels_ge_2_codes_pct", "pixels off by 2 or more", "%.4f %%", d.pixelsGe2CodesPct},
          {"energy_ratio", "energy of A over B", "%.6f", d.energyRatio},
          {"nonfinite", "pixels not finite", "%.0f", d.nonFinite},
          {"path_flips_per_mpx", "other path", "%.1f per million pixels",
           orNull(c.pathDivergencesPerMpx)}};
}

void printNumbers(FILE* out, const Comparison& c) {
  for (const Number& n : numbersOf(c)) {
    if (n.value.is_null()) continue;
    const std::string text = formatted(n.format, n.value.get<double>());
    std::fprintf(out, "%-26s%s\n", n.title, text.c_str());
  }

  if (c.timeMsA && c.timeMsB) {
    std::fprintf(out, "%-26s%.1f ms, %.1f ms\n", "time of A, B", *c.timeMsA, *c.timeMsB);
  }
}

void printStages(FILE* out, const std::vector<StageDifference>& rows) {
  std::fprintf(out, "\n%-34s%-22s%12s%12s%12s  %s\n", "stage", "column", "slots", "worst ulp",
               "limit ulp", "at");
  for (const StageDifference& row : rows) {
    std::fprintf(out, "%-34s%-22s%12llu%12.3g%12.3g  %d,%d depth %d%s\n",
                 entryOf(kStageNames, row.stage).data(), row.column.c_str(),
                 static_cast<unsigned long long>(row.slots), row.worstUlp, row.limitUlp, row.pixelX,
                 row.pixelY, row.depth, row.worstUlp <= row.limitUlp ? "" : "  TOO FAR");
  }
}

// Upper bounds on the difference between packets and reference if no tolerance is given. Rounding
// decides between two paths here and there, most often between mirrors: at 64 bounces it changes
// two pixels of a hundred by two codes. An error in the code changes more.
constexpr double kMostPixelsOffPct = 5, kMostEnergyOff = 0.02;

// Returns true if the pictures pass. A NaN fails each of the conditions. Means leave out pixels
// that are not finite, so these fail in a condition of their own.
bool picturesPass(const CompareJob& job, const ImageDifference& d) {
  const bool judged = job.tolerance || job.subjects.size() == 1;
  if (judged && d.incomparable > 0) {
    std::fprintf(stderr,
                 "whit: %llu pixels are not finite in one picture and differ in the other\n",
                 static_cast<unsigned long long>(d.incomparable));
    return false;
  }

  if (job.tolerance) {
    if (d.rmse <= *job.tolerance) return true;
    std::fprintf(stderr, "whit: the RMSE is %.6g, which --tolerance %g does not allow\n", d.rmse,
                 *job.tolerance);
    return false;
  }

  if (job.subjects.size() == 2) return true;

  const bool codes = d.pixelsGe2CodesPct <= kMostPixelsOffPct;
  const bool energy = std::fabs(d.energyRatio - 1) <= kMostEnergyOff;
  if (!codes) {
    std::fprintf(stderr, "whit: %.4f %% of the pixels are off by 2 or more; at most %g %% may be\n",
                 d.pixelsGe2CodesPct, kMostPixelsOffPct);
  }
  if (!energy) {
    std::fprintf(stderr,
                 "whit: the energy of A over B is %.6f; at most %g may be missing or added\n",
                 d.energyRatio, kMostEnergyOff);
  }
  return codes && energy;
}

bool channelsDiffer(const std::vector<ChannelDifference>& channels) {
  return std::ranges::any_of(channels,
                             [](const ChannelDifference& c) { return c.difference.differing > 0; });
}

// Channels are judged by --tolerance only.
bool channelsPass(const CompareJob& job, const std::vector<ChannelDifference>& channels) {
  if (!job.tolerance) return true;

  for (const auto& [name, onlyIn, countsThings, d] : channels) {
    const double rmse = d.incomparable > 0 ? kInfinity : d.rms;
    if (rmse <= *job.tolerance) continue;
    std::fprintf(stderr,
                 "whit: the RMSE of the channel %s is %.6g, which --tolerance %g does not allow "
                 "(--colors compares the colors alone)\n",
                 printable(name).c_str(), rmse, *job.tolerance);
    return false;
  }
  return true;
}

// Sums up the comparison for people. A code is a step of 8-bit sRGB.
std::string verdict(const CompareJob& job, const Comparison& c, bool passed) {
  const ImageDifference& d = c.difference;
  std::string text;
  if (d.nonFinite > 0) {
    text = "there are pixels that are not finite";
  } else if (d.rmse == 0 && channelsDiffer(c.channels)) {
    text = "the colors are the same, bit for bit, but channels differ";
  } else if (d.rmse == 0) {
    text = "the pictures are the same, bit for bit";
  } else if (d.maxCode == 0) {
    text = "the pictures differ, but in no 8-bit code";
  } else if (d.pixelsGe2CodesPct == 0) {
    text = "the pictures differ by one 8-bit code at most: nobody sees it";
  } else {
    text =
        formatted("%.4g %% of the pixels differ by two 8-bit codes or more", d.pixelsGe2CodesPct);
  }

  const bool judged = job.subjects.size() == 1 || job.tolerance;
  if (!judged) return "verdict: " + text + "; measured, not judged: --tolerance X sets what passes";
  return "verdict: " + text + (passed ? "; passed" : "; FAILED");
}

void writeHeatMap(const CompareJob& job, const Compared& compared) {
  const WriteScope scope;
  ImageMetadata metadata{{"a", job.subjects[0]}, {"b", job.subjects.back()}};
  if (job.subjects.size() == 1) metadata = {{"a", "packets"}, {"b", "reference"}};
  writePng(job.heatmap, heatMap(compared.a, compared.b, compared.exposure, compared.toneCurve),
           metadata);
}

// Infinite and unknown numbers are null.
Json compareJson(const Compared& compared) {
  const Comparison& comparison = compared.numbers;
  Json json = compared.about;
  json["size"] = {compared.a.width, compared.a.height};
  for (const Number& n : numbersOf(comparison)) json[n.key] = n.value;
  json["time_ms"] = {{"a", orNull(comparison.timeMsA)}, {"b", orNull(comparison.timeMsB)}};

  for (const ChannelDifference& c : comparison.channels) {
    Json row{{"channel", c.name}, {"pixels_differing", c.difference.differing}};
    if (!c.onlyIn.empty()) row["only_in"] = c.onlyIn;
    if (!c.countsThings) {
      row["pixels_incomparable"] = c.difference.incomparable;
      row["max"] = c.difference.largest;
      row["rms"] = c.difference.rms;
    }
    json["channels"].push_back(std::move(row));
  }

  if (!comparison.stages) return json;
  json["stages"] = Json::array();
  for (const StageDifference& row : *comparison.stages) {
    json["stages"].push_back({{"stage", entryOf(kStageNames, row.stage)},
                              {"column", row.column},
                              {"slots", row.slots},
                              {"worst_ulp", row.worstUlp},
                              {"limit_ulp", row.limitUlp},
                              {"pixel", {row.pixelX, row.pixelY}},
                              {"depth", row.depth}});
  }
  return json;
}

}  // namespace

int compareCommand(const Words& words) {
  CompareJob job;
  if (!parseOptions(kCompareUsage, kCompareSummary, listOptions(job), words)) return 0;

  requireJsonWritable(job.json);
  if (!job.heatmap.empty()) requireWritable(job.heatmap, {".png"});
  const bool ofPictures = job.subjects.size() == 2;
  requireSeparateFiles({job.json, job.heatmap}, job.common, ofPictures ? Words() : job.subjects,
                       ofPictures ? job.subjects : Words());

  Compared compared = ofPictures ? compareFiles(job) : compareModes(job);
  compared.numbers.difference =
      compareImages(compared.a, compared.b, compared.exposure, compared.toneCurve);
  if (!job.colors) {
    std::vector<ChannelDifference>& rows = compared.numbers.channels;
    compareChannels(compared.layersA, compared.layersB, true, rows);
    compareChannels(compared.layersB, compared.layersA, false, rows);
  }

  // Where JSON takes standard output, the tables for people go to standard error.
  FILE* const people = job.json == "-" ? stderr : stdout;
  if (people == stdout || !job.common.quiet) {
    printNumbers(people, compared.numbers);
    printChannels(people, compared.numbers.channels);
    if (compared.numbers.stages) printStages(people, *compared.numbers.stages);
  }

  if (!job.json.empty()) writeJson(job.json, compareJson(compared));
  if (!job.heatmap.empty()) writeHeatMap(job, compared);
  printWrittenFiles({job.json, job.heatmap}, job.common);

  // With --stages, each column that a vector stage writes must be within its limit as well.
  const bool pictures = picturesPass(job, compared.numbers.difference);
  const bool channels = channelsPass(job, compared.numbers.channels);
  const bool stages = !compared.numbers.stages ||
                      std::ranges::all_of(*compared.numbers.stages, [](const StageDifference& row) {
                        return row.worstUlp <= row.limitUlp;
                      });
  const bool passed = stages && pictures && channels;

  if (people == stdout || !job.common.quiet) {
    std::fprintf(people, "%s\n", verdict(job, compared.numbers, passed).c_str());
  }

  if (passed) return 0;
  std::fprintf(stderr, "whit: the comparison failed\n");
  return static_cast<int>(ExitStatus::checkFailed);
}

}  // namespace whit::cli
