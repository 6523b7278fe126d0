#!/usr/bin/env bash
# Frames of a camera path, or one large image in bands, on this machine or on many, with GNU parallel.
#
#   scenes/farm/parallel.sh frames SCENE OUT-####.exr A..B [options of whit render]
#   scenes/farm/parallel.sh image  SCENE OUT.exr WxH       [options of whit render]
#
# Stopped, killed or failed: the same line again goes on where it was. Images that are there and
# whole are not traced again (whit render --resume), and whit never leaves half a file under an
# image's name. One run at a time writes into a folder. `image` keeps its bands in OUT.exr.parts until they are merged.
#
# In the environment:
#   WHIT     the program (default: build/whit of this checkout, else whit)
#   JOBS     jobs at a time on each machine (default 1: one job already uses all cores)
#   THREADS  workers of a job (default: cores of its machine / JOBS)
#   CHUNK    frames, or rows of a band, of a job (default 8 frames, 64 rows, and fewer where there
#            would be less jobs than run at a time); each job loads the scene
#   RETRIES  how often a job is tried (default 3)
#   LOGINS   machines, as --sshlogin of parallel wants them ("host1,host2"; default: this one).
#            They need whit, the scene and the output folder under the same paths.
# The last line says how many images were kept, how many traced, and how many are those of failed jobs.
# Exit status: 0 when everything is there, else 1.
set -euo pipefail

usage() {
  sed -n '2,/^set/{/^#/s/^# \{0,1\}//p}' "$0" >&2
  exit 2
}
[ $# -ge 4 ] || usage
what=$1 scene=$2 out=$3 range=$4
shift 4
for word in "$@"; do
  case $word in
    --json | --json=*) echo "$0: --json: every job would write that file" >&2; exit 2 ;;
  esac
done

here=$(cd "$(dirname "$0")/../.." && pwd)
whit=${WHIT:-$here/build/whit}
[ -x "$whit" ] || whit=whit
jobs=${JOBS:-1}
# Each machine counts its own cores. $0 is the program.
own='n=$(($(nproc) / '$jobs')); exec "$0" render --threads $((n > 1 ? n : 1)) "$@"'
render=(sh -c "$own" "$whit")
[ -z "${THREADS:-}" ] || render=("$whit" render --threads "$THREADS")

# Files of this run lie where the next one sweeps: nothing is left of a run that was killed.
begin() {
  log=$(mktemp "$1/.whit-XXXXXX.tmp") said=$(mktemp "$1/.whit-XXXXXX.tmp")
  trap 'rm -f "$log" "$said"' EXIT
}

# chunk MOST COUNT: of COUNT frames or rows, how many are a job: MOST, or what gives every job that
# runs at a time one.
chunk() {
  local logins=${LOGINS:-} commas share machines
  commas=${logins//[^,]/}
  machines=$((${#commas} + 1))
  share=$((($2 + jobs * machines - 1) / (jobs * machines)))
  echo "${CHUNK:-$((share < 1 ? 1 : share < $1 ? share : $1))}"
}

# The sum of the numbers of a key in what the jobs said.
sum() { awk -v key="\"$1\":" '$1 == key { sum += $2 } END { print sum + 0 }' "$said"; }

# each IMAGES ITEM...: the command that stands in `job`, {} being the item, on every machine; they
# make so many images.
each() {
  local status=0 images=$1 kept traced failed
  shift
  parallel --will-cite --quote --jobs "$jobs" --retries "${RETRIES:-3}" --joblog "$log" \
    ${LOGINS:+--sshlogin "$LOGINS"} --workdir . "${job[@]}" --json - ::: "$@" >"$said" || status=$?
  kept=$(sum kept) traced=$(sum frames)
  if [ "$status" != 0 ]; then
    failed=$(awk 'NR > 1 && $7 + $8 > 0' "$log" | wc -l)
    echo "$0: $failed of $# jobs failed; again to go on" >&2
  fi
  echo "$images images: $kept kept, $traced traced, $((images - kept - traced)) failed" >&2
  # A machine that does not run the job may still say that all is well.
  [ "$status" = 0 ] && [ $((kept + traced)) = "$images" ] || exit 1
}

# Where what the killed have left lies: temporary files of whit, which nobody uses any more.
sweep() { rm -f "$1"/.whit-*.tmp; }

case $what in
  frames)
    first=${range%%..*} last=${range##*..}
    if ! [[ $range =~ ^[0-9]+(\.\.[0-9]+)?$ ]] || ((10#$last < 10#$first)); then
      echo "$0: $range: expected a frame number, or first..last as 0..47" >&2
      exit 2
    fi
    begin "$(dirname "$out")"
    images=$((10#$last - 10#$first + 1))
    step=$(chunk 8 "$images")
    items=()
    for ((a = 10#$first; a <= 10#$last; a += step)); do
      b=$((a + step - 1 < 10#$last ? a + step - 1 : 10#$last))
      items+=("$a..$b")
    done
    job=("${render[@]}" "$scene" -o "$out" --frames '{}' --resume --quiet "$@")
    each "$images" "${items[@]}"
    sweep "$(dirname "$out")"
    ;;
  image)
    case $out in
      *.[eE][xX][rR]) ;;
      *) echo "$0: $out: expected a name that ends in .exr, which bands are merged to" >&2; exit 2 ;;
    esac
    width=${range%%x*} height=${range##*x}
    step=$(chunk 64 "$height")
    parts=$out.parts
    mkdir -p "$parts"
    begin "$parts"
    items=()
    files=()
    for ((y = 0; y < height; y += step)); do
      item=0,$y,$width,$((y + step < height ? y + step : height))
      items+=("$item")
      files+=("$parts/$item.exr")
    done
    job=("${render[@]}" "$scene" -o "$parts/{}.exr" --size "$range" --crop '{}' --resume --quiet "$@")
    each "${#items[@]}" "${items[@]}"
    "$whit" merge "$out" "${files[@]}" --quiet || exit 1
    rm -rf "$parts"
    ;;
  *) usage ;;
esac
