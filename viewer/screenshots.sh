#!/usr/bin/env bash
# Makes the pictures of the viewer that README.md shows, on a virtual display.
#   viewer/screenshots.sh [FOLDER]      default: scenes/pictures
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "${1:-$root/scenes/pictures}"
folder=$(cd "${1:-$root/scenes/pictures}" && pwd)
view=$root/build/whit-view-script
largest=500000  # bytes a picture

if [ ! -x "$view" ]; then
  echo "viewer/screenshots.sh: there is no $view; build it first: cmake --build build" >&2
  exit 1
fi
if ! command -v xvfb-run >/dev/null; then
  echo "viewer/screenshots.sh: xvfb-run is missing: apt-get install xvfb xauth" >&2
  exit 1
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# shot NAME "SCENE [OPTION...]" SIZE SCRIPT-LINE...: plays the lines, then saves what the window shows.
shot() {
  local name=$1 scene=$2 size=$3
  shift 3
  printf '%s\n' "$@" "screenshot $work/$name.png" > "$work/$name.txt"
  # shellcheck disable=SC2086  # words
  (cd "$root" && XDG_CONFIG_HOME=$work/$name xvfb-run -a -s "-screen 0 1280x720x24" \
    "$view" $scene --size "$size" --quiet --script "$work/$name.txt")
  if [ "$(stat -c %s "$work/$name.png")" -gt $largest ]; then
    echo "viewer/screenshots.sh: $name.png is larger than $largest bytes" >&2
    exit 1
  fi
  mv "$work/$name.png" "$folder/$name.png"
  echo "$folder/$name.png"
}

sharp=("wait 30 frames" "wait sharp")
gone=("wait 250 frames" "wait sharp")  # messages
shot viewer atrium 800x450 "asked" "panel time" "key W 0.2" "${sharp[@]}" "${gone[@]}"
shot viewer-knobs matte 960x600 "asked" "key Shift" "panel time" "${sharp[@]}" "click 100 76" "${sharp[@]}" \
  "${gone[@]}"
shot viewer-tree "whitted --depth 7" 960x600 "asked" "${sharp[@]}" "click 480 333" "${sharp[@]}" \
  "mouse left 200 -60" "${sharp[@]}" "${gone[@]}"
shot viewer-rays whitted 800x500 "key V" "key V" "key V" "key V" "${sharp[@]}" \
  "${gone[@]}"
