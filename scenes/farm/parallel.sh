#!/usr/bin/env bash
# Frames of a camera path, or one large image in bands, on this machine or on many, with GNU parallel.
#
#   scenes/farm/parallel.sh frames SCENE OUT-####.exr A..B [options of whit render]
#   scenes/farm/parallel.sh image  SCENE OUT.exr WxH       [options of whit render]
#
# Stopped, killed or failed: the same line again goes on where it was. Images that are there and
# whole are not traced again (whit render --resume), and whit never leaves half a file under an
# image's name. `image` keeps its bands in OUT.exr.parts until they are merged.
#
# In the environment:
#   WHIT     the program (default: build/whit of this checkout, else whit)
#   JOBS     jobs at a time on each machine (default 1: one job already uses all cores)
#   THREADS  workers of a job (default: cores / JOBS)
#   CHUNK    frames, or rows of a band, of a job (default 8 frames, 64 rows); each job loads the scene
#   RETRIES  how often a job is tried (default 3)
#   LOGINS   machines, as --sshlogin of parallel wants them ("host1,host2"; default: this one).
#            They need whit, the scene and the output folder under the same paths.
# Exit status: 0 when everything is there, else 1.
set -euo pipefail

usage() {
  sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "$0" >&2
  exit 2
}
[ $# -ge 4 ] || usage
what=$1 scene=$2 out=$3 range=$4
shift 4

here=$(cd "$(dirname "$0")/../.." && pwd)
whit=${WHIT:-$here/build/whit}
[ -x "$whit" ] || whit=whit
jobs=${JOBS:-1}
cores=$(nproc)
threads=${THREADS:-$((cores > jobs ? cores / jobs : 1))}
log=$(mktemp)
trap 'rm -f "$log"' EXIT

# each ITEM...: the command that stands in `job`, {} being the item, on every machine.
each() {
  local status=0
  parallel --will-cite --quote --jobs "$jobs" --retries "${RETRIES:-3}" --joblog "$log" \
    ${LOGINS:+--sshlogin "$LOGINS"} --workdir . "${job[@]}" ::: "$@" || status=$?
  [ "$status" = 0 ] && return
  echo "$0: $(awk 'NR > 1 && $7 + $8 > 0' "$log" | wc -l) of $# jobs failed; again to go on" >&2
  exit 1
}

# Where what the killed have left lies: temporary files of whit, which nobody uses any more.
sweep() { rm -f "$1"/.whit-*.tmp; }

case $what in
  frames)
    first=${range%%..*} last=${range##*..}
    chunk=${CHUNK:-8}
    items=()
    for ((a = 10#$first; a <= 10#$last; a += chunk)); do
      b=$((a + chunk - 1 < 10#$last ? a + chunk - 1 : 10#$last))
      items+=("$a..$b")
    done
    job=("$whit" render "$scene" -o "$out" --frames '{}' --threads "$threads" --resume --quiet "$@")
    each "${items[@]}"
    sweep "$(dirname "$out")"
    ;;
  image)
    width=${range%%x*} height=${range##*x}
    chunk=${CHUNK:-64}
    parts=$out.parts
    mkdir -p "$parts"
    items=()
    files=()
    for ((y = 0; y < height; y += chunk)); do
      item=0,$y,$width,$((y + chunk < height ? y + chunk : height))
      items+=("$item")
      files+=("$parts/$item.exr")
    done
    job=("$whit" render "$scene" -o "$parts/{}.exr" --size "$range" --crop '{}'
      --threads "$threads" --resume --quiet "$@")
    each "${items[@]}"
    "$whit" merge "$out" "${files[@]}" --quiet
    rm -rf "$parts"
    ;;
  *) usage ;;
esac
