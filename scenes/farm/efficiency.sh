#!/usr/bin/env bash
# What a second rank gives on this machine, and from that how far more would:
# efficiency.sh SCENE WxH [options of whit render]. Needs whit built with -DWHIT_MPI=ON.
#
# In the environment:
#   WHIT    the program (default: build/whit of this checkout)
#   FRAMES  frames that count (default 20)
#   LINK    bytes a second into the leader's machine (default 1.25e9, 10 Gbit Ethernet)
#   DELAY   seconds from one machine to another (default 50e-6)
#
# With the time W of one rank, B blocks, the longest block b, the leader's time s and the transfer time m
# of a block, and the delay d of a message, a frame on N ranks takes at least
#   T(N) = max(W/N + (1 - 1/N) b + B (1 - 1/N) s / N,  B (1 - 1/N) (s + m)) + 2 d
# The first part is the bound for work that is handed out to whoever is free (Graham 1969), with the
# leader's time added as work; the second is the leader's link.
set -euo pipefail

[ $# -ge 2 ] || { sed -n '2,3s/^# //p' "$0" >&2; exit 2; }
scene=$1 size=$2
shift 2
options=("$@")
whit=${WHIT:-$(cd "$(dirname "$0")/../.." && pwd)/build/whit}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

measure() { # NAME RANKS THREADS
  mpirun --oversubscribe --bind-to none -n "$2" "$whit" bench "$scene" --size "$size" \
    --threads "$3" --frames "${FRAMES:-20}" --json "$work/$1.json" --quiet "${options[@]}" >/dev/null
  echo "$1 $(value "$work/$1.json" frame_ms median)" >>"$work/turns"
}
value() { # FILE OBJECT KEY
  sed -n "/\"$2\": {/,\$s/.*\"$3\": \([0-9.e+-]*\).*/\1/p" "$1" | head -1
}
# In turn, since machines drift: the fastest of three counts.
for _ in 1 2 3; do
  measure 1 1 1
  measure 2 2 1
  measure threads 1 2
done

quickest() { awk -v name="$1" '$1 == name && (!least || $2 < least) { least = $2 } END { print least }' "$work/turns"; }
one=$(quickest 1) two=$(quickest 2) threads=$(quickest threads)
field() { value "$work/2.json" farm "$1"; }

awk -v scene="$scene" -v size="$size" -v one="$one" -v two="$two" -v threads="$threads" \
  -v blocks="$(field blocks)" \
  -v most="$(field max)" -v side="$(field block_side)" -v place="$(field place_ms)" \
  -v messages="$(field messages)" -v bytes="$(field message_bytes)" -v link="${LINK:-1.25e9}" \
  -v delay="${DELAY:-50e-6}" '
  function longer(a, b) { return a > b ? a : b }
  function frame(n,   others, shared, leader) {
    others = blocks * (1 - 1 / n)
    shared = one / n + (1 - 1 / n) * most + (others * serve) / n
    leader = others * (serve + wire)
    return longer(shared, leader) + 2e3 * delay
  }
  BEGIN {
    serve = place / messages; wire = 1e3 * bytes / messages / link
    printf "%s at %s: %d blocks of %dx%d pixels, %.2f ms each, the longest %.2f;\n", scene, size, blocks, side, side, one / blocks, most
    printf "a message %.1f kB, %.3f ms to place, %.3f ms on the wire.\n\n", bytes / messages / 1e3, serve, wire
    printf "Measured: %.1f ms on 1 rank, %.1f ms on 2: efficiency %.2f.\n", one, two, one / two / 2
    printf "One process with two threads: %.1f ms, efficiency %.2f.\n\n", threads, one / threads / 2
    print "| ranks | frame, ms | faster | efficiency |"
    print "|---:|---:|---:|---:|"
    for (n = 2; n <= 1024; n *= 2) {
      t = frame(n)
      printf "| %d | %.2f | %.1f | %.2f |\n", n, t, one / t, one / t / n
    }
    best = half = 1
    for (n = 2; n <= 1024; ++n) {
      if (frame(n) < frame(best) * 0.99) best = n
      if (one / frame(n) / n >= 0.5) half = n
    }
    printf "\nHalf of the ranks are wasted beyond %d; beyond %d the frame gets no shorter.\n", half, best
  }'
