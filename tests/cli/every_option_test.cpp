// Every option changes what its help says and nothing else: tables of options, and of what changes
// in the picture, in the JSON or in the messages of a command. An option that is not in a table
// fails.
#include <set>

#include "core/option_table.h"
#include "io/image/image_layers.h"
#include "io/member_rows.h"
#include "run_here.h"
#include "simd/kernels.h"
#include "source_files.h"

namespace whit::cli {
namespace {

using Names = std::set<std::string>;

class EveryOption : public TinySceneTest {
 protected:
  EveryOption() {
    // The yard has something for most options to change. Others change the path, the second camera,
    // the texture of the floor, or what a mirror of few facets shows of an exact sphere of glass.
    PlainJson scene = yard();
    scene.merge_patch(
        parse("{'cameras': {'side': {'eye': [4, 1.6, 0], 'at': [0, 0.7, 0]}},"
              "'path': [{'time': 0, 'eye': [0, 1.6, 4], 'at': [0, 0.7, 0]},"
              "{'time': 1, 'eye': [3, 1.6, 4]}],"
              "'materials': {'floor': {'diffuseMap': 'checker'}, 'a': {'mirror': 0.4}}}"));
    scene["scene"][2].merge_patch(parse("{'shape': 'sphere', 'level': null}"));
    scene["scene"][3]["level"] = 1;
    save("all.json", scene.dump());
  }

  // What `whit render` says about a picture and what is in its files, by the names that the tables
  // use. Times and what depends on the machine are left out.
  using Answers = std::map<std::string, std::string>;
  Answers render(const std::string& text) {
    const Outcome outcome = runHere(
        "render -o out.png -o out.exr --json out.json --quiet --threads 2 " + text, folder_);
    Answers answers{{"status", std::to_string(outcome.status)}, {"message", outcome.err}};
    if (outcome.status != 0) return answers;

    const Json json = jsonIn("out.json");
    for (const auto& [key, value] : json.at("options").items()) {
      answers["options." + key] = value.get<std::string>();
    }
    for (const char* key :
         {"scene",  "size",           "threads",   "packet",      "simd",       "mode",    "batch",
          "robust", "effects_choice", "effects",   "exposure_ev", "triangles",  "spheres", "frames",
          "rays",   "lanes_filled",   "nonfinite", "ray_limited", "image_hash", "kept"}) {
      answers[key] = json.at(key).dump();
    }

    const RawImage png = storedIn("out.png");
    answers["codes"].assign(png.codes.begin(), png.codes.end());
    for (const ImageLayer& layer : readLayers(folder_ / "out.exr", ImageLimits())) {
      answers["layers"] += layer.name;
    }
    return answers;
  }

  // The names of the answers that differ. Those that follow from another one are left out.
  static Names differencesOf(const Answers& a, const Answers& b) {
    if (a.at("status") != b.at("status")) return {"status"};
    Names names;
    const auto compare = [&](const Answers& all, const Answers& others) {
      for (const auto& [name, text] : all) {
        const auto other = others.find(name);
        if (other == others.end() || other->second != text) names.insert(name);
      }
    };
    compare(a, b);
    compare(b, a);

    // Another picture has other codes and is made of other rays.
    if (names.contains("image_hash")) {
      for (const char* following : {"codes", "rays", "lanes_filled"}) names.erase(following);
    }
    return names;
  }

  void expectChanges(const std::string& before, const std::string& option,
                     const std::string& expected) {
    const auto base = bases_.try_emplace(before);
    if (base.second) base.first->second = render(before);
    const Answers changed = render(before + " " + option);
    const Words names = split(expected);
    EXPECT_EQ(differencesOf(base.first->second, changed), Names(names.begin(), names.end()))
        << before << " " << option << ": " << changed.at("message");
    last_ = changed;
  }

