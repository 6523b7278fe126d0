// Command lines which people try and which whit refuses: each error leads on.
#include <algorithm>

#include "run_here.h"

namespace whit::cli {
namespace {

struct DeadEnd {
  const char* line;     // the words after "whit", separated by blanks
  const char* message;  // part of what is written to standard error
  int status = 2;       // wrong usage
};

constexpr int kBadScene = 3, kIo = 4, kLimit = 5;
constexpr const char* kAllScenes = "every scene there is: atrium, chess.glb, cornell";
constexpr const char* kSizes = "expected WIDTHxHEIGHT in pixels";
constexpr const char* kColors =
    "expected sky, transparent, white, black, or digits as ff8000 or #fff";
constexpr const char* kOutputs = "expected a name that ends in .exr or .png";

constexpr DeadEnd kDeadEnds[] = {
    // Commands
    {"atrium", "did you mean 'whit render atrium'?"},
    {"nope", "whit --help lists the commands"},
    {"rendr whitted", "did you mean 'render'?"},
    {"help rendr", "did you mean 'render'?"},
    {"--versoin", "did you mean '--version'?"},
    {"view chess.glb", "whit view is a program of its own: whit-view"},
    {"stress", "whit stress is a program of its own: whit-verify"},

    // Scenes and other operands
    {"render", "expected SCENE: a scene file, a model, or the name of a shipped scene"},
    {"render --size 64x40", "expected SCENE"},
    {"render nope", kAllScenes},
    {"render .", "'.' is a folder: name a scene file or a model in it"},
    {"render witted", "did you mean 'whitted'?"},
    {"render chess", "no scene is called 'chess'; did you mean 'chess.glb'?"},
    {"render nope.glb", "cannot open nope.glb: no such file", kIo},
    {"serve --set /lights/0/intensity=4", "expected SCENE, because --animation"},
    {"serve --camera front", "expected SCENE, because --animation"},
    {"render ?level=2", "expected a scene file, a model or the name of a shipped scene"},
    {"render whitted extra", "one word too many: 'extra'"},
    {"info", "expected SCENE"},
    {"info nope", kAllScenes},
    {"info none.json", "none.json", kIo},
    {"bench", "expected SCENE..."},
    {"bench nope", kAllScenes},
    {"turntable", "expected SCENE"},
    {"compare", "expected SCENE, or A B: a scene, or two image files"},
    {"compare whitted nope.png", "'whitted': expected one scene, or two image files"},
    {"compare a.png b.png", "cannot open a.png: no such file", kIo},
    {"compare a.png", "expected a scene (.json), a model (.3ds"},
    {"compare a.png b.png --tolerance -1", "expected a number of at least 0, found '-1'"},
    {"merge", "expected OUT.exr PART.exr...: the image to write"},
    {"merge x.exr", "expected OUT.exr PART.exr..."},
    {"scenes --all", "--all"},
    {"scenes nope", "one word too many: 'nope'"},
    {"accuracy", "expected SCENE..."},
    {"accuracy nope", "expected --out DIR"},
    {"accuracy mirrors --out out --time-budget -1", "--time-budget"},
    {"accuracy mirrors --out out --truth life", "--truth"},
    {"accuracy mirrors --out out --knobs dept", "did you mean 'depth'?"},
    {"accuracy mirrors --out out --mode reference", "leave out --mode"},
    {"effects", "--out"},
    {"effects --out x --disable sky", "--disable"},
    {"effects --out x --mode reference", "whit effects measures packets"},
    {"effects --out /proc/no/such", "/proc/no/such", kIo},
    {"explain whitted", "expected --pixel x,y"},
    {"explain whitted --pixel 3", "--pixel expected x,y, as in 240,150; found '3'"},
    {"explain whitted --pixel 3,4,5", "expected x,y"},
    {R"(explain whitted --pixel "3,4 ")", "expected x,y"},
    {R"(explain whitted --pixel "")", "expected --pixel x,y"},
    {"explain whitted --pixel 16,0 --size 16x10", "is not in the picture of 16x10"},
    {"explain whitted --pixel 9,2 --size 16x10 --crop 2,3,9,10", "with pixels 2,3 to 8,9"},
    {"explain whitted --pixel 0,0 --svg a.png", ".svg"},

    // Options of other programs
    {"render whitted --transparent", "did you mean '--background transparent'?"},
    {"render whitted --alpha", "did you mean '--background transparent'?"},
    {"render whitted --bgcolor white", "did you mean '--background'?"},
    {"render whitted --background-color white", "did you mean '--background'?"},
    {"render whitted --skybox studio", "did you mean '--sky'?"},
    {"render whitted --position 1,2,3", "did you mean '--eye'?"},
    {"render whitted --widht 64", "did you mean '--size'?"},
    {"render whitted --sise 10x10", "did you mean '--size'?"},
    {"render whitted --sise=10x10", "no option '--sise'"},
    {"render whitted -z", "no option '-z'"},
    {"render whitted -- --odd.json", "one word too many: '--odd.json'"},
    {"render whitted -q good", "did you mean '--quality'?"},
    {"render whitted --cores 2", "did you mean '--threads'?"},
    {"render whitted --no-shadows", "did you mean '--disable shadows'?"},
    {"render whitted --bg white", "did you mean '--background'?"},
    {"render whitted --env studio", "did you mean '--sky'?"},
    {"render whitted --hdri studio", "did you mean '--sky'?"},
    {"render whitted --envmap studio", "did you mean '--sky'?"},
    {"render whitted --lookat 0,0,0", "did you mean '--at'?"},
    {"render whitted --look-at 0,0,0", "did you mean '--at'?"},
    {"render whitted --from 1,2,3", "did you mean '--eye'?"},
    {"render whitted --verbose", "did you mean '--stats'?"},
    {"render whitted -v", "did you mean '--stats'?"},
    {"render whitted --samples 4", "did you mean '--spp'?"},
    {"render whitted -s 4", "did you mean '--spp'?"},
    {"render whitted --aa 4", "did you mean '--spp'?"},
    {"render whitted --width 64", "did you mean '--size'?"},
    {"render whitted --height 40", "did you mean '--size'?"},
    {"render whitted -w 64", "did you mean '--size'?"},
    {"render whitted --resolution 64x40", "did you mean '--size'?"},
    {"render whitted --res 64x40", "did you mean '--size'?"},
    {"render whitted --out x.png", "did you mean '--output'?"},
    {"render whitted -O x.png", "did you mean '--output'?"},
    {"render whitted --frame 1", "did you mean '--frames'?"},
    {"render whitted --reference", "did you mean '--mode'?"},
    {"render whitted --bounces 4", "did you mean '--depth'?"},
    {"render whitted --max-depth 4", "did you mean '--depth'?"},
    {"render whitted --tone-map filmic", "did you mean '--tonemap'?"},
    {"render whitted --gamma 2.2", "did you mean '--tonemap'?"},
    {"render whitted --gi 4", "did you mean '--indirect'?"},
    {"render whitted --ao 4", "did you mean '--ambient-samples'?"},
    {"render whitted -j 2", "did you mean '--threads'?"},
    {"render whitted --gpu", "whit render --help-all lists them"},
    {"render whitted --denoise", "whit render --help-all lists them"},
    {"bench whitted --flor", "did you mean '--floor'?"},
    {"merge --stric a.exr b.exr", "did you mean '--strict'?"},
    {"bench whitted --runs 5", "did you mean '--frames'?"},
    {"bench whitted --warmup 3", "whit bench --help-all lists them"},

    // Values
    {"render --size", "--size: expected WxH after it"},
    {"render whitted --spp --size 64x40", "--spp: expected N after it, found '--size'"},
    {"render whitted --json -o a.png", "--json: expected FILE after it, found '-o'"},
    {"info whitted --json --nope", "--json: expected FILE after it, found '--nope'"},
    {"render whitted --size 640", kSizes},
    {"render whitted --size 65537x1", "65536"},
    {"render whitted --size 0x40", kSizes},
    {"render whitted --size 99999999x9", kSizes},
    {"render whitted --spp 0", "expected a whole number from 1 to 4096, found '0'"},
    {"render whitted --spp 1.5", "expected a whole number"},
    {"render whitted --depth -1", "expected a whole number from 0 to 64, found '-1'"},
    {"render whitted --cutoff -1", "from 0 to 1"},
    {"render whitted --threads many", "expected a whole number from 0 to 1024"},
    {"render whitted --time now", "expected a number from -1e+09 to 1e+09"},
    {R"(render whitted --set /cameras/main={"eye":[0,1,5],"at":[0,1,0],"orthographicHeight":4} --fov 9)",
     "camera 'main' is orthographic and has no field of view; --ortho 0"},
    {"render whitted --fov 0", "expected a number from 0.001 to 179.9"},
    {"render whitted --zoom 0", "--zoom"},
    {"render whitted --azimuth left", "--azimuth"},
    {"render whitted --exposure bright", "expected auto or a number from -64 to 64"},
    {"render whitted --simd avx512", "did you mean 'avx3'?"},
    {"render whitted --packet 5", "expected one of auto|1|4|8|16"},
    {"render whitted --mode ref", "did you mean 'reference'?"},
    {"render whitted --quality best", "expected one of good|standard|"},
    {"render whitted --quality fine", "did you mean 'good'?"},  // a preset of former versions
    {"render whitted --tonemap aces", "expected one of none|filmic|reinhard"},
    {"render whitted --tonemap filmc", "did you mean 'filmic'?"},
    {"render whitted --robust yes", "on or off"},
    {"render whitted --disable shadow", "did you mean 'shadows'?"},
    {"render whitted --disable vertexColours", "did you mean 'vertexColors'?"},
    {"render whitted --disable nothing", "every effect there is: textures"},
    {"render whitted --background notacolor", kColors},
    {"render whitted --background #12", kColors},
    {"render whitted --eye 1,2", "expected three numbers x,y,z without blanks"},
    {"render whitted --eye 1,2,x", "x,y,z"},
    {"render whitted --eye 1,2,nan", "x,y,z"},
    {"render whitted --eye 0,0,0 --at 0,0,0", "are the same point"},
    {"render whitted --camera nope", "every camera there is: main, through, above"},
    // More triangles than the memory holds: the camera is refused before they are made.
    {"render landscape?triangles=20000000 --max-memory 0.1 --camera nope", "every camera"},
    {"info landscape?triangles=20000000 --max-memory 0.1 --camera nope", "every camera"},
    {"render chess.glb --camera front --zoom 2", "leave out --camera"},
    {"turntable chess.glb -o x.mp4 --azimuth 9 --camera a", "leave out --camera"},
    {"bench whitted --csv - --json -", "standard output takes one output"},
    {"bench whitted --csv x", "expected a name that ends in .csv"},
    {"render whitted --camera nope.json", "cannot open nope.json: no such file", kIo},
    {"render whitted --sky nope.hdr", "--sky: cannot open nope.hdr: no such file", kIo},
    {"render whitted --crop 0,0,9999,9999 --size 16x10", "must lie within the image"},
    {"render whitted --crop 4,0,4,9", "x0 < x1"},
    {"render whitted --set lights", "expected POINTER=VALUE, a JSON pointer"},
    {"render whitted --set /nope=1", "#/nope: unknown key", kBadScene},
    {"render whitted --set /lights/9/intensity=4", "expected an index below 1", kBadScene},
    {"info whitted --set /lights/0/intensitty=1", "#/lights/0/intensitty", kBadScene},
    {"info whitted --set /lights/0/intensity=true", "#/lights/0/intensity", kBadScene},
    {"compare a.exr b.exr --set /lights=[]", "--set"},
    {"compare a.exr b.exr --stages", "--stages"},
    {"compare a.exr b.exr --channels depth", "--channels needs a scene"},
    {"compare a.exr b.exr --crop 0,0,4,4", "--crop needs a scene, not two images"},
    {"compare a.exr b.exr --time 1", "--time needs a scene"},
    {"compare a.exr b.exr --sky none", "--sky"},
    {"compare a.exr b.exr --exposure auto", "--exposure"},
    {"info whitted --sphere-segments 3", "at least 4, found 3"},
    {"bench whitted --mode reference --widths", "--widths"},
    {"bench whitted --packet 8 --widths", "--packet"},
    {"bench whitted --mode reference --ab-effects", "--ab-effects are for packets"},
    {"bench whitted --widths --ab-effects", "give one of them"},
    {"bench whitted --effects all --ab-effects", "--ab-effects chooses --effects itself"},
    {"render whitted --budget 50", "as 50ms, 10s or 2min, found '50'"},
    {"render whitted --target 1", "as 0.5codes or flip=0.01, found '1'"},
    {"render whitted --budget 1s --target flip=0.1", "give one of them"},
    {"render whitted -o a.exr --budget 1s --resume", "leave out --resume"},
    {"render whitted --budget 1s --quality good", "what --quality sets"},
    {"render whitted --budget 1s --mode reference", "leave out --mode reference"},
    {"render whitted --budget 0", "expected a time of at least 1 ms, as 50ms"},
    {"render whitted --target 0", "expected an error above 0, as 0.5codes"},
    {"render whitted --frames 5..1", "5..1"},
    {"render whitted --frames a..b", "a..b"},
    {"render whitted --frames 0..1", "-o FILM.mp4"},
    {"render whitted -o a#.exr --frames 1 --camera through", "--camera"},
    {"render orrery -o a#.exr --frames 0..1 --time 1", "give one"},
    {"render cornell -o a#.exr --frames 0..1", "nothing moves in"},
    {"turntable chess.glb --count 0", "expected a whole number from 1"},

    // Files to write
    {"render whitted -o x", kOutputs},
    {"render whitted -o x.gif", kOutputs},
    {"render whitted -o x.exr --frames 0..1", "####"},
    {"render whitted -o x####.exr", "no --frames A..B"},
    {"render whitted -o x.exr --size 65536x65536", "--max-memory", kLimit},
    {"render whitted -o - -o -", "-o -"},
    {"render whitted -o - --json -", "-o -"},
    {"render whitted -o - --resume", "-o -"},
    {"render whitted -o x.jpg --background transparent", "has no alpha"},
    {"render whitted -o x.jpg --resume", "JPEG"},
    {"render whitted -o x.exr --json nofolder/x.json", "there is no folder", kIo},
    {"render whitted -o nofolder/x.png", "there is no folder 'nofolder'", kIo},
    {"render whitted -o x.depth.jpg", "a JPEG holds no channel: write 'x.depth.png'"},
    {"render orrery --frames 0..1 -o x.depth.mp4", "a film holds no channel: write 'x.d"},
    {"render whitted -o x.error.png", "one sample leaves the error unknown: add --spp 2 or more"},
    {"render whitted -o x.png --channels depth", "expected an EXR to keep depth in"},
    {"render whitted -o x.normal.exr --channels depth,normal", "an EXR to keep depth in"},
    {"render whitted -o x.position.png", "positions do not fit into a PNG"},
    {"render whitted -o x.motion.png", "motions do not fit into a PNG"},
    {"render whitted -o x.depht.png", "no channel is called 'depht'; did you mean 'depth'?"},
    {"render whitted -o x.Normals.##.exr --frames 0..1", "did you mean 'normal'?"},
    {"render whitted -o x.exr --channels depth --exr dwaa", "dwaa is lossy for channels"},
    {"render whitted -o x.exr --channels deepth", "did you mean 'depth'?"},
    {"turntable whitted", "expected a file to write"},
    {"turntable whitted -o x.gif", "ends in .exr or .png or .jpg or .jpeg or .mp4"},
    {"turntable whitted -o x.mp4 -o y.mp4", "one film"},
    {"turntable whitted -o x.mp4 --resume", "--resume"},
    {"turntable whitted -o x.png", "####"},
    {"turntable whitted -o x.mp4 --size 31x20", "even numbers"},
    {"turntable whitted -o x#.png --frames 4..2", "--frames"},
    {"turntable whitted -o nofolder/x.mp4", "there is no folder", kIo},
    {"compare whitted --heatmap x.exr", ".png"},
    {"effects --out", "--out: expected DIR after it"},
};

TEST(DeadEnds, EachErrorLeadsOn) {
  for (const DeadEnd& end : kDeadEnds) {
    SCOPED_TRACE(std::string("whit ") + end.line);
    const TemporaryFolder folder;
    const std::string command = split(end.line)[0];
    // Only what is no command, and what belongs to the viewer, needs the program.
    const Outcome outcome =
        kCommandsHere.contains(command)
            ? runHere(end.line, folder)
            : runWhit(split(end.line), [&] { (void)chdir(folder.path().c_str()); });

    expectFailed(outcome, end.status, end.message);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "a file is left";
  }
}

}  // namespace
}  // namespace whit::cli
