#!/usr/bin/env bash
# Builds and runs the tests of some folders only: tests/areas.sh PRESET AREA...
# PRESET is one of CMakePresets.json. Two parts of a folder's tests run at a time. Without the preset's
# compiler it says so and succeeds; with CI=true it fails.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
[ $# -ge 2 ] || { echo "usage: tests/areas.sh PRESET AREA..." >&2; exit 2; }
preset=$1
shift

if [ "$preset" = clang ] && ! command -v clang++ >/dev/null; then
  echo "!! Clang is not installed: it is NOT checked (apt-get install clang)" >&2
  [ -z "${CI:-}" ]
  exit
fi
build=build-$preset
cmake --preset "$preset" -B "$build" -DWHIT_WERROR=ON >/dev/null
export HOME=$root/$build/tests/home  # the user's stays as it is
cmake --build "$build" --parallel "$(nproc)" --target "${@/%/_test}"

# part AREA INDEX: half of the area's tests, the log shown when one fails.
part() {
  local log=$build/$1.$2.log
  WHIT_SOURCE_DIR=$root GTEST_TOTAL_SHARDS=2 GTEST_SHARD_INDEX=$2 \
    "$build/tests/$1_test" --gtest_brief=1 >"$log" 2>&1 || { cat "$log"; return 1; }
  echo "$1, part $2: $(grep -o '^\[  PASSED.*' "$log")"
}
status=0
for area in "$@"; do
  part "$area" 0 &
  part "$area" 1 || status=1
  wait $! || status=1
done
exit $status
