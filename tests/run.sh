#!/usr/bin/env bash
# Builds and tests. Exits non-zero when anything fails.
#   tests/run.sh           Release and every test of it, with CI=true warnings as errors; formatting
#                          where clang-format is: under six minutes on two cores once it is built
#   tests/run.sh AREA...   the tests of these folders only, and of the build what they need
#   tests/run.sh --full    clang-tidy, thread sanitizer, address and undefined-behavior sanitizers with
#                          Clang, fuzzing, the Debian package in a clean system, scenes/farm with a real
#                          Slurm and over a real ssh, and both commands of README.md in fresh systems of
#                          Debian 12 and, with the tests of some areas, Debian 13, whose compiler, Embree
#                          and Highway are others: forty minutes
#   tests/run.sh --deep    every test in the fresh systems a third time, as a user with sudo, and in
#                          Clang's and g++'s other builds, Embree 4 with Clang, a deeper clang-tidy,
#                          64-bit ARM and an older PC under emulation as well: more than an hour more
# What this system has no way to is named at the end, and so are tests that failed and what the build
# left out, which is an error with CI=true.
set -uo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root" || exit 1
if [ -z "${WHIT_DATA:-}" ] && [ -d ../shared/data ]; then
  WHIT_DATA=$(cd ../shared/data && pwd)
  export WHIT_DATA
fi
. tests/compiler_cache.sh
full=false
deep=false
areas=()
for word in "$@"; do
  case $word in
    --full) full=true ;;
    --deep) full=true deep=true ;;
    *)
      if ! grep -qs "whit_tests($word " "tests/$word/tests.cmake"; then
        echo "tests/run.sh: unknown word '$word' (--full, --deep, or a folder of tests)" >&2
        exit 2
      fi
      areas+=("$word")
      ;;
  esac
done
failed=()
leftOut=()
notes=()
failures=$(mktemp) output=$(mktemp)
if $full; then
  WHIT_CLEAN_SYSTEMS=$(mktemp -d)
  export WHIT_CLEAN_SYSTEMS
fi
packageLog=$(mktemp)
packaging=
trap '[ -z "$packaging" ] || kill -- "-$packaging" 2>/dev/null
  rm -rf --one-file-system "$failures" "$output" "$packageLog" "${WHIT_CLEAN_SYSTEMS:-}"' EXIT

# step NAME COMMAND...: runs it, remembers a failure and its last lines, goes on. Status 77: this system
# has no way to it.
step() {
  local name=$1 start=$SECONDS status
  shift
  echo "== $name"
  "$@" 2>&1 | tee "$output"
  status=${PIPESTATUS[0]}
  mapfile -t -O ${#notes[@]} notes < <(grep -E '^!! (FAILED TEST|LEFT OUT): ' "$output")
  case $status in
    0) ;;
    77) leftOut+=("$name") ;;
    *)
      failed+=("$name")
      { echo "== $name, the end of it"; tail -n 12 "$output" | cut -c 1-160; } >>"$failures"
      ;;
  esac
  echo "-- $name: $((SECONDS - start)) s"
}

# nameFailedTests FOLDER: the tests that failed in ctest's last run there: by the names that googletest
# has for them, or that of their program. A test that began and did not end has crashed.
nameFailedTests() {
  awk 'NR != FNR { sub(/^[0-9]+:/, ""); if (!($0 in named)) failed[$0]; next }
       /^[0-9]+\/[0-9]+ Test: / { program = $3 }
       /^\[ RUN      \] / { running = $4 }
       /^\[ +(OK|SKIPPED|FAILED) +\] / { running = "" }
       /^\[  FAILED  \] .*\./ { sub(/,$/, "", $4); failed[$4]; named[program] }
       /^Test time =/ && running { failed[running]; named[program]; running = "" }
       END { for (test in failed) print "!! FAILED TEST: " test }' \
    "$1/LastTest.log" "$1/LastTestsFailed.log" | sort
}

# sayWhatIsLeftOut FOLDER: what the build in it is without. Fails where that may not be.
sayWhatIsLeftOut() {
  [ -s "$1/left_out.txt" ] || return 0
  echo "!! LEFT OUT: $(cat "$1/left_out.txt")"
  [ -z "${CI:-}" ]
}

