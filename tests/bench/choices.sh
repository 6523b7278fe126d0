#!/ usr / bin / env bash
#What other choices cost : each against the default by turns, so that what else the machine does
#touches both.Prints the median of the ratios of their median frames.
#tests / bench / choices.sh WHIT SCENE SIZE ROUNDS CHOICE... a CHOICE is options in one word
#   tests/bench/choices.sh build/whit atrium 480x300 5 "--packet 1" "--batch frame" "--threads 1"
set - euo pipefail

    if[$ # - lt 5];
then sed - n '2,5s/^# *//p' "$0" > & 2 exit 2 fi whit = $1 scene = $2 size = $3 rounds = $4 shift 4
#milliseconds OPTIONS... : of the median frame.
    milliseconds(){"$whit" bench "$scene" --size "$size" --frames 10 "$@" 2 > / dev / null |
                   sed - n 's/^ *frame \([0-9.]*\) ms.*/\1/p'} median() {
  sort - n | awk '{ v[NR] = $1 } END { print (v[int((NR + 1) / 2)] + v[int(NR / 2) + 1]) / 2 }';
}

for
  choice in "$@";
do
  read -ra words <<<"$choice"
  for _ in $(seq "$rounds");
do
default = $(milliseconds) other =
    $(milliseconds "${words[@]}") awk "BEGIN { print $other / $default }" done | median |
    sed "s/^/$scene $size $choice: /; s/\$/ times the default's frame/" done
