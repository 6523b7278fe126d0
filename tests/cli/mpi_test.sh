#!/usr/bin/env bash
# One image on 2 and 3 ranks is that of one process, bit for bit, and what goes wrong on any rank
# ends all of them: mpi_test.sh WHIT
set -euo pipefail

whit=$(readlink -f "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# As many ranks as asked for, whatever the machine has, in a container too.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
ranks() { mpirun --oversubscribe --bind-to none -n "$@"; }
passed=0

# same NAME OPTIONS...: files of every rank count against those of one process.
same() {
  local name=$1 n
  shift
  "$whit" render "$@" --threads 1 -o "$name-1.exr" -o "$name-1.png" --quiet
  for n in 2 3; do
    ranks $n "$whit" render "$@" --threads 1 -o "$name-$n.exr" -o "$name-$n.png" --quiet
    cmp "$name-1.exr" "$name-$n.exr"
    cmp "$name-1.png" "$name-$n.png"
    passed=$((passed + 1))
  done
}
same whitted whitted --size 200x120
same crop mirrors --size 200x120 --crop 13,7,190,111 --tile 16
same reference glass --size 72x48 --mode reference --tile 8
same samples matte --size 100x80 --adaptive on --spp 4 --exposure 1
same channels whitted --size 200x120 --channels depth,normal,object,triangle,rays

# Fewer blocks than ranks, and a path of frames of which one is there.
ranks 3 "$whit" render matte --size 8x8 -o small-3.exr --quiet
"$whit" render matte --size 8x8 -o small-1.exr --quiet
cmp small-1.exr small-3.exr
"$whit" render whitted --size 80x50 --frames 0..3 -o 'one-#.exr' --quiet
cp one-2.exr farm-2.exr
before=$(ls -i farm-2.exr)
ranks 2 "$whit" render whitted --size 80x50 --frames 0..3 -o 'farm-#.exr' --resume --quiet
test "$before" = "$(ls -i farm-2.exr)"
for frame in 0 1 2 3; do cmp one-$frame.exr farm-$frame.exr; done

# Measured on the leader alone.
ranks 2 "$whit" bench matte --size 200x120 --frames 2 --threads 1 --json bench.json >table
test "$(grep -c 'stage  ' table)" = 1
grep -q '"ranks": 2' bench.json

# ends STATUS SAID RANKS COMMAND...: every rank is gone, and one of them says why.
ends() {
  local status=0 wanted=$1 said=$2 n=$3
  shift 3
  ranks "$n" "$@" >out 2>err || status=$?
  test $status = "$wanted" || { echo "status $status instead of $wanted: $*"; cat err; exit 1; }
  test "$(grep -c "$said" err)" = 1 || { cat err; exit 1; }
  passed=$((passed + 1))
}
ends 2 'no option' 3 "$whit" render matte --no-such -o x.exr
ends 4 'no-such-scene' 2 "$whit" render ./no-such-scene.json -o x.exr
ends 4 'there is no folder' 3 "$whit" render matte -o no/such/x.exr
ends 5 'max-memory' 2 "$whit" render matte -o x.exr --size 2000x2000 --max-memory 0.02
ends 2 'batch frame' 2 "$whit" render matte -o x.exr --batch frame
# A rank that alone has no scene.
cat >one_blind.sh <<END
#!/bin/sh
if [ "\$OMPI_COMM_WORLD_RANK" = 1 ]; then exec "$whit" render ./gone.json -o x.exr --quiet; fi
exec "$whit" render matte -o x.exr --quiet
END
chmod +x one_blind.sh
ends 4 'rank 1: .*gone.json' 3 ./one_blind.sh
test ! -e x.exr
echo "ranks: $passed passed"
