#!/usr/bin/env bash
# The commands of README.md and other pages, as they stand there but for sizes and counts that would
# take long: readme_test.sh PAGE.md... WHIT [WHIT-VIEW-SCRIPT]; whit-verify lies beside WHIT. Commands are the lines of code blocks, and
# code within text that has arguments. Those of the programs and of scenes/farm are run; those that install,
# build or test the whole are named, and so is whatever this machine lacks something for.
set -uo pipefail

pages=()
while [[ ${1:-} == *.md ]]; do
  pages+=("$(readlink -f "$1")")
  shift
done
whit=$(readlink -f "$1") view=${2:+$(readlink -f "$2")}
root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
display=
finish() {
  if [ -n "$display" ]; then kill "$display"; fi
  rm -rf "$work"
}
trap finish EXIT
mkdir "$work/build"
ln -s "$root/scenes" "$work/scenes"
ln -s "$whit" "$work/build/whit"
ln -s "$(dirname "$whit")/whit-verify" "$work/build/whit-verify"
if [ -n "$view" ]; then ln -s "$view" "$work/build/whit-view"; fi
cd "$work" || exit 1
export XDG_CONFIG_HOME=$work  # nobody's settings

# The shipped model is what its script makes and needs no repairs.
python3 scenes/make_chess.py made.glb && cmp made.glb scenes/chess.glb || exit 1
"$whit" render scenes/chess.glb --strict --size 48x32 -o strict.png --quiet || exit 1
echo 'wait 2 frames' >leave.txt

# One command a line: first those of code blocks, without their comments, then those within text.
commandsOf() {
  awk '/^```/ { inside = !inside; next } inside' "$@" | sed -E 's/ +#( .*)?$//' |
    grep -E '^([A-Z]+=[^ ]+ )*((build|scenes|tests)/[a-z]|cmake |cpack )'
  awk '/^```/ { inside = !inside; next } !inside' "$@" | tr '\n' ' ' |
    grep -oE '`((build|scenes|tests)/|cmake |cpack |whit |whit-view )[^` ]*[^`]* [^`]+`' |
    tr -d '`' | sed -E 's/^(whit|whit-view) /build\/&/'
}

# The same without what takes long and shows nothing more: the atrium alone is made in two seconds.
cheap() {
  sed -E -e 's/ *((&&|\|) ffmpeg.*)?$//' -e '/whit-view/s/SCENE/sponza-mirror/' -e 's/SCENE/whitted/' \
    -e 's/COMMAND/render/' -e '/--truth transport/s/atrium whitted glass sponza-mirror/matte/' \
    -e '/-o atrium/!s/atrium/whitted/g' -e '/turntable/s/$/ --count 2 --size 64x40/' \
    -e 's/--size [0-9]+x[0-9]+/--size 64x40/' -e 's/--spp [0-9]+/--spp 2/' \
    -e 's/--frames [0-9]+( |$)/--frames 1\1/' -e 's/--depth N/--depth 4/' -e 's/--sphere-segments N/--sphere-segments 8/' \
    -e 's/triangles=(N|[0-9]+)/triangles=20000/' -e 's/(render|info) (FILE|MODEL)/\1 whitted/' -e 's/1\.\.48/1..2/' -e 's/0\.\.239/0..2/' \
    -e 's/--crop 0,0,640,720/--crop 0,0,32,40/' -e 's/--crop 640,0,1280,720/--crop 32,0,64,40/' \
    -e '/whit (bench|effects)/{/--frames/!s/$/ --frames 1/}' \
    -e '/whit (render|bench|effects|compare [a-z]+ )/{/--(size|help)/!s/$/ --size 64x40/}' \
    -e '/whit accuracy/s/$/ --size 16x10 --knobs cutoff --time-budget 0/' -e 's/--hashes 480x300/--hashes 48x30/' -e '/--hashes/!s/whit-verify.*/& --only H13/' \
    -e '/whit-view/s/$/ --script leave.txt --size 64x40/'
}

openDisplay() {
  [ -z "$display" ] || return 0
  Xvfb -noreset -displayfd 3 -screen 0 800x600x24 3>number >/dev/null 2>&1 &
  display=$!
  for _ in $(seq 100); do [ -s number ] && break; sleep 0.1; done
  DISPLAY=:$(cat number)
  export DISPLAY
}

# What a command needs that is not here; nothing if it can be run.
lacking() {
  case $1 in
    *sponza-mirror*) [ -d "${WHIT_DATA:-}/crytek_sponza" ] || echo "WHIT_DATA has no crytek_sponza" ;;
  esac
  case $1 in
    *scenes/farm/*) command -v parallel >/dev/null || echo "GNU parallel is not installed" ;;
    *whit-view*)
      [ -n "$view" ] || echo "the viewer was not built"
      command -v Xvfb >/dev/null || echo "Xvfb is not installed" ;;
  esac
}

declare -A seen
runs=0 left=0
while IFS= read -r line; do
  command=$(cheap <<<"$line")
  [ -z "${seen[$command]:-}" ] || continue
  seen[$command]=1
  case $command in
    *build/whit* | *scenes/farm/*) why=$(lacking "$command" | head -1) ;;
    *) why="it installs, builds or tests the whole" ;;
  esac
  if [ -n "$why" ]; then
    echo "!! NOT run, $why: $line" >&2
    left=$((left + 1))
    continue
  fi
  case $command in *whit-view*) openDisplay ;; esac
  echo "$command"
  if ! bash -euo pipefail -c "$command" >said 2>&1 </dev/null; then
    cat said
    echo "this fails: $line" >&2
    exit 1
  fi
  runs=$((runs + 1))
done < <(commandsOf "${pages[@]}")
test $runs -gt 10 || { echo "only $runs commands were found" >&2; exit 1; }
echo "readme: $runs commands passed, $left left out"
