#!/usr/bin/env bash
# Formats all sources as .clang-format says, by clang-format 14: what others make of it differs.
#   tests/format.sh            formats
#   tests/format.sh --check    changes nothing, exits 1 when something is not formatted
# Exits 77 without clang-format 14; --check with CI=true then fails.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
options=(-i)
case ${1:-} in
  "") ;;
  --check) options=(--dry-run -Werror) ;;
  *) echo "tests/format.sh: unknown option '$1' (--check)" >&2; exit 2 ;;
esac
format=
for program in clang-format-14 clang-format; do
  if "$program" --version 2>/dev/null | grep -q 'version 14\.'; then
    format=$program
    break
  fi
done
if [ -z "$format" ]; then
  echo "!! clang-format 14 is not installed: formatting is NOT checked" >&2
  if [ "${1:-}" = --check ] && [ -n "${CI:-}" ]; then exit 1; fi
  exit 77
fi
find src simd tests viewer \( -name '*.cpp' -o -name '*.h' \) -print0 |
  xargs -0 -n 40 -P "$(nproc)" "$format" "${options[@]}" || exit 1
