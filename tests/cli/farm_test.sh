#!/usr/bin/env bash
# scenes/farm on this machine: a worker is killed half way, the same line again goes on, and the
# frames are those of one process: farm_test.sh WHIT
set -euo pipefail

whit=$1
farm=$(cd "$(dirname "$0")/../../scenes/farm" && pwd)
if ! command -v parallel >/dev/null; then
  echo "GNU parallel is not installed (apt-get install parallel): farms are NOT checked" >&2
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
mkdir whole farmed slurm
# A frame takes a tenth of a second or so, long enough to stop a worker before its last one.
options=(--size 64x40 --spp 128 --threads 1)
"$whit" render whitted -o "whole/####.exr" --frames 0..7 "${options[@]}" --quiet

farm() { WHIT=$whit JOBS=2 CHUNK=4 RETRIES=${1:-1} "$farm/parallel.sh" frames whitted "farmed/####.exr" 0..7 \
  "${options[@]}"; }
# stop PROCESS: stops it and waits until all its threads have stopped. Fails if it has ended.
stop() {
  local states
  kill -STOP "$1" 2>/dev/null || return 1
  while states=$(sed -n 's/^State:[[:space:]]*//p' "/proc/$1/task"/*/status 2>/dev/null); do
    if grep -q '^[ZX]' <<<"$states"; then return 1; fi
    if ! grep -qv '^T' <<<"$states"; then return 0; fi
    sleep 0.01
  done
  return 1
}

# Kills a worker that has frames left to trace. A worker is stopped before its frames are counted; on a
# busy machine the workers may have ended by then, and the farm starts again.
killed=false
for _ in $(seq 20); do
  rm -f farmed/*
  farm >log 2>&1 &
  run=$!
  until compgen -G "farmed/00*.exr" >/dev/null; do
    kill -0 $run 2>/dev/null || { cat log; exit 1; }
    sleep 0.01
  done
  # No other program has this folder as its own. No child looks for the workers, because starting one
  # for each process may take a busy machine longer than the workers take.
  for process in /proc/[0-9]*; do
    if ! [[ $process/exe -ef $whit && $process/cwd -ef $work ]]; then continue; fi
    process=${process#/proc/}
    stop "$process" || continue
    last=$(tr '\0' '\n' <"/proc/$process/cmdline" | sed -n 's/^[0-9]*\.\.\([0-9]*\)$/\1/p')
    if [ ! -e "farmed/000$last.exr" ]; then
      kill -KILL "$process"
      killed=true
      break
    fi
    kill -CONT "$process"
  done
  status=0
  wait $run || status=$?
  if $killed; then break; fi
done
$killed || { echo "no worker could be stopped before its last frame"; exit 1; }
test $status = 1
grep -q "1 of 2 jobs failed" log
tail -1 log | grep -qE "^8 images: 0 kept, 4 traced, 4 failed$"
count=$(ls farmed | wc -l)
test "$count" -gt 0
test "$count" -lt 8
echo "killed with $count of 8 frames done"

before=$(ls -i farmed | sort)
farm >log 2>&1
tail -1 log | grep -qE "^8 images: $count kept, $((8 - count)) traced, 0 failed$"
for frame in whole/*; do cmp "$frame" "farmed/${frame#whole/}"; done
test "$(comm -12 <(echo "$before") <(ls -i farmed | sort) | wc -l)" = "$count" # none traced again
test "$(ls -A farmed | wc -l)" = 8                                             # nothing left behind

# One image in bands equals the image of one process.
"$whit" render whitted -o whole.exr --size 96x60 --quiet
WHIT=$whit JOBS=2 CHUNK=25 "$farm/parallel.sh" image whitted bands.exr 96x60
cmp whole.exr bands.exr
test ! -e bands.exr.parts

# Bands are merged to an EXR: another name is refused before anything is traced.
status=0
WHIT=$whit "$farm/parallel.sh" image whitted bands.png 96x60 2>log || status=$?
test $status = 2
grep -q "expected a name that ends in .exr" log
test ! -e bands.png.parts

# Frames that run backwards, or that are no numbers, are refused as well.
for range in 5..3 a..b; do
  status=0
  WHIT=$whit "$farm/parallel.sh" frames whitted "backwards-####.exr" $range 2>log || status=$?
  test $status = 2
  grep -q "$range: expected a frame number" log
done

# Every job that runs at a time has something to do, where there is no CHUNK; and whoever says
# --json is told that there is no one file.
recorder=$work/bin
mkdir "$recorder"
printf '#!/bin/sh\nfor word in "$@"; do case $word in [0-9]*..[0-9]*) echo "$word" >>"%s"; esac; done\nexec "%s" "$@"\n' \
  "$work/ranges" "$whit" >"$recorder/whit"
chmod +x "$recorder/whit"
mkdir eight
WHIT=$recorder/whit JOBS=2 "$farm/parallel.sh" frames whitted "eight/####.exr" 0..7 --size 32x20 2>/dev/null
test "$(sort ranges | tr '\n' ' ')" = "0..3 4..7 "
status=0
WHIT=$whit "$farm/parallel.sh" frames whitted "eight/####.exr" 0..7 --json all.json 2>log || status=$?
test $status = 2
grep -q "every job would write" log

# Threads are those of the machine that traces: it may have other cores than this one.
printf '#!/bin/sh\necho 12\n' >"$recorder/nproc"
printf '#!/bin/sh\necho "$@" >>"%s"\nexec "%s" "$@"\n' "$work/words" "$whit" >"$recorder/whit"
chmod +x "$recorder/nproc"
mkdir remote
printf '#!/bin/sh\nwhile [ "$1" != there ]; do shift; done\nshift\n[ "$1" != -- ] || shift\nSHELL=/bin/sh PATH=%s:$PATH exec sh -c "$*"\n' \
  "$recorder" >"$work/login"
chmod +x "$work/login"
WHIT=$recorder/whit JOBS=4 LOGINS="$work/login there" "$farm/parallel.sh" frames whitted "$work/remote/####.exr" 0..1 \
  --size 32x20 2>log || { cat log; exit 1; }
grep -q -- "--threads 3 " words
test "$(ls -A remote | wc -l)" = 2

# A machine that does nothing and says that all is well is a failure.
printf '#!/bin/sh\nexit 0\n' >"$work/login"
status=0
WHIT=$whit LOGINS="$work/login there" "$farm/parallel.sh" frames whitted "$work/remote/2-####.exr" 0..1 2>log || status=$?
test $status = 1
tail -1 log | grep -qE "^2 images: 0 kept, 0 traced, 2 failed$"

# A run that is killed leaves nothing that the next one does not sweep away.
: >farmed/.whit-killed.tmp
farm 2>/dev/null
test "$(ls -A farmed | wc -l)" = 8

# The job array, task by task as Slurm would start them; the last has nothing to do.
for task in 0 1 2; do
  WHIT=$whit SLURM_ARRAY_TASK_ID=$task CHUNK=5 "$farm/slurm.sbatch" whitted "slurm/####.exr" 0..7 "${options[@]}"
done
for frame in whole/*; do cmp "$frame" "slurm/${frame#whole/}"; done
echo "farms: 1 passed"
