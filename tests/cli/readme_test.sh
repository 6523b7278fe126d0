#!/usr/bin/env bash
# The commands of README.md, as they stand there but for sizes and counts that would take long:
# readme_test.sh README WHIT [WHIT-VIEW]. A line of a code block is run when it starts one of the
# programs or a script of scenes/farm; one whose comment says "not run by the tests" is not.
set -uo pipefail

readme=$(readlink -f "$1") whit=$(readlink -f "$2") view=${3:+$(readlink -f "$3")}
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
if [ -n "$view" ]; then ln -s "$view" "$work/build/whit-view"; fi
cd "$work" || exit 1

# The files that the commands take as given: a model of one triangle, and two images.
littleEndian() {
  local word
  for word in "$@"; do
    # shellcheck disable=SC2059  # the format is the bytes
    printf "$(printf '\\x%02x\\x%02x\\x%02x\\x%02x' $((word & 255)) $((word >> 8 & 255)) \
      $((word >> 16 & 255)) $((word >> 24 & 255)))"
  done
}
makeModel() {
  local json='{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],'
  json+='"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"byteLength":36}],'
  json+='"bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,'
  json+='"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]}'
  while ((${#json} % 4)); do json+=' '; done
  printf glTF
  littleEndian 2 $((12 + 8 + ${#json} + 8 + 36)) ${#json}
  printf 'JSON%s' "$json"
  littleEndian 36
  printf 'BIN\0'
  littleEndian 0 0 0 0x3f800000 0 0 0 0x3f800000 0
}
makeModel >helmet.glb
for image in a b; do "$whit" render matte --size 48x32 -o $image.exr --quiet || exit 1; done
printf 'wait 2 frames\nquit\n' >leave.txt

# Without what takes long and shows nothing more.
cheap() {
  sed -E -e 's/ *(&& ffmpeg.*)?$//' -e 's/--size [0-9]+x[0-9]+/--size 64x40/' \
    -e 's/--frames [0-9]+( |$)/--frames 1\1/' -e 's/1\.\.48/1..2/' -e 's/--spp [0-9]+/--spp 2/' \
    -e '/whit (bench|effects)/{/--frames/!s/$/ --frames 1/}' \
    -e '/whit (bench|effects|accuracy|compare glass)/{/--size/!s/$/ --size 64x40/}' \
    -e '/whit accuracy/s/$/ --knobs spp,cutoff/' -e '/whit stress *$/s/$/ --only H13/' \
    -e '/whit-view .*--record/s/$/ --size 64x40/' \
    -e '/whit-view/{/--(benchmark|record|script)/!s/$/ --script leave.txt --size 64x40/}'
}

runs=0 left=0
while IFS= read -r line; do
  command=$(sed -E 's/ +#( .*)?$//' <<<"$line" | cheap)
  case $line in
    *"not run by the tests"*) continue ;;
    *sponza-mirror*)
      if [ -z "${WHIT_DATA:-}" ]; then
        echo "!! WHIT_DATA is not set, NOT run: $line" >&2
        left=$((left + 1))
        continue
      fi ;;
  esac
  case $command in
    *scenes/farm/*)
      if ! command -v parallel >/dev/null; then
        echo "!! GNU parallel is not installed, NOT run: $line" >&2
        left=$((left + 1))
        continue
      fi ;;
    *mpirun*)
      if ! command -v mpirun >/dev/null || ! ldd "$whit" | grep -q libmpi; then
        echo "!! without MPI, NOT run: $line" >&2
        left=$((left + 1))
        continue
      fi ;;
    *whit-view*)
      if [ -z "$view" ] || ! command -v Xvfb >/dev/null; then
        echo "!! without the viewer or Xvfb, NOT run: $line" >&2
        left=$((left + 1))
        continue
      fi
      if [ -z "$display" ]; then
        Xvfb -displayfd 3 -screen 0 800x600x24 3>number >/dev/null 2>&1 &
        display=$!
        for _ in $(seq 100); do [ -s number ] && break; sleep 0.1; done
        DISPLAY=:$(cat number)
        export DISPLAY
      fi ;;
  esac
  echo "$command"
  if ! bash -euo pipefail -c "$command" >said 2>&1 </dev/null; then
    cat said
    echo "README.md: this fails: $line" >&2
    exit 1
  fi
  runs=$((runs + 1))
done < <(awk '/^```/ { inside = !inside; next } inside' "$readme" |
  grep -E '^([A-Z]+=[^ ]+ )*((mpirun .*)?build/whit|scenes/farm/)')
test $runs -gt 10 || { echo "README.md: only $runs commands were found" >&2; exit 1; }
echo "readme: $runs commands passed, $left left out"
