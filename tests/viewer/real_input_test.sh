#!/usr/bin/env bash
# The viewer under a window manager, with keys and mouse as the X server delivers them.
#   tests/viewer/real_input_test.sh WHIT-VIEW
# Exit 77: a program it needs is not installed.
set -euo pipefail

view=$(realpath "$1")
for program in Xvfb xdotool openbox setxkbmap; do
  if ! command -v "$program" >/dev/null; then
    echo "!! $program is not installed: real input is NOT checked" >&2
    exit 77
  fi
done
work=$(mktemp -d)
children=()
finish() {
  kill "${children[@]}" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$work"
}
trap finish EXIT
export HOME=$work XDG_CONFIG_HOME=$work XDG_CACHE_HOME=$work  # nobody's settings

fail() {
  echo "real_input_test: $*" >&2
  cat "$work/out" "$work/err" >&2 || true  # neither is there before the viewer is
  exit 1
}
# within COMMAND...: until it succeeds; the seconds are for machines that do other work as well.
within() {
  local end=$((SECONDS + 60))
  until "$@"; do
    [ $SECONDS -lt $end ] || fail "not within a minute: $*"
    sleep 0.05
  done
}
has() { [ -s "$1" ]; }
managed() { xdotool get_num_desktops >/dev/null 2>&1; }  # only a window manager knows
printed() { [ "$(grep -c '^whit render' "$work/out")" -ge "$1" ]; }
# The view as the viewer prints it when asked; into $view_now.
prints=0
look() {
  prints=$((prints + 1))
  xdotool key c
  within printed $prints
  view_now=$(grep '^whit render' "$work/out" | tail -n 1)
}
# Empty where it is the scene's own.
option() { sed -n "s/.* --$1=\([^ ]*\).*/\1/p" <<<"$view_now"; }
size() { xdotool getwindowgeometry --shell "$window" | sed -n 's/^\(WIDTH\|HEIGHT\)=//p' | paste -sd x; }
isSize() { [ "$(size)" = "$1" ]; }
shows() {
  look
  [ "$(option size)" = "$1" ]
}
moved() {
  look
  [ "$(option "$1")" != "$2" ]
}
# hold OPTION DOWN UP: what xdotool presses stays down until that option of the view has changed, however
# busy the machine is; then it is let go.
hold() {
  local name=$1 before
  before=$(option "$name")
  # shellcheck disable=SC2086  # words
  xdotool $2
  within moved "$name" "$before"
  # shellcheck disable=SC2086
  xdotool $3
}

# -noreset: when its only client leaves, as xdotool does, the server would otherwise begin anew and drop a
# window manager that is just connecting.
Xvfb -noreset -displayfd 3 -screen 0 1024x700x24 -nolisten tcp 3>"$work/display" 2>/dev/null &
children+=($!)
within has "$work/display"
DISPLAY=:$(cat "$work/display")
export DISPLAY
openbox >/dev/null 2>&1 &
children+=($!)
within managed
# On a German keyboard Z and Y change places, and Ü has the place of [.
setxkbmap de
cd "$work"  # where files are saved
"$view" matte --size 320x200 --quiet >"$work/out" 2>"$work/err" &
viewer=$!
children+=($viewer)
window=$(timeout 60 xdotool search --sync --onlyvisible --name '^whit' | head -n 1) ||
  fail "no window"
xdotool windowactivate --sync "$window"

# The window is there before its scene, and keys count from then on.
answers() {
  xdotool key c
  sleep 0.5
  printed 1
}
within answers
sleep 1
prints=$(grep -c '^whit render' "$work/out")
look
hold eye "keydown w" "keyup w"
hold eye "keydown shift keydown d" "keyup d keyup shift"
from="mousemove --window $window 200 150"
hold eye "$from mousedown 1 sleep 0.2 mousemove_relative -- 40 15" "mouseup 1"
hold eye "$from mousedown 3 sleep 0.2 mousemove_relative -- 0 60" "mouseup 3"

# A key counts while the panel has the mouse, and right after.
xdotool key p
xdotool mousemove --window "$window" 60 20 mousedown 1 sleep 0.2 key c sleep 0.2 mouseup 1
prints=$((prints + 1))
within printed $prints
xdotool mousemove --window "$window" 60 20 click 1 key c
prints=$((prints + 1))
within printed $prints

# What C prints is in the clipboard.
if python3 -c 'import tkinter' 2>/dev/null; then
  look
  copied=$(python3 -c 'import tkinter; root = tkinter.Tk(); root.withdraw(); print(root.clipboard_get())')
  [ "$copied" = "$view_now" ] || fail "the clipboard holds '$copied', not '$view_now'"
else
  echo "!! python3-tk is not installed: the clipboard is NOT checked" >&2
fi

# Ctrl+S saves, and is no S, which flies.
look
eye=$(option eye)
xdotool key ctrl+s
prints=$((prints + 1))
within printed $prints
[ -s matte-edited.json ] || fail "Ctrl+S has saved nothing"
look
[ "$(option eye)" = "$eye" ] || fail "Ctrl+S has moved the camera"

# Commands go by what a key says.
exposure=$(option exposure)
xdotool key udiaeresis
within moved exposure "$exposure"
darker=$(option exposure)
xdotool key ctrl+y
look
[ "$(option exposure)" = "$darker" ] || fail "Ctrl+Y is taken for Ctrl+Z"
xdotool key ctrl+z
within moved exposure "$darker"
[ "$(option exposure)" = "$exposure" ] || fail "Ctrl+Z has not undone it"

first=$(size)
xdotool key F11
within isSize 1024x700
within shows 1024x700
xdotool key F11
within isSize "$first"
within shows "$first"

xdotool windowminimize --sync "$window"
sleep 0.5
xdotool windowmap --sync "$window" windowactivate --sync "$window"
xdotool windowsize --sync "$window" 500 400
within isSize 500x400
within shows 500x400

# Escape closes the panel, and then the window. On a busy machine the clicks above may have met the
# picture before the panel was drawn: then it has rays to close as well.
xdotool key Escape sleep 1
kill -0 $viewer || fail "Escape ended it while the panel was open"
ended() {
  xdotool key Escape sleep 0.5 || true
  ! kill -0 $viewer 2>/dev/null
}
within ended
status=0
wait $viewer || status=$?
[ $status -eq 0 ] || fail "Escape ended it with status $status"
[ ! -s "$work/err" ] || fail "it said something on standard error"
echo "real_input_test: keys, both buttons, full screen, minimized, resized: as expected"
