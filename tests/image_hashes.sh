#!/usr/bin/env bash
# Prints the image hash of every shipped scene with the choices that must not, or must, change bits,
# a line each: to hold a change that leaves pictures alone against the program before it.
#   tests/image_hashes.sh [WHIT]                   prints them (WHIT: a program, default build/whit)
#   tests/image_hashes.sh --quick [WHIT]           small pictures, fewer choices: a minute
#   tests/image_hashes.sh --compare FILE [WHIT]    and compares them with what was printed to FILE
# sponza-mirror needs its model ($WHIT_DATA); it is left out, loudly, where that is missing. Exits 1
# when a hash differs or a picture cannot be made.
set -uo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
quick=false
expected=
while [ $# -gt 0 ]; do
  case $1 in
    --quick) quick=true ;;
    --compare) expected=${2:?--compare takes a file}; shift ;;
    -*) echo "tests/image_hashes.sh: unknown option '$1' (--quick, --compare FILE)" >&2; exit 2 ;;
    *) break ;;
  esac
  shift
done
whit=${1:-$root/build/whit}
[ -x "$whit" ] || { echo "tests/image_hashes.sh: no program $whit" >&2; exit 2; }
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

targets=()
for target in avx3 avx2 sse4 sse2 scalar neon; do
  "$whit" render "$root/scenes/hard/tiny.json" --size 2x2 --simd $target -o "$out/none.exr" --quiet \
    2>/dev/null && targets+=("$target")
done

# hashOf SCENE OPTIONS...: one line of the list.
hashOf() {
  local scene=$1 hash
  shift
  if "$whit" render "$scene" "$@" -o "$out/image.exr" --json "$out/image.json" --quiet 2>"$out/error"; then
    hash=$(sed -n 's/.*"image_hash": *"\([0-9a-f]*\)".*/\1/p' "$out/image.json")
  else
    hash="failed: $(head -n 1 "$out/error")"
  fi
  echo "${scene#"$root"/scenes/} $* ${hash:-no hash}"
}

# Choices that each scene is rendered with, a line each.
choices() {
  local target packet
  for target in "${targets[@]}"; do
    for packet in 1 4 8 16; do echo "--simd $target --packet $packet"; done
  done
  echo "--spp 4"
  echo "--spp 8 --adaptive on"
  echo "--batch frame"
  echo "--mode reference"
  echo "--effects all"
  echo "--queue 100 --tile 24 --threads 3"
  echo "--spp 2 --glossy 4 --texture-filter trilinear --terminator on"
  echo "--mode reference --spp 2 --glossy 4 --texture-filter trilinear --terminator on"
}

if $quick; then
  sizes=(160x100)
  choices() {
    printf '%s\n' "--packet 8" "--packet 1 --simd ${targets[-1]}" "--spp 8 --adaptive on" \
      "--batch frame" "--mode reference" \
      "--spp 2 --glossy 4 --texture-filter trilinear --terminator on"
  }
else
  sizes=(480x300 333x217)
fi

scenes=("$root"/scenes/*.json)
list() {
  local scene size line
  for scene in "${scenes[@]}"; do
    if [[ $scene == */sponza-mirror.json ]] &&
      ! "$whit" info "$scene" >/dev/null 2>&1; then
      echo "!! sponza-mirror is left out: its model is not there (WHIT_DATA)" >&2
      continue
    fi
    for size in "${sizes[@]}"; do
      while read -r line; do
        # shellcheck disable=SC2086
        hashOf "$scene" --size "$size" $line
      done < <(choices)
    done
  done
  for scene in "$root"/scenes/hard/*.json; do
    for line in "" "--packet 1" "--mode reference"; do
      # shellcheck disable=SC2086
      hashOf "$scene" --size 160x120 $line
    done
  done
}

list | tee "$out/list"
if grep -E 'failed:|no hash' "$out/list" >&2; then
  echo "Pictures that cannot be made." >&2
  exit 1
fi
if [ -n "$expected" ]; then
  if ! diff "$expected" "$out/list" >"$out/differences"; then
    cat "$out/differences" >&2
    echo "$(grep -c '^>' "$out/differences") of $(wc -l <"$out/list") differ." >&2
    exit 1
  fi
  echo "All $(wc -l <"$out/list") are the same." >&2
fi
