#!/usr/bin/env bash
# Checks the programs' sources by clang-tidy, with what .clang-tidy names.
#   tests/tidy.sh          the static analyzer follows 20,000 steps of each function: minutes
#   tests/tidy.sh --deep   its own limit of 225,000 steps: a quarter of an hour
# A folder's sources are taken as one, since headers take most of the time, and kernels are those of the
# baseline target. What was clean is not checked again until something that it reads changes, if ccache is
# there to keep that. Without clang-tidy it says so and succeeds; with CI=true it fails.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
. tests/compiler_cache.sh
useCompilerCache "$root"
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
# preprocessed SOURCE: all that the compiler reads of it, with comments, which may suppress a check.
preprocessed() {
  python3 - "$1" "$build/compile_commands.json" <<'END'
import json, shlex, subprocess, sys

for entry in json.load(open(sys.argv[2])):
    if entry["file"] == sys.argv[1]:
        words = shlex.split(entry["command"])
        del words[words.index("-o"):]
        sys.exit(subprocess.run([*words, "-E", "-C", "-P", entry["file"]]).returncode)
END
}

# check SOURCE
check() {
  local word key='' clean=${CCACHE_DIR:-}/tidy
  local options=(-quiet -p "$build" -checks=-bugprone-suspicious-include)
  for word in -analyzer-config "max-nodes=$steps"; do
    options+=(--extra-arg=-Xclang "--extra-arg=$word")
  done

  if [ -n "${CCACHE_DIR:-}" ]; then
    key=$(
      {
        preprocessed "$1" | sed "s|$root||g"
        clang-tidy --version
        cat .clang-tidy
        echo "${options[*]}"
      } | sha256sum | cut -c 1-64
    )
    if [ -e "$clean/$key" ]; then return; fi
  fi
  clang-tidy "${options[@]}" "$1"
  if [ -n "$key" ]; then mkdir -p "$clean" && touch "$clean/$key"; fi
}

# What was suppressed is counted on stderr.
export root build steps
export -f preprocessed check
sources | xargs -P "$(nproc)" -I{} bash -c 'set -euo pipefail; check "$1"' bash {} \
  2> >(grep -v ' warnings generated' >&2)
