#!/usr/bin/env bash
# Plants known mistakes one at a time in a copy of the sources, builds the tests of the hard cases,
# and sees that some test turns red. Slow: each mistake rebuilds a kernel for every target.
#   tests/mutate.sh              all
#   tests/mutate.sh NAME...      these
#   tests/mutate.sh --list       their names
# Exits 1 when a mistake survives. The copy is $WHIT_MUTATE_DIR, else build/mutate; it is kept, so
# that the next run is faster.
set -uo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
copy=${WHIT_MUTATE_DIR:-$root/build/mutate}
names=()
survived=()

# plant NAME FILE OLD NEW: OLD occurs once in FILE.
plant() {
  names+=("$1")
  if [ "${#wanted[@]}" -gt 0 ] && [[ ! " ${wanted[*]} " =~ " $1 " ]]; then return; fi
  if [ "$mode" = list ]; then echo "$1"; return; fi
  # An interrupted run must not leave its mistake to the next.
  trap "cp '$root/$2' '$copy/$2'" EXIT
  cp "$root/$2" "$copy/$2"
  if ! OLD=$3 NEW=$4 perl -0pi -e '$n = s/\Q$ENV{OLD}\E/$ENV{NEW}/g; END { exit($n != 1) }' \
      "$copy/$2"; then
    echo "$1: the place is not there once in $2" >&2
    survived+=("$1 (not planted)")
  else
    try "$1"
  fi
  cp "$root/$2" "$copy/$2"
}

# Builds and tests the copy as it is now.
try() {
  if ! cmake --build "$copy/build" --target hard_test >"$copy/build.log" 2>&1; then
    echo "$1: does not build, see $copy/build.log"
    survived+=("$1 (not built)")
    return
  fi
  WHIT_SOURCE_DIR=$copy timeout 600 "$copy/build/tests/hard_test" >"$copy/test.log" 2>&1
  local status=$?
  local red
  red=$(sed -n 's|^\[  FAILED  \] Hard/CaseTest.Holds/\([A-Za-z0-9]*\), where.*|\1|p' \
    "$copy/test.log" | sort -Vu | paste -sd' ')
  if [ $status -eq 0 ]; then
    echo "$1: SURVIVED"
    survived+=("$1")
  elif [ -n "$red" ]; then
    echo "$1: caught by $red"
  else
    red=$(sed -n 's|^\[ RUN      \] Hard/CaseTest.Holds/||p' "$copy/test.log" | tail -1)
    echo "$1: caught by $red (the program ended with status $status)"
  fi
}