  std::map<std::string, Answers> bases_;  // by words
  Answers last_;
};

// The last target of this build and CPU: which ones there are depends on Highway's version and,
// under sanitizers, on the build.
constexpr const char* kSlowestTarget = "the slowest";

// The options of core/options.h: name, value, what changes beside the option's own value
// in the JSON, and words before it that it needs.
struct PictureOption {
  const char *name, *value, *changes = "image_hash", *before = "";
};
constexpr PictureOption kPictureOptions[] = {
    {"quality", "good",
     "image_hash effects options.ambient-samples options.glossy options.light-cutoff "
     "options.light-samples options.spp"},
    {"size", "30x20", "image_hash size"},
    {"camera", "side"},
    {"eye", "1,2,5"},
    {"at", "0,0,0"},
    {"up", "1,1,0"},
    {"fov", "30"},
    {"ortho", "3"},
    {"crop", "8,4,30,20"},
    {"spp", "4"},
    {"adaptive", "on", "image_hash", "--spp 4"},
    {"contrast", "64", "image_hash", "--spp 4 --adaptive on"},
    {"depth", "1"},
    {"glossy", "2", "image_hash effects"},
    {"indirect", "2", "image_hash effects"},
    {"cutoff", "0.2"},
    {"roulette", "0.5"},
    {"max-rays", "3", "image_hash message ray_limited", "--glossy 4"},
    {"light-samples", "4", "image_hash effects"},
    {"ambient-samples", "4", "image_hash effects"},
    {"light-cutoff", "0.1"},
    {"fresnel", "schlick"},
    {"texture-filter", "nearest"},
    {"offset", "fixed"},
    {"terminator", "on"},
    {"bend", "off"},
    {"threads", "1", "threads"},
    {"packet", "16", "packet lanes_filled", "--packet 8"},
    {"simd", kSlowestTarget, "simd", "--packet 8"},
    {"mode", "reference", "image_hash mode"},
    {"batch", "frame", "batch"},
    {"robust", "off", "robust"},
    {"retry", "off", ""},
    {"bvh", "high", ""},
    {"sphere-segments", "8", "image_hash effects spheres triangles"},
    {"effects", "all", "effects effects_choice"},
    {"disable", "shadows", "image_hash effects"},
    {"exposure", "1", "codes exposure_ev"},
    {"tonemap", "filmic", "codes"},
    {"background", "ff0000", "image_hash layers"},
    {"tile", "8", "lanes_filled", "--packet 8"},
    {"queue", "64", "lanes_filled", "--packet 8"},
    {"channels", "depth", "layers"},
    {"strict", "on", ""},
};

TEST_F(EveryOption, OfAPictureChangesWhatItSays) {
  const RenderOptions defaults;
  Names tested;
  for (const PictureOption& row : kPictureOptions) {
    const std::string name = row.name;
    tested.insert(name);
    const std::string value =
        row.value == kSlowestTarget ? simd::availableTargets().back() : row.value;
    std::string changes = row.changes;
    bool isFlag = false;
    forEachOption(defaults, [&](const OptionSpec& spec, const auto&) {
      if (spec.name != name) return;
      isFlag = spec.words.empty();
      // How the work is shared out is no part of what a picture says about itself.
      if (spec.changesPicture) changes += " options." + name;
    });

    expectChanges(std::string("all.json ") + row.before, "--" + name + (isFlag ? "" : " " + value),
                  changes);
    if (last_.contains("options." + name)) {
      EXPECT_EQ(last_["options." + name], value) << name;
    }
  }

  forEachOption(defaults, [&](const OptionSpec& spec, const auto&) {
    EXPECT_TRUE(tested.contains(std::string(spec.name))) << spec.name << " is in no row";
  });
}

// The options about loading: with the words before them, and what changes.
struct LoadOption {
  const char *option, *before, *changes = "image_hash";
};
constexpr LoadOption kLoadOptions[] = {
    {"--allow-outside", "inner/scene.json --size 8x8", "status"},
    {"--set /lights/0/intensity=40", "tiny.json"},
    {"--sky studio", "tiny.json", "image_hash effects"},
    {"--time 0.5", "all.json"},
    {"--time 0.5", "moving.gltf", "image_hash effects exposure_ev options.exposure"},
    {"--animation first", "moving.gltf --time 0.5", "image_hash exposure_ev options.exposure"},
    {"--viewpoint inside", "moving.gltf", "image_hash exposure_ev options.exposure message"},
    {"--azimuth 40", "a.obj"},
    {"--zoom 1.5", "a.obj"},
    // The shadow is black and covers in part: it changes no color, only the share of the
    // background.
    {"--ground", "a.obj", "codes effects lanes_filled rays triangles"},
    {"--strict", "mended.obj --size 8x8", "status"},
    {"--max-memory 0.001", "tiny.json", ""},
    {"--max-memory 0.001", "tiny.json --size 400x400", "status"},
    {"--max-memory 0.2", "tiny.json --size 400x400", ""},
};

TEST_F(EveryOption, OfLoadingChangesWhatItSays) {
  std::filesystem::create_directory(folder_ / "inner");
  save("inner/scene.json", "{'whit': 1, 'scene': [{'model': '../a.obj'}]}");
  save("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  save("mended.obj", bytesOf("a.obj") + "f 1 1 2\n");

  // The animation named "all" comes first, and "first" moves less.
  Json moving = Json::parse(sourceText("tests/fuzz/corpus/gltf/motion.gltf"));
  Json& animation = moving.at("animations").at(0);
  animation["name"] = "all";
  Json first = animation;
  first["name"] = "first";
  first["channels"] = Json::array({first["channels"][0]});
  moving["animations"].push_back(first);
  save("moving.gltf", moving.dump());

  for (const LoadOption& row : kLoadOptions) {
    expectChanges(row.before, row.option, row.changes);
  }
}

// The other options of each command: the command with words before the option, the option, and what
// the command then says on standard output, on standard error or in a file, and does not say
// without the option.
struct OwnOption {
  const char *line, *option, *says;
};
constexpr OwnOption kOwnOptions[] = {
    {"render tiny.json --size 8x8 -o b.png", "--output a.png", "a.png"},
    {"render tiny.json --size 8x8 -o b.png", "--budget 20ms", "chose"},
    {"render tiny.json --size 8x8 -o b.png", "--target 9codes", "chose"},
    {"render tiny.json --size 8x8 -o f#.png", "--frames 0..1", "f1.png"},
    {"render tiny.json --size 8x8 -o f#.png --frames 1 --json -", "--fps 2", "\"film_fps\": 2.0"},
    {"render tiny.json --size 8x8 -o b.png", "--resume", "kept 1"},
    {"render tiny.json --size 8x8 -o e.exr", "--exr half", "half"},
    {"render tiny.json --size 8x8 -o b.png", "--stats", "addImpulses"},
    {"render tiny.json --size 8x8 -o b.png", "--json -", "\"image_hash\""},
    {"bench tiny.json --size 8x8", "--frames 2", "of 2 frames"},
    {"bench tiny.json --size 8x8 --frames 1", "--floor", "frame over floor"},
    {"bench tiny.json --size 8x8 --frames 1", "--widths", "packets of 1,"},
    {"bench tiny.json --size 8x8 --frames 1", "--threads-scaling", "efficiency"},
    {"bench tiny.json --size 8x8 --frames 1", "--ab-effects", "over"},
    {"bench tiny.json --size 8x8 --frames 1", "--json -", "\"image_hash\""},
    {"bench tiny.json --size 8x8 --frames 1", "--csv -", "frame_ms_median"},
    {"bench tiny.json --size 8x8 --frames 1", "--csv b.csv", "b.csv"},
    {"compare tiny.json --size 8x8", "--stages", "worst ulp"},
    {"compare tiny.json --size 8x8", "--tolerance 0", "--tolerance 0"},
    {"compare tiny.json --size 8x8", "--heatmap h.png", "h.png"},
    {"compare tiny.json --size 8x8", "--json -", "\"rmse\""},
    {"info tiny.json", "--json -", "\"memory_mb\""},
    {"explain tiny.json", "--pixel 7,9", "pixel 7,9: "},
    {"explain tiny.json --pixel 24,16 --least 1", "--least 0", "leaves the scene"},
    {"explain tiny.json --pixel 24,16", "--svg r.svg", "<svg"},
    {"explain tiny.json --pixel 24,16", "--html l.html", "<html"},
    {"explain tiny.json --pixel 24,16", "--json -", "\"schema\": 1"},
    {"merge m.exr low.exr high.exr", "--strict", "status 3"},
    {"scenes", "--json -", "\"scenes\""},
};

// These options are tested together with others: EffectsCommand, TurntableCommand, Variants and
// Program.CompareCountsAlphaAndChannels.
const Names kTestedElsewhere{"--out of effects", "--frames of effects", "--turns of turntable",
                             "--count of turntable", "--colors of compare"};
// Every command has these: Help, Program.QuietSaysNothing, Terminal and Models.
const Names kOfAllCommands{"--help", "--help-all", "--quiet", "--progress", "--variant"};

TEST_F(EveryOption, OfACommandSaysSomething) {
  // Two crops that overlap and disagree there.
  for (const char* part : {"-o low.exr --crop 0,0,48,20", "-o high.exr --crop 0,16,48,32"}) {
    const Outcome outcome = runHere(std::string("render tiny.json ") + part, folder_);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  Image high = imageIn("high.exr");
  high.at(24, 18) += Rgb(1.0f);
  writeExr(folder_ / "high.exr", high, {});

  const auto saidBy = [&](const OwnOption& row, const std::string& option) {
    const Outcome outcome = runHere(row.line + (" " + option), folder_);
    std::string all = "status " + std::to_string(outcome.status) + outcome.out + outcome.err;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
      all += entry.path().filename().string();
      if (entry.is_regular_file()) all += readFile(entry.path());
    }
    return all;
  };

  std::map<std::string, Names> tested;
  for (const OwnOption& row : kOwnOptions) {
    const std::string option = row.option;
    tested[split(row.line)[0]].insert(split(option)[0]);
    EXPECT_FALSE(hasText(saidBy(row, ""), row.says))
        << row.line << " says '" << row.says << "' without " << option;
    const std::string with = saidBy(row, option);
    EXPECT_TRUE(hasText(with, row.says))
        << row.line << " " << option << ": " << with.substr(0, 2000);
  }

  Names common = kOfAllCommands;
  for (const PictureOption& row : kPictureOptions) common.insert(std::string("--") + row.name);
  for (const LoadOption& row : kLoadOptions) common.insert(split(row.option)[0]);

  for (const auto& [command, run] : kCommandsHere) {
    if (command == "accuracy") continue;  // Its options are tested by AccuracyProgram.
    // What a shell would complete is every option of the command.
    std::istringstream lines(runHere(command + " --complete --", folder_).out);
    for (std::string line; std::getline(lines, line);) {
      const std::string name = line.substr(0, line.find('\t'));
      const bool isOfRender = command == "turntable" && tested["render"].contains(name);
      EXPECT_TRUE(common.contains(name) || tested[command].contains(name) || isOfRender ||
                  kTestedElsewhere.contains(name + " of " + command))
          << command << " " << name << " is in no row";
    }
  }
}

}  // namespace
}  // namespace whit::cli
