#!/bin/sh
# Builds the examples against what is installed and compares their pictures with the program's:
# embed_test.sh BUILD-FOLDER CMAKE C++-COMPILER GENERATOR MAKE-PROGRAM
set -eu

here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$2" --install "$1" --prefix "$work/usr" >/dev/null
"$2" -G "$4" -DCMAKE_MAKE_PROGRAM="$5" -S "$here" -B "$work/build" \
  -DCMAKE_PREFIX_PATH="$work/usr" -DCMAKE_CXX_COMPILER="$3" \
  -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror" >"$work/log" || { cat "$work/log"; exit 1; }
"$2" --build "$work/build" >"$work/log" || { cat "$work/log"; exit 1; }

# Elsewhere than beside the scenes, and with one that exists only among the installed ones.
scenes=$work/usr/share/whit/scenes
cp "$scenes/whitted.json" "$scenes/only-installed.json"
cd "$work"
build/embed only-installed embedded.exr
usr/bin/whit render only-installed -o rendered.exr --size 96x60 --depth 4 --quiet
# Bit for bit; what the files say about themselves differs.
usr/bin/whit compare embedded.exr rendered.exr --tolerance 0 --quiet >log || { cat log; exit 1; }

# The last frame of the loop.
build/loop only-installed looped.exr >said
eye=$(sed -n 's/^last: --eye //p' said)
usr/bin/whit render only-installed -o rendered.exr --size 96x60 --depth 4 --quiet --eye "$eye" \
  --set /lights/0/intensity=550
usr/bin/whit compare looped.exr rendered.exr --tolerance 0 --quiet >log || { cat log; exit 1; }

# The scene made in memory, from files.
build/made made.png | grep -qx '8192 triangles'
awk 'BEGIN {
  side = 65
  print "s off"
  for (row = 0; row < side; ++row) for (column = 0; column < side; ++column) {
    x = column / 32 - 1; z = row / 32 - 1
    printf "v %.9g %.9g %.9g\n", x, 0.25 * cos(7 * sqrt(x * x + z * z)), z
  }
  for (row = 0; row + 1 < side; ++row) for (column = 0; column + 1 < side; ++column) {
    a = row * side + column + 1; b = a + side  # OBJ counts from 1
    printf "f %d %d %d\nf %d %d %d\n", a, b, b + 1, a, b + 1, a + 1
  }
}' >sheet.obj
cat >sheet.json <<'END'
{"whit": 1, "sky": {"color": [0.4, 0.5, 0.7]}, "ambient": {"fromSky": 0.5},
 "lights": [{"position": [2, 4, 1], "intensity": [60, 60, 60]}],
 "cameras": {"front": {"eye": [0, 2, 3], "at": [0, 0, 0]}},
 "scene": [{"model": "sheet.obj",
            "materials": {"*": {"diffuse": [0.8, 0.2, 0.1], "mirror": [0.1, 0.1, 0.1]}}}]}
END
usr/bin/whit render sheet.json -o sheet.png --size 160x100 --spp 4 --quiet
usr/bin/whit compare made.png sheet.png --tolerance 0 --quiet >log || { cat log; exit 1; }

# By pkg-config as well, if it is there.
if command -v pkg-config >/dev/null; then
  pc=$(find "$work/usr" -name whit.pc)
  PKG_CONFIG_PATH=$(dirname "$pc")
  export PKG_CONFIG_PATH
  test "whit $(pkg-config --modversion whit)" = "$(usr/bin/whit --version | head -1)"
  "$3" -std=c++20 "$here/embed.cpp" \
    $(pkg-config --cflags --libs whit) -o packaged
  LD_LIBRARY_PATH=$(pkg-config --variable=libdir whit) ./packaged only-installed packaged.exr
  cmp packaged.exr embedded.exr
else
  echo "!! pkg-config is not installed: whit.pc is NOT checked" >&2
fi

status=0
build/embed no-such-scene none.exr 2>said || status=$?
test "$status" = 2
grep -q 'no-such-scene' said
echo "embedded: 1 passed"
