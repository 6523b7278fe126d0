#!/usr/bin/env bash
# Fuzzes the readers, and rendering with random pictures (`picture`), each for SECONDS (20), as many at a
# time as there are processors.
#   tests/fuzz/run.sh [SECONDS] [READER...]
# New inputs are gathered in build-debug-sanitize/corpus, so that a run goes on where the last one stopped.
# What breaks a reader is left in build-debug-sanitize/findings: repair the reader, then keep the input in
# tests/fuzz/corpus. Exits 1 when something was found, 77 when there is no Clang.
set -uo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root" || exit 1
seconds=${1:-20}
case $seconds in
  '' | *[!0-9]*) echo "tests/fuzz/run.sh: expected SECONDS, found '$seconds'" >&2; exit 2 ;;
esac
shift || true
readers=("$@")
[ ${#readers[@]} -gt 0 ] || readers=(picture exr png gltf stl dae fbx 3ds off jpeg webp scene obj hdr mtl tga ply bmp input)

if ! command -v clang++ >/dev/null; then
  echo "!! clang++ is not installed: the readers are NOT fuzzed" >&2
  exit 77
fi
cmake --preset debug-sanitize -DWHIT_WERROR=ON >/dev/null &&
  cmake --build --preset debug-sanitize --parallel "$(nproc)" --target fuzzers || exit 1

build=$root/build-debug-sanitize
mkdir -p "$build/findings"
TMPDIR=$(mktemp -d -p "$([ -d /dev/shm ] && echo /dev/shm || echo /tmp)" whit-fuzz-XXXXXX)
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT
export ASAN_OPTIONS=quarantine_size_mb=8:detect_leaks=1:allocator_may_return_null=0
export UBSAN_OPTIONS=print_stacktrace=1

# Beyond these a reader would be a way to bring a machine down: a reader may take 64 MB here.
fuzz() {
  local reader=$1 dictionary=$root/tests/fuzz/$1.dict log=$build/findings/$1.log
  mkdir -p "$build/corpus/$reader"
  local options=(-max_total_time="$seconds" -timeout=10 -rss_limit_mb=1024 -malloc_limit_mb=256
                 -max_len=4096 -print_final_stats=1 -artifact_prefix="$build/findings/$reader-")
  [ -f "$dictionary" ] && options+=(-dict="$dictionary")
  # What a picture is made of needs no examples.
  local corpora=("$build/corpus/$reader")
  [ -d "$root/tests/fuzz/corpus/$reader" ] && corpora+=("$root/tests/fuzz/corpus/$reader")
  if "$build/tests/fuzz_$reader" "${options[@]}" "${corpora[@]}" >"$log" 2>&1; then
    awk -v reader="$reader" '/number_of_executed_units/ { n = $2 } /cov:/ { c = $0 }
      END { sub(/.*cov: /, "", c); sub(/ .*/, "", c)
            printf "%-6s %9d inputs, %5d places reached, nothing found\n", reader, n, c }' "$log"
  else
    echo "!! $reader: see ${log#"$root"/}" >&2
    grep -m 3 -E 'ERROR|SUMMARY|runtime error|what\(\)|Test unit written' "$log" >&2
    return 1
  fi
}

status=0
running=0
for reader in "${readers[@]}"; do
  if ! [ -x "$build/tests/fuzz_$reader" ]; then
    echo "!! $reader: this build has no such reader, it is NOT fuzzed" >&2
    continue
  fi
  if [ "$running" -ge "$(nproc)" ]; then
    wait -n || status=1
    running=$((running - 1))
  fi
  fuzz "$reader" &
  running=$((running + 1))
done
while [ "$running" -gt 0 ]; do
  wait -n || status=1
  running=$((running - 1))
done
exit $status
