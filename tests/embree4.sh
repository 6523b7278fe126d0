#!/usr/bin/env bash
# Builds whit with Debian 13's Embree 4 and Highway 1.2 beside a system that has others, and runs
# the tests that reach them; with another compiler than CMake's default when CXX names it, and then
# those of pictures only. Nothing is installed: their packages are unpacked into
# build-embree4/debian13, and programs start with the C library that is among them.
#   tests/embree4.sh            fetch if not there, build, test
#   tests/embree4.sh --fetch    fetch only
#   tests/embree4.sh --differ   build, and compare its pictures with those of build/whit
# On another machine than a 64-bit PC it says so and succeeds, but with CI=true it fails; without a
# network it exits 77.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build-embree4${CXX:+-$(basename "$CXX")}
sysroot=$root/build-embree4/debian13
libraries=$sysroot/usr/lib/x86_64-linux-gnu
# What meets rays, or differs with the width of vectors.
areas=(render)
batches=()
case ${CXX:-} in
  "") areas+=(hard) ;;
  *clang*) batches=(-DCMAKE_UNITY_BUILD_BATCH_SIZE=0) ;;
esac

leaveOut() {
  echo "!! Embree 4 is NOT checked: $1" >&2
  if [ -n "${CI:-}" ]; then exit 1; fi
  exit 0
}

. "$root/tests/debian13.sh"
. "$root/tests/picture_table.sh"

configure() {
  local embree flags
  embree=$(echo "$libraries"/cmake/embree-4*)
  flags="-Wl,--allow-shlib-undefined,--disable-new-dtags,-rpath,$libraries"
  flags+=",--dynamic-linker,$libraries/ld-linux-x86-64.so.2"
  cmake -G Ninja -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release -DWHIT_WERROR=ON "${batches[@]}" \
    -DWHIT_EMBREE=4 -Dembree_DIR="$embree" -Dhwy_DIR="$libraries/cmake/hwy" \
    -DCMAKE_EXE_LINKER_FLAGS="$flags" >/dev/null
}

compile() {
  cmake --build "$build" --parallel "$(nproc)" --target "$@"
}

# What a program was built with, "4.3.3 avx2".
embreeOf() {
  "$1" bench matte --size 8x8 --frames 1 --json - --quiet | sed -n 's/.*"embree": "\(.*\)".*/\1/p' | head -1
}

runTests() {
  local area
  for area in "${areas[@]}"; do
    readelf -d "$build/tests/${area}_test" | grep -o 'libembree4' >/dev/null ||
      { echo "tests/embree4.sh: ${area}_test does not link Embree 4" >&2; return 1; }
  done
  for area in "${areas[@]}"; do
    echo "-- $area"
    (cd "$build" && WHIT_SOURCE_DIR=$root "tests/${area}_test" --gtest_brief=1 >"$area.log") ||
      { cat "$build/$area.log"; return 1; }
    tail -2 "$build/$area.log" | head -1
  done
}

# The shipped scenes by both, as a table.
differ() {
  local scene work other=$root/build/whit
  [ -x "$other" ] || { echo "tests/embree4.sh: there is no $other to compare with" >&2; return 2; }
  work=$(mktemp -d)
  # shellcheck disable=SC2064  # the folder of now
  trap "rm -rf '$work'" EXIT
  echo "Embree $(embreeOf "$build/whit") against Embree $(embreeOf "$other")"
  tableHead scene
  for scene in $(tableScenes); do
    "$build/whit" render "$scene" --size 480x300 -o "$work/4.exr" --quiet
    "$other" render "$scene" --size 480x300 -o "$work/3.exr" --quiet
    tableRow "$scene" "$other" "$work/4.exr" "$work/3.exr"
  done
}

# Nothing to unpack where the system has it.
if [ -n "$(dpkg-query -W -f='${db:Status-Status}' libembree4-4 2>/dev/null | grep -x installed)" ]; then
  echo "The system's own Embree is 4: every other step of tests/run.sh tests it"
  exit 0
fi
case ${1:-} in
  "" | --fetch | --differ) ;;
  *) echo "tests/embree4.sh: unknown option '$1' (--fetch, --differ)" >&2; exit 2 ;;
esac
[ "$(uname -m)" = x86_64 ] || leaveOut "this is not a 64-bit PC"
fetchDebian13 "$sysroot" amd64 libembree-dev libhwy-dev
[ "${1:-}" = --fetch ] && exit
configure
if [ "${1:-}" = --differ ]; then
  compile whit
  differ
else
  compile "${areas[@]/%/_test}" whit-verify
  runTests
  "$build/whit-verify" --hashes 48x30
fi