# buildAndTest PRESET CMAKE-ARGUMENTS... More tests at a time than processors: many wait for a window,
# a process or the disk. Why tests were skipped is said, once each.
buildAndTest() {
  local preset=$1 folder=build-$1 targets=() labels=() status
  if [ "$1" = release ]; then folder=build; fi
  shift
  if [ ${#areas[@]} -gt 0 ]; then
    targets=(--target "${areas[@]/%/_test}")
    labels=(-L "^($(IFS='|' && echo "${areas[*]}"))\$")
  fi
  cmake --preset "$preset" "$@" >/dev/null &&
    cmake --build --preset "$preset" --parallel "$(nproc)" "${targets[@]}" || return 1
  ctest --preset "$preset" --no-label-summary --parallel $((2 * $(nproc))) "${labels[@]}"
  status=$?
  grep -A 1 ': Skipped$' "$folder/Testing/Temporary/LastTest.log" |
    sed -n -e '/: Skipped$/d' -e '/^--$/d' -e 's/^/!! NOT TESTED: /p' | sort -u
  if [ $status -ne 0 ]; then nameFailedTests "$folder/Testing/Temporary"; fi
  sayWhatIsLeftOut "$folder" || status=1
  return $status
}

# The worker pool, pictures by many threads, the viewer's tracing thread with all that it runs, its
# window's loop, and the server of `whit serve`. Embree and TBB are not instrumented and would be blamed
# for their own locks: what happens inside them is ignored, what our code does is not. Of the shipped
# scenes two are enough: glass takes minutes, and its threads do the same.
checkThreads() {
  local areas=(unit render) area
  local filter='WorkerPool*:ParallelFor*:Analytic.*:*Invariance.H60_any*/whitted'
  filter+=':*Invariance.H60_any*/landscape:*Adaptive.H60*/0'
  filter+=':RenderThreadTest.*'
  filter+=':Viewer.SurvivesTwoHundredRandomEvents:*/FullScreenMinimizedAndResized'
  filter+=':MovingPictures.*:Viewer.PlaysUntilItIsPaused:Serving*'
  cmake --preset tsan -DWHIT_WERROR=ON >/dev/null || return 1
  if [ -d build-tsan/viewer/serve/CMakeFiles/whit_serve.dir ]; then areas+=(serve); fi
  if [ -d build-tsan/viewer/CMakeFiles/whit_view.dir ]; then
    areas+=(viewer)
  else
    echo "!! the viewer is left out: its threads are NOT checked" >&2
  fi
  cmake --build --preset tsan --parallel "$(nproc)" --target "${areas[@]/%/_test}" || return 1
  local -x HOME=$root/build-tsan/tests/home
  local -x TSAN_OPTIONS="suppressions=$root/tests/tsan.supp ignore_noninstrumented_modules=1"
  for area in "${areas[@]}"; do
    WHIT_SOURCE_DIR=$root "build-tsan/tests/${area}_test" --gtest_filter="$filter" || return 1
  done
}

# What the package and the fresh systems begin with, which is mostly to wait. They say what went wrong.
makeCleanSystems() (
  . tests/debian13.sh
  . tests/clean_system.sh
  for release in bookworm trixie; do keepCleanSystem "$release" || exit; done
) >/dev/null 2>&1

# The package is made and tried beside the steps that follow, because much of that has one thread or
# waits for the network. What comes of it is said at its step.
beginPackage() {
  set -m  # a process group of its own, for the trap
  (
    tests/package.sh
    echo "status $?"
  ) >"$packageLog" 2>&1 &
  packaging=$!
  set +m
}
endPackage() {
  local status
  while kill -0 "$packaging" 2>/dev/null; do sleep 1; done
  sed '$d' "$packageLog"
  status=$(sed -n '$s/^status //p' "$packageLog")
  return "${status:-1}"
}

# 10 s a reader; tests/fuzz/run.sh by itself runs for longer.
fuzzReaders() {
  tests/fuzz/run.sh 10
  local status=$?
  # No Clang.
  if [ "$status" -eq 77 ]; then
    [ -z "${CI:-}" ]
    return
  fi
  return "$status"
}

# Tests that miss a program are left out.
installTestPrograms() { scenes/install_packages.sh test || return 77; }

groups=(build view python)
if $full; then groups+=(clean package check); fi
if $deep; then groups+=(deep); fi
step "packages" scenes/install_packages.sh "${groups[@]}"
step "programs that tests start" installTestPrograms
useCompilerCache "$root"
if $full; then
  makeCleanSystems &
  beginPackage
fi
step "format" tests/format.sh --check
if $full; then
  tidiness=()
  if $deep; then tidiness=(--deep); fi
  step "tidy" tests/tidy.sh "${tidiness[@]}"
  step "thread sanitizer" checkThreads
  step "sanitizers" buildAndTest debug-sanitize -DWHIT_WERROR=ON
  step "fuzzing" fuzzReaders
  step "package" endPackage
  step "farm engines" tests/farm_engines.sh build-package/whit
fi
if $deep; then
  step "Embree 4 with Clang" env CXX=clang++ tests/embree4.sh
  step "Clang" buildAndTest clang -DWHIT_WERROR=ON
  step "g++ sanitizers" buildAndTest gcc-sanitize -DWHIT_WERROR=ON
  step "64-bit ARM" tests/aarch64.sh
fi
# After the builds whose objects it shares, and before the one that shares its own.
if $deep; then
  step "fresh systems" tests/fresh.sh
elif $full; then
  step "fresh systems" tests/fresh.sh --brief debian12 debian13
fi
# Last, so that the last line is that of the tests as they are shipped. Those of fresh systems are the
# same: once is enough where time counts.
if ! $full || $deep || [[ " ${leftOut[*]-} " == *" fresh systems "* ]]; then
  step "release" buildAndTest release "-DWHIT_WERROR=${CI:+ON}" -DWHIT_PYTHON=AUTO
fi
if $deep; then step "other processors" tests/emulated.sh; fi

if [ ${#leftOut[@]} -gt 0 ]; then
  echo "NOT CHECKED on this system: ${leftOut[*]}" >&2
fi
cat "$failures"
if [ ${#failed[@]} -gt 0 ]; then echo "FAILED: ${failed[*]}" >&2; fi
if [ ${#notes[@]} -gt 0 ]; then printf '%s\n' "${notes[@]}" | sort -u >&2; fi
[ ${#failed[@]} -eq 0 ]
