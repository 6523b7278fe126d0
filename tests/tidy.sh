#!/usr/bin/env bash
# Checks the programs' sources by clang-tidy, with what .clang-tidy names.
#   tests/tidy.sh          the static analyzer follows 20,000 steps of each function: minutes
#   tests/tidy.sh --deep   its own limit of 225,000 steps: a quarter of an hour
# A folder's sources are taken as one, since headers take most of the time, and kernels are those of the
# baseline target. Without clang-tidy it says so and succeeds; with CI=true it fails.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
build=build-tidy
steps=20000
case ${1:-} in
  "") ;;
  --deep) steps=225000 ;;
  *) echo "tests/tidy.sh: unknown option '$1' (--deep)" >&2; exit 2 ;;
esac
if ! command -v clang-tidy >/dev/null; then
  echo "!! clang-tidy is not installed: the sources are NOT checked by it" >&2
  [ -z "${CI:-}" ]
  exit
fi
cmake --preset tidy -DWHIT_WERROR=ON >/dev/null

# Every source that the build would compile, those made of most first: they take longest.
sources() {
  sed -n 's/^ *"file": "\(.*\)",*$/\1/p' $build/compile_commands.json | sort -u |
    while read -r source; do echo "$(grep -c '^#include' "$source") $source"; done | sort -rn | cut -d' ' -f2-
}
options=(-quiet -p $build -checks=-bugprone-suspicious-include)
for word in -analyzer-config "max-nodes=$steps"; do
  options+=(--extra-arg=-Xclang "--extra-arg=$word")
done
# What was suppressed is counted on stderr.
sources | xargs -P "$(nproc)" -n 1 clang-tidy "${options[@]}" 2> >(grep -v ' warnings generated' >&2)
