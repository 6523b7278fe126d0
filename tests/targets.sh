#!/usr/bin/env bash
# Compares pictures of the shipped scenes among the SIMD targets of this machine, as a table, and exits
# 1 when two differ by more than Twins.TargetsAgreeWithEachOther allows.
#   tests/targets.sh [WHIT]    the program (build/whit)
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
whit=${1:-$root/build/whit}
[ -x "$whit" ] || { echo "tests/targets.sh: there is no program $whit" >&2; exit 2; }
. "$root/tests/picture_table.sh"
bound=$(sed -n 's/^constexpr double kPixelsGe2CodesPct = \(.*\);$/\1/p' \
  "$root/tests/render/twins_test.cpp")
[ -n "$bound" ] || { echo "tests/targets.sh: no bound in tests/render/twins_test.cpp" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Best first. The last candidates are those that other machines have.
targets=()
for target in avx3 avx2 sse4 sse2 neon scalar; do
  if "$whit" render matte --size 8x8 --simd $target -o "$work/try.exr" --quiet 2>/dev/null; then
    targets+=("$target")
  fi
done

# pictures_of SETTING...: a table of all pairs of targets, also left in $work/table.
pictures_of() {
  tableHead "scene, targets"
  for scene in $(tableScenes); do
    for target in "${targets[@]}"; do
      "$whit" render "$scene" --size 480x300 --simd "$target" "$@" -o "$work/$target.exr" --quiet
    done
    for ((i = 0; i < ${#targets[@]}; i++)); do
      for ((j = i + 1; j < ${#targets[@]}; j++)); do
        tableRow "$scene, ${targets[i]} and ${targets[j]}" "$whit" "$work/${targets[i]}.exr" \
          "$work/${targets[j]}.exr"
      done
    done
  done | tee "$work/table"
}

echo "Targets here: ${targets[*]}"
echo "As depth and cutoff are by default. Where mirrors face mirrors paths part by rounding; no bound."
pictures_of
printf '\nAt depth 8, where few have parted. At most %s %% of pixels may be off by two codes or more.\n\n' "$bound"
pictures_of --depth 8 --cutoff 3e-4
awk -F '|' -v bound="$bound" '100 - $4 > bound { print "!! beyond the bound:" $2; bad = 1 }
  END { exit bad }' "$work/table" >&2
