#!/bin/sh
# Every option of --help is in the manual page with its meaning, the examples of the page have options
# that there are, and man finds no fault with the page: manual_test.sh PROGRAM...
set -eu

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The page as man shows it, without line breaks: words stand as in --help.
shown() {
  LC_ALL=C.UTF-8 MANWIDTH=2000 man --warnings -E UTF-8 -l "$1" 2>"$work/faults" | col -b | tr -s ' \n\t' '   '
}

for program in "$@"; do
  page=$work/$(basename "$program").1
  "$program" --man >"$page"
  "$program" --help-all >"$work/help"
  for command in $(sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/\1/p' "$work/help"); do
    "$program" "$command" --help-all >>"$work/help"
  done
  sed 's/\\-/-/g; s/\\fB//g; s/\\fR//g; s/\\fI//g' "$page" >"$work/plain"
  count=0
  for option in $(sed -n 's/^  \(-[a-z],\)\{0,1\}\(--[a-z0-9-]*\).*/\2/p' "$work/help" | sort -u); do
    grep -qE -e "^(-[a-z], ?)?$option( |\$)" "$work/plain" ||
      { echo "$program --man says nothing of $option"; exit 1; }
    count=$((count + 1))
  done
  test "$count" -gt 20

  sed -n '/^.SH "EXAMPLES"/,/^.SH "SEE/p' "$work/plain" | grep "^$(basename "$program") " >"$work/examples"
  for option in $(grep -oE -e '--[a-z-]+' "$work/examples" | sort -u); do
    grep -qE -e "^  (-[a-z],)?$option( |\$)" "$work/help" ||
      { echo "$program --man has an example with the unknown $option"; exit 1; }
  done

  if command -v man >/dev/null; then
    shown "$page" >"$work/text"
    cat "$work/faults"
    test ! -s "$work/faults"
    grep -qF -- '--spp N samples per pixel, for anti-aliasing (default: 1).' "$work/text"
  else
    echo "man is not installed: how the page of $program looks is NOT checked"
  fi
  if command -v mandoc >/dev/null; then mandoc -T lint -W warning "$page"; fi
  echo "$program: $count options"
done
echo "manual pages: $# passed"
