#!/usr/bin/env bash
# Compares image hashes under a processor that qemu-user emulates. Its approximate reciprocals, of
# which Embree makes distances, are not those of real processors, and the hashes must not depend on
# them.
#   tests/emulated.sh [WHIT-VERIFY]    the program (default: build/whit-verify)
# Without qemu-user or the program it exits 77.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
leaveOut() {
  echo "!! other processors are NOT checked: $1" >&2
  exit 77
}
[ "$(uname -m)" = x86_64 ] || leaveOut "this is not a 64-bit PC"
command -v qemu-x86_64 >/dev/null || leaveOut "there is no qemu-x86_64 (apt-get install qemu-user)"
verify=${1:-$root/build/whit-verify}
[ -x "$verify" ] || leaveOut "there is no program whit-verify"

# With AVX2 kernels under qemu 7.2 scenes with exact spheres have other hashes, or do not come to an
# end; whether the emulator or whit is wrong is not known.
timeout 900 qemu-x86_64 -cpu Westmere "$verify" --hashes 48x30 --simd sse4
