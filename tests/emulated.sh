#!/usr/bin/env bash
# Compares image hashes under processors that qemu-user emulates. Their approximate reciprocals, of
# which Embree makes distances, are not those of real processors, and the hashes must not depend on
# them. The emulator is that of Debian 13, unpacked into build/emulator: with AVX2, qemu 7.2 renders
# glass wrong.
#   tests/emulated.sh [WHIT-VERIFY]    the program (default: build/whit-verify)
# Without a network or the program it exits 77.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
leaveOut() {
  echo "!! other processors are NOT checked: $1" >&2
  exit 77
}
[ "$(uname -m)" = x86_64 ] || leaveOut "this is not a 64-bit PC"
verify=${1:-$root/build/whit-verify}
[ -x "$verify" ] || leaveOut "there is no program whit-verify"
. "$root/tests/debian13.sh"
fetchDebian13 "$root/build/emulator" amd64 qemu-user
qemu=$root/build/emulator/usr/bin/qemu-x86_64

timeout 900 "$qemu" -cpu Westmere "$verify" --hashes 48x30 --simd sse4
timeout 900 "$qemu" -cpu max "$verify" --hashes 48x30 --simd avx2