mutations() {
  plant fixed-epsilon simd/ray_origin-inl.h \
    'hn::Set(d, -kTowardsViewer), ng), bound, position)' \
    'hn::Set(d, -kTowardsViewer), ng), hn::Set(d, 1e-3f), position)'
  plant no-offset simd/ray_origin-inl.h \
    'hn::Set(d, -kTowardsViewer), ng), bound, position)' \
    'hn::Set(d, -kTowardsViewer), ng), hn::Zero(d), position)'
  plant normal-offset-only src/core/shading_choices.h 'kTowardsViewer = 0.5f' 'kTowardsViewer = 0'
  plant wrong-offset-side simd/add_impulses.cpp \
    'ChildOrigin(job, lanes, i, -1.0f)' 'ChildOrigin(job, lanes, i, 1.0f)'
  plant unfactored-fresnel simd/fresnel-inl.h \
    'const VF g2 = hn::MulAdd(c, c, k);' \
    'const VF g2 = hn::Add(hn::Sub(hn::Mul(eta, eta), one), hn::Mul(c, c));'
  plant no-total-reflection simd/fresnel-inl.h \
    'f = hn::IfThenElse(total, one, hn::Min(f, one));' \
    'f = hn::IfThenElse(total, zero, hn::Min(f, one));'
  plant same-index-reflects simd/fresnel-inl.h 'f = hn::IfThenElse(straight, zero, f);' ''
  plant light-behind-surface simd/find_radiance_and_shadow_rays.cpp \
    'hn::And(front, hn::Gt(Dot(ns, toLight), zero))' 'hn::Gt(Dot(ns, toLight), zero)'
  plant shadow-ray-too-long simd/light-inl.h \
    'shortest = hn::Set(d, 1.0f - 0x1p-22f)' 'shortest = hn::Set(d, 1.0f + 0x1p-10f)'
  plant light-without-radius simd/light-inl.h \
    'hn::Div(nl, hn::Max(distanceSquared, radiusSquared_))' \
    'hn::Div(nl, distanceSquared)'
  plant flipped-normal simd/surface-inl.h \
    'return hn::IfThenElse(entering, hn::Set(d, 1.0f), hn::Set(d, -1.0f));' \
    'return (void)entering, hn::Set(d, 1.0f);'
  plant normal-of-tiny-triangle simd/surface-inl.h \
    'const VF scale = InverseExponent(largest);
  const V3 unit' 'const VF scale = hn::Set(FloatTag(), 1.0f); (void)largest;
  const V3 unit'
  plant unmasked-lane simd/add_impulses.cpp \
    'const size_t live = HWY_MIN(hn::Lanes(d), n - i);' 'const size_t live = hn::Lanes(d);'
  plant dropped-lane simd/add_impulses.cpp \
    'return compactor.Count();' 'return compactor.Count() - (compactor.Count() > 3 ? 1 : 0);'
  plant no-lift simd/add_impulses.cpp \
    'const MF low = hn::Lt(height, lift);' 'const MF low = hn::Lt(height, hn::Set(d, -2.0f)); (void)lift;'
  plant wrong-bend simd/add_impulses.cpp \
    'MulAdd3(lanes.ns, hn::Neg(interface.bend), lanes.direction)' \
    'MulAdd3(lanes.ns, interface.bend, lanes.direction)'
  plant nan-throughput simd/add_impulses.cpp \
    'hn::And(live, hn::And(hn::Ge(throughput, cutoff), hn::Gt(largest, hn::Zero(d))))' \
    'hn::AndNot(hn::Lt(throughput, cutoff), live)'
  plant media-not-removed simd/media-inl.h \
    'return hn::IfThenElse(byteIs(stack), above, result);' 'return result;'
  plant far-texture-coordinate simd/texture-inl.h \
    'hn::Le(hn::Abs(s), hn::Set(d, 1048576.0f))' 'hn::Le(hn::Abs(s), hn::Set(d, 1e38f))'
  plant stale-tfar simd/packets-inl.h \
    'store(tFar, packet_column::tFar);' 'if (i == 0) store(tFar, packet_column::tFar);'
  plant off-by-one-tail src/accel/packets.h \
    'i < rays ? -1 : 0;' 'i + (rays > 1 ? 1 : 0) < rays ? -1 : 0;'
  plant bad-rays-traced simd/packets-inl.h \
    'hn::And(there, Traceable(d, ox, oy, oz, dx, dy, dz, reach))' 'there'
  plant no-retry src/render/renderer.cpp \
    'options.retry && isEnclosed(scene, *p.accel)' 'false && isEnclosed(scene, *p.accel)'
  plant eye-in-vacuum src/render/tile_tracer.cpp 'camera.media,' '0,'
  plant not-robust src/render/renderer.cpp 'accel.robust = options.robust;' 'accel.robust = false;'
}

mode=run
wanted=()
for word in "$@"; do
  case $word in
    --list) mode=list ;;
    -*) echo "tests/mutate.sh: unknown option '$word' (--list)" >&2; exit 2 ;;
    *) wanted+=("$word") ;;
  esac
done
if [ "$mode" = run ]; then
  mkdir -p "$copy"
  (cd "$root" && cp -ru CMakeLists.txt src simd scenes viewer tests "$copy/") || exit 1
  cmake -G Ninja -S "$copy" -B "$copy/build" -DCMAKE_BUILD_TYPE=Release -DWHIT_UNITY=OFF \
    ${WHIT_MUTATE_CMAKE:-} >/dev/null || exit 1
  try "unchanged" | sed 's/SURVIVED/all green, as it must be/'
fi
mutations
if [ "$mode" = run ] && [ "${#survived[@]}" -gt 0 ]; then
  echo "SURVIVED: ${survived[*]}" >&2
  exit 1
fi
