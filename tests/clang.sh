#!/usr/bin/env bash
# Builds whit with Clang, its warnings being errors, and runs the tests of what depends most on the
# compiler: the kernels on every SIMD target, arithmetic, scenes and the readers of files.
#   tests/clang.sh [AREA...]    the tests of these folders instead of the default ones
# Without Clang it says so and succeeds; with CI=true it fails.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
areas=("$@")
[ $# -gt 0 ] || areas=(unit render io images)

if ! command -v clang++ >/dev/null; then
  echo "!! Clang is not installed: it is NOT checked (apt-get install clang)" >&2
  [ -z "${CI:-}" ]
  exit
fi
cmake --preset clang -DWHIT_WERROR=ON >/dev/null
cmake --build --preset clang --parallel "$(nproc)" --target whit "${areas[@]/%/_test}"
for area in "${areas[@]}"; do
  echo "-- $area"
  WHIT_SOURCE_DIR=$root "build-clang/tests/${area}_test" --gtest_brief=1 | tail -40
done
