// Command lines which people try and which whit refuses: each error leads on.
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "has_text.h"
#include "run_command.h"

namespace whit::cli {
namespace {

struct DeadEnd {
  const char* line;  // the words after "whit", separated by blanks
  int status;
  const char* message;  // part of what is written to standard error
};

constexpr int kUsage = 2, kBadScene = 3, kIo = 4, kLimit = 5;
constexpr const char* kAllScenes = "every scene there is: atrium, chess.glb, cornell";
constexpr const char* kSizes = "expected WIDTHxHEIGHT in pixels";
constexpr const char* kColors =
    "expected sky, transparent, white, black, or digits as ff8000 or #fff";
constexpr const char* kOutputs = "expected a name that ends in .exr or .png";

constexpr DeadEnd kDeadEnds[] = {
    // Commands
    {"atrium", kUsage, "did you mean 'whit render atrium'?"},
    {"chess.glb", kUsage, "did you mean 'whit render chess.glb'?"},
    {"nope", kUsage, "whit --help lists the commands"},
    {"rendr whitted", kUsage, "did you mean 'render'?"},
    {"help rendr", kUsage, "did you mean 'render'?"},
    {"--versoin", kUsage, "did you mean '--version'?"},
    {"view chess.glb", kUsage, "whit view is a program of its own: whit-view"},
    {"stress", kUsage, "whit stress is a program of its own: whit-verify"},

    // Scenes and other operands
    {"render", kUsage, "expected SCENE: a scene file, a model, or the name of a shipped scene"},
    {"render --size 64x40", kUsage, "expected SCENE"},
    {"render nope", kUsage, kAllScenes},
    {"render .", kUsage, "'.' is a folder: name a scene file or a model in it"},
    {"render witted", kUsage, "did you mean 'whitted'?"},
    {"render chess", kUsage, "no scene is called 'chess'; did you mean 'chess.glb'?"},
    {"render nope.glb", kIo, "cannot open nope.glb: no such file"},
    {"serve --set /lights/0/intensity=4", kUsage, "expected SCENE, because --animation"},
    {"render ?level=2", kUsage, "expected a scene file, a model or the name of a shipped scene"},
    {"render whitted -o a.png -o a.png", kUsage, "cannot write 'a.png': it is the same as 'a.png'"},
    {"render whitted extra", kUsage, "one word too many: 'extra'"},
    {"info", kUsage, "expected SCENE"},
    {"info nope", kUsage, kAllScenes},
    {"info none.json", kIo, "none.json"},
    {"bench", kUsage, "expected SCENE..."},
    {"bench nope", kUsage, kAllScenes},
    {"turntable", kUsage, "expected SCENE"},
    {"compare", kUsage, "expected SCENE, or A B: a scene, or two image files"},
    {"compare whitted nope.png", kUsage, "'whitted': expected one scene, or two image files"},
    {"compare a.png b.png", kIo, "cannot open a.png: no such file"},
    {"compare a.png", kUsage, "expected a scene (.json), a model (.3ds"},
    {"compare a.png b.png --tolerance -1", kUsage, "expected a number of at least 0, found '-1'"},
    {"merge", kUsage, "expected OUT.exr PART.exr...: the image to write"},
    {"merge x.exr", kUsage, "expected OUT.exr PART.exr..."},
    {"scenes --all", kUsage, "--all"},
    {"scenes nope", kUsage, "one word too many: 'nope'"},
    {"accuracy", kUsage, "expected SCENE..."},
    {"accuracy nope", kUsage, "expected --out DIR"},
    {"accuracy mirrors --out out --time-budget -1", kUsage, "--time-budget"},
    {"accuracy mirrors --out out --truth life", kUsage, "--truth"},
    {"accuracy mirrors --out out --knobs dept", kUsage, "did you mean 'depth'?"},
    {"accuracy mirrors --out out --mode reference", kUsage, "leave out --mode"},
    {"effects", kUsage, "--out"},
    {"effects --out x --disable sky", kUsage, "--disable"},
    {"effects --out x --mode reference", kUsage, "whit effects measures packets"},
    {"effects --out /proc/no/such", kIo, "/proc/no/such"},
    {"explain whitted", kUsage, "expected --pixel x,y"},
    {"explain whitted --pixel 3", kUsage, "--pixel expected x,y, as in 240,150; found '3'"},
    {"explain whitted --pixel 3,", kUsage, "expected x,y"},
    {"explain whitted --pixel a,b", kUsage, "expected x,y"},
    {"explain whitted --pixel 3,4,5", kUsage, "expected x,y"},
    {"explain whitted --pixel 16,0 --size 16x10", kUsage, "is not in the picture of 16x10"},
    {"explain whitted --pixel 0,-1 --size 16x10", kUsage, "is not in the picture of 16x10"},
    {"explain whitted --pixel 0,0 --svg a.png", kUsage, ".svg"},

    // Options of other programs
    {"render whitted --transparent", kUsage, "did you mean '--background transparent'?"},
    {"render whitted --alpha", kUsage, "did you mean '--background transparent'?"},
    {"render whitted --bgcolor white", kUsage, "did you mean '--background'?"},
    {"render whitted --background-color white", kUsage, "did you mean '--background'?"},
    {"render whitted --skybox studio", kUsage, "did you mean '--sky'?"},
    {"render whitted --position 1,2,3", kUsage, "did you mean '--eye'?"},
    {"render whitted --widht 64", kUsage, "did you mean '--size'?"},
    {"render whitted -q good", kUsage, "did you mean '--quality'?"},
    {"render whitted --cores 2", kUsage, "did you mean '--threads'?"},
    {"render whitted --no-shadows", kUsage, "did you mean '--disable shadows'?"},
    {"render whitted --bg white", kUsage, "did you mean '--background'?"},
    {"render whitted --env studio", kUsage, "did you mean '--sky'?"},
    {"render whitted --hdri studio", kUsage, "did you mean '--sky'?"},
    {"render whitted --envmap studio", kUsage, "did you mean '--sky'?"},
    {"render whitted --lookat 0,0,0", kUsage, "did you mean '--at'?"},
    {"render whitted --look-at 0,0,0", kUsage, "did you mean '--at'?"},
    {"render whitted --from 1,2,3", kUsage, "did you mean '--eye'?"},
    {"render whitted --verbose", kUsage, "did you mean '--stats'?"},
    {"render whitted -v", kUsage, "did you mean '--stats'?"},
    {"render whitted --samples 4", kUsage, "did you mean '--spp'?"},
    {"render whitted -s 4", kUsage, "did you mean '--spp'?"},
    {"render whitted --aa 4", kUsage, "did you mean '--spp'?"},
    {"render whitted --width 64", kUsage, "did you mean '--size'?"},
    {"render whitted --height 40", kUsage, "did you mean '--size'?"},
    {"render whitted -w 64", kUsage, "did you mean '--size'?"},
    {"render whitted --resolution 64x40", kUsage, "did you mean '--size'?"},
    {"render whitted --res 64x40", kUsage, "did you mean '--size'?"},
    {"render whitted --out x.png", kUsage, "did you mean '--output'?"},
    {"render whitted -O x.png", kUsage, "did you mean '--output'?"},
    {"render whitted --frame 1", kUsage, "did you mean '--frames'?"},
    {"render whitted --reference", kUsage, "did you mean '--mode'?"},
    {"render whitted --bounces 4", kUsage, "did you mean '--depth'?"},
    {"render whitted --max-depth 4", kUsage, "did you mean '--depth'?"},
    {"render whitted --tone-map filmic", kUsage, "did you mean '--tonemap'?"},
    {"render whitted --gamma 2.2", kUsage, "did you mean '--tonemap'?"},
    {"render whitted --gi 4", kUsage, "did you mean '--indirect'?"},
    {"render whitted --ao 4", kUsage, "did you mean '--ambient-samples'?"},
    {"render whitted -j 2", kUsage, "did you mean '--threads'?"},
    {"render whitted --gpu", kUsage, "whit render --help-all lists them"},
    {"render whitted --denoise", kUsage, "whit render --help-all lists them"},
    {"bench whitted --flor", kUsage, "did you mean '--floor'?"},
    {"merge --stric a.exr b.exr", kUsage, "did you mean '--strict'?"},
    {"render whitted --width=100", kUsage, "did you mean '--size'?"},
    {"bench whitted --runs 5", kUsage, "did you mean '--frames'?"},
    {"bench whitted --warmup 3", kUsage, "whit bench --help-all lists them"},

    // Values
    {"render --size", kUsage, "--size: expected WxH after it"},
    {"render whitted --spp --size 64x40", kUsage, "--spp: expected N after it, found '--size'"},
    {"render whitted --json -o a.png", kUsage, "--json: expected FILE after it, found '-o'"},
    {"info whitted --json --nope", kUsage, "--json: expected FILE after it, found '--nope'"},
    {"render whitted --size 640", kUsage, kSizes},
    {"render whitted --size 640*480", kUsage, kSizes},
    {"render whitted --size 0x40", kUsage, kSizes},
    {"render whitted --size 99999999x9", kUsage, kSizes},
    {"render whitted --spp 0", kUsage, "expected a whole number from 1 to 4096, found '0'"},
    {"render whitted --spp many", kUsage, "expected a whole number from 1 to 4096"},
    {"render whitted --depth -1", kUsage, "expected a whole number from 0 to 64, found '-1'"},
    {"render whitted --threads many", kUsage, "expected a whole number from 0 to 1024"},
    {"render whitted --time now", kUsage, "expected a number from -1e+09 to 1e+09"},
    {R"(render whitted --set /cameras/main={"eye":[0,1,5],"at":[0,1,0],"orthographicHeight":4} --fov 9)",
     kUsage, "camera 'main' is orthographic and has no field of view; --ortho 0"},
    {"render whitted --fov 0", kUsage, "expected a number from 0.001 to 179.9"},
    {"render whitted --exposure bright", kUsage, "expected auto or a number from -64 to 64"},
    {"render whitted --simd avx512", kUsage, "did you mean 'avx3'?"},
    {"render whitted --packet 32", kUsage, "expected one of auto|1|4|8|16"},
    {"render whitted --mode ref", kUsage, "did you mean 'reference'?"},
    {"render whitted --quality best", kUsage, "expected one of good|standard|"},
    {"render whitted --tonemap aces", kUsage, "expected one of none|filmic|reinhard"},
    {"render whitted --disable shadow", kUsage, "did you mean 'shadows'?"},
    {"render whitted --disable nothing", kUsage, "every effect there is: textures"},
    {"render whitted --background notacolor", kUsage, kColors},
    {"render whitted --background #12", kUsage, kColors},
    {"render whitted --eye 1,2", kUsage, "expected three numbers x,y,z without blanks"},
    {"render whitted --eye 0,0,0 --at 0,0,0", kUsage, "are the same point"},
    {"render whitted --camera nope", kUsage, "every camera there is: main, through, above"},
    // More triangles than the memory holds: the camera is refused before they are made.
    {"render landscape?triangles=20000000 --max-memory 0.1 --camera nope", kUsage, "every camera"},
    {"info landscape?triangles=20000000 --max-memory 0.1 --camera nope", kUsage, "every camera"},
    {"render chess.glb --camera front --zoom 2", kUsage, "leave out --camera"},
    {"turntable chess.glb -o x.mp4 --azimuth 9 --camera a", kUsage, "leave out --camera"},
    {"bench whitted --csv - --json -", kUsage, "standard output takes one output"},
    {"bench whitted --csv x", kUsage, "expected a name that ends in .csv"},
    {"render whitted --camera nope.json", kIo, "cannot open nope.json: no such file"},
    {"render whitted --sky nope.hdr", kIo, "--sky: cannot open nope.hdr: no such file"},
    {"render whitted --crop 0,0,9999,9999 --size 16x10", kUsage, "must lie within the image"},
    {"render whitted --set lights", kUsage, "expected POINTER=VALUE, a JSON pointer"},
    {"render whitted --set /nope=1", kBadScene, "#/nope: unknown key"},
    {"render whitted --set /lights/9/intensity=4", kBadScene, "expected an index below 1"},
    {"info whitted --set /lights/0/intensitty=1", kBadScene, "#/lights/0/intensitty"},
    {"info whitted --set /lights/0/intensity=true", kBadScene, "#/lights/0/intensity"},
    {"compare a.exr b.exr --set /lights=[]", kUsage, "--set"},
    {"compare a.exr b.exr --stages", kUsage, "--stages"},
    {"compare a.exr b.exr --channels depth", kUsage, "--channels needs a scene"},
    {"compare a.exr b.exr --sky none", kUsage, "--sky"},
    {"compare a.exr b.exr --exposure auto", kUsage, "--exposure"},
    {"bench whitted --mode reference --widths", kUsage, "--widths"},
    {"bench whitted --packet 8 --widths", kUsage, "--packet"},
    {"render whitted --budget 50", kUsage, "as 50ms, 10s or 2min, found '50'"},
    {"render whitted --target 1", kUsage, "as 0.5codes or flip=0.01, found '1'"},
    {"render whitted --budget 1s --target flip=0.1", kUsage, "give one of them"},
    {"render whitted -o a.exr --budget 1s --resume", kUsage, "leave out --resume"},
    {"render whitted --budget 1s --quality good", kUsage, "what --quality sets"},
    {"render whitted --budget 1s --mode reference", kUsage, "leave out --mode reference"},
    {"render whitted --budget 0", kUsage, "expected a time of at least 1 ms, as 50ms"},
    {"render whitted --target 0", kUsage, "expected an error above 0, as 0.5codes"},
    {"render whitted --frames 5..1", kUsage, "5..1"},
    {"render whitted --frames a..b", kUsage, "a..b"},
    {"render whitted --frames 0..1", kUsage, "-o FILM.mp4"},
    {"render whitted -o a#.exr --frames 1 --camera through", kUsage, "--camera"},
    {"render orrery -o a#.exr --frames 0..1 --time 1", kUsage, "give one"},
    {"render cornell -o a#.exr --frames 0..1", kUsage, "nothing moves in"},
    {"turntable chess.glb --count 0", kUsage, "expected a whole number from 1"},

    // Files to write
    {"render whitted -o x", kUsage, kOutputs},
    {"render whitted -o x.gif", kUsage, kOutputs},
    {"render whitted -o x.exr --frames 0..1", kUsage, "####"},
    {"render whitted -o x####.exr", kUsage, "no --frames A..B"},
    {"render whitted -o x.exr --size 65536x65536", kLimit, "--max-memory"},
    {"render whitted -o - -o -", kUsage, "-o -"},
    {"render whitted -o - --json -", kUsage, "-o -"},
    {"render whitted -o - --resume", kUsage, "-o -"},
    {"render whitted -o x.jpg --background transparent", kUsage, "has no alpha"},
    {"render whitted -o x.jpg --resume", kUsage, "JPEG"},
    {"render whitted -o x.exr --json nofolder/x.json", kIo, "there is no folder"},
    {"render whitted -o nofolder/x.png", kIo, "there is no folder 'nofolder'"},
    {"render whitted -o x.depth.jpg", kUsage, "a JPEG holds no channel: write 'x.depth.png'"},
    {"render orrery --frames 0..1 -o x.depth.mp4", kUsage, "a film holds no channel: write 'x.d"},
    {"render whitted -o x.error.png", kUsage,
     "one sample leaves the error unknown: add --spp 2 or more"},
    {"render whitted -o x.png --channels depth", kUsage, "expected an EXR to keep depth in"},
    {"render whitted -o x.normal.exr --channels depth,normal", kUsage, "an EXR to keep depth in"},
    {"render whitted -o x.position.png", kUsage, "positions do not fit into a PNG"},
    {"render whitted -o x.motion.png", kUsage, "motions do not fit into a PNG"},
    {"render whitted -o x.depht.png", kUsage,
     "no channel is called 'depht'; did you mean 'depth'?"},
    {"render whitted -o x.Normals.##.exr --frames 0..1", kUsage, "did you mean 'normal'?"},
    {"render whitted -o x.exr --channels depth --exr dwaa", kUsage, "dwaa is lossy for channels"},
    {"render whitted -o x.exr --channels deepth", kUsage, "did you mean 'depth'?"},
    {"turntable whitted", kUsage, "expected a file to write"},
    {"turntable whitted -o x.gif", kUsage, "ends in .exr or .png or .jpg or .jpeg or .mp4"},
    {"turntable whitted -o x.mp4 -o y.mp4", kUsage, "one film"},
    {"turntable whitted -o x.mp4 --resume", kUsage, "--resume"},
    {"turntable whitted -o x.png", kUsage, "####"},
    {"turntable whitted -o x.mp4 --size 31x20", kUsage, "even numbers"},
    {"turntable whitted -o x#.png --frames 4..2", kUsage, "--frames"},
    {"turntable whitted -o nofolder/x.mp4", kIo, "there is no folder"},
    {"compare whitted --heatmap x.exr", kUsage, ".png"},
    {"effects --out", kUsage, "--out: expected DIR after it"},
};

TEST(DeadEnds, EachErrorLeadsOn) {
  for (const DeadEnd& end : kDeadEnds) {
    SCOPED_TRACE(std::string("whit ") + end.line);
    std::istringstream line(end.line);
    const Words words{std::istream_iterator<std::string>(line), {}};

    const TemporaryFolder folder;
    const auto enter = [&] { (void)chdir(folder.path().c_str()); };
    const Outcome outcome = runWhit(words, enter);

    expectFailed(outcome, end.status, end.message);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "a file is left";
  }
}

}  // namespace
}  // namespace whit::cli
