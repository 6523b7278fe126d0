#!/usr/bin/env bash
# Builds whit for 64-bit ARM (NEON kernels, Debian 13's Embree 4) on a PC, and runs tests of kernels
# and pictures under qemu-user. Nothing is installed: Debian 13's arm64 packages are unpacked into
# build-aarch64/debian13. Needs g++-aarch64-linux-gnu and qemu-user.
#   tests/aarch64.sh [FILTER]    other tests of tests/render than the default ones, as googletest
#                                filters them
# Without the compiler or qemu it says so and succeeds, but with CI=true it fails; without a network it
# exits 77.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build-aarch64
sysroot=$build/debian13
libraries=$sysroot/usr/lib/aarch64-linux-gnu
# Large scenes would take minutes under emulation.
filter=${1:-AlphaMap.*:Analytic.*:EncodeDisplay.*:*/StagesOfScenes.*}

leaveOut() {
  echo "!! 64-bit ARM is NOT checked: $1" >&2
  if [ -n "${CI:-}" ]; then exit 1; fi
  exit 0
}
. "$root/tests/debian13.sh"

for program in aarch64-linux-gnu-g++ qemu-aarch64; do
  command -v $program >/dev/null ||
    leaveOut "no $program (apt-get install g++-aarch64-linux-gnu qemu-user)"
done
fetchDebian13 "$sysroot" arm64 libembree-dev libhwy-dev libopenexr-dev libpng-dev libjpeg-dev \
  nlohmann-json3-dev libxxhash-dev zlib1g-dev libgtest-dev libbenchmark-dev

cat >"$build/toolchain.cmake" <<END
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH $sysroot)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_CROSSCOMPILING_EMULATOR "qemu-aarch64;-L;$sysroot")
set(CMAKE_EXE_LINKER_FLAGS_INIT
    "-Wl,--allow-shlib-undefined,-rpath-link,$libraries")
# Debian 13's static libraries call what only its own C and C++ libraries have.
set(CMAKE_CXX_STANDARD_LIBRARIES "$libraries/libstdc++.so.6 $libraries/libc.so.6")
END
cmake -G Ninja -S "$root" -B "$build" -DCMAKE_TOOLCHAIN_FILE="$build/toolchain.cmake" \
  -DCMAKE_BUILD_TYPE=Release -DWHIT_WERROR=ON >"$build/configure.log" 2>&1 ||
  { cat "$build/configure.log"; exit 1; }
cmake --build "$build" --parallel "$(nproc)" --target whit whit-verify render_test

emulated() { WHIT_SOURCE_DIR=$root qemu-aarch64 -L "$sysroot" "$@"; }
emulated "$build/whit" bench matte --size 8x8 --frames 1 --json - --quiet |
  grep -E '"(simd|embree|packet)"'
emulated "$build/whit-verify" --hashes 48x30
# Hard cases of glass, of codes of what is no color, and of deep paths.
emulated "$build/whit-verify" --only H38,H43,H58,H62,H63
emulated "$build/tests/render_test" --gtest_filter="$filter" --gtest_brief=1 | tail -40
