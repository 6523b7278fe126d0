#!/usr/bin/env bash
# From a fresh checkout to a picture: installs what is missing, builds, renders the atrium to
# build/demo/, and opens the viewer where there is a display. Needs no network after the first run.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build
out=$build/demo

"$root/scenes/install_packages.sh" build
"$root/scenes/install_packages.sh" view || echo "Going on without the viewer." >&2

if [ -f "$build/CMakeCache.txt" ]; then
  cmake -DCMAKE_BUILD_TYPE=Release "$build" >/dev/null  # whatever generator it was made with
else
  (cd "$root" && cmake --preset release >/dev/null)
fi
# The flags of tests/run.sh, which need not compile anything again then.
cmake -DWHIT_WERROR="${CI:+ON}" "$build" >/dev/null
embree=$(sed -n 's/^WHIT_EMBREE_MAJOR:INTERNAL=//p' "$build/CMakeCache.txt")
echo "Building with Embree $embree."
if [ "$embree" = 4 ]; then
  echo "It has no streams of packets: with AVX2 and without AVX-512, frames take 7 to 16 % longer" \
       "than with Embree 3 (-DWHIT_EMBREE=3)."
fi
# The picture comes first: the viewer is built after it.
cmake --build "$build" --parallel "$(nproc)" --target whit

mkdir -p "$out"
"$build/whit" render atrium --size 1280x720 -o "$out/atrium.png" -o "$out/atrium.exr" --quiet
echo "Written: $out/atrium.png and $out/atrium.exr"
# The table is that of warm frames: the first one also pays for memory that is touched for the first
# time.
"$build/whit" bench atrium --size 1280x720 --frames 10 --progress never
cmake --build "$build" --parallel "$(nproc)" --target programs

if [ -s "$build/left_out.txt" ]; then
  echo "Left out of this build: $(cat "$build/left_out.txt")" >&2
  [ -z "${CI:-}" ]
fi
if [ -x "$build/whit-view" ] && [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  exec "$build/whit-view" atrium
fi
