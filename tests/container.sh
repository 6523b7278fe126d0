#!/usr/bin/env bash
# The steps of scenes/Containerfile, each stage in a clean system of its own, and what comes out of it in
# use: tests/container.sh [SYSTEM], SYSTEM being a clean Debian 12 that is copied; else one is made. The
# instructions are read from the file. Needs root and the network; exits 77 where there is no way to it.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
. "$root/tests/debian13.sh"
. "$root/tests/clean_system.sh"
. "$root/tests/compiler_cache.sh"
needCleanSystems

work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
base=${1:-}
if [ -z "$base" ]; then
  base=$work/base
  makeCleanSystem bookworm "$base" "$work/debootstrap.log"
fi

# With ccache here, the stage that builds has it as well, and this system's objects.
objects=
if command -v ccache >/dev/null && unshare --mount --pid --fork true 2>/dev/null; then
  objects=$(ccache --get-config=cache_dir)
  mkdir -p "$objects"
fi

# What is run apart: mounts the objects, and enters.
enter=$work/enter
cat >"$enter" <<'END'
set -e
system=$1 objects=$2
shift 2
if [ -n "$objects" ]; then
  mkdir -p "$system/var/cache/ccache"
  mount --bind "$objects" "$system/var/cache/ccache"
fi
cd /
chroot "$@"
END

system= user=root folder=/
declare -A stages=()
count=0

# within WORD...: in the stage at hand, as the file has it by now.
within() {
  local home=/root settings=()
  [ "$user" = root ] || home=/home/$user
  if [ -n "$objects" ] && [ "$user" = root ]; then
    mapfile -t settings < <(
      CCACHE_BASEDIR=$folder
      useCompilerCache "$folder"
      env | grep -E '^(CCACHE_(SLOPPINESS|BASEDIR|NOHASHDIR)|CMAKE_CXX_COMPILER_LAUNCHER)='
    )
    settings+=(CCACHE_DIR=/var/cache/ccache)
  fi
  apart bash "$enter" "$system" "$objects" --userspec="$user" "$system" /usr/bin/env -i \
    --chdir="$folder" HOME="$home" PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    "${settings[@]}" "$@" </dev/null
}

# said COMMAND...: quiet unless it fails.
said() {
  "$@" >"$work/log" 2>&1 || { tail -20 "$work/log"; exit 1; }
}

# begin IMAGE [AS NAME]
begin() {
  [ "$1" = debian:bookworm-slim ] || { echo "container: FROM $1 is not known" >&2; exit 1; }
  system=$work/stage$((count += 1)) user=root folder=/
  stages[${3:-last}]=$system
  cp -a "$base" "$system"
  if [ -n "$objects" ] && [ -n "${3:-}" ]; then
    said within sh -c 'apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
      --no-install-recommends ccache'
  fi
}

# copy [--from=STAGE] SOURCE TARGET
copy() {
  if [ "$1" = . ]; then
    mkdir -p "$system$2"
    (cd "$root" && git ls-files -z --cached --others --exclude-standard) |
      (cd "$root" && xargs -0 ls -d 2>/dev/null) | tar -C "$root" -c -T - | tar -x -C "$system$2"
  else
    # shellcheck disable=SC2086  # a pattern
    cp "${stages[${1#--from=}]}"$2 "$system$3"
  fi
}

entry=
sed -e ':more' -e '/\\$/{N;s/\\\n/ /;b more' -e '}' "$root/scenes/Containerfile" >"$work/instructions"
while read -r instruction rest; do
  case $instruction in
    '' | '#'*) continue ;;
    FROM) begin $rest ;;
    COPY) copy $rest ;;
    WORKDIR) folder=$rest && mkdir -p "$system$folder" ;;
    USER) user=$rest ;;
    RUN)
      echo "-- $rest" | cut -c 1-100
      said within sh -c "$rest"
      ;;
    ENTRYPOINT) entry=$(sed 's/[]["]//g' <<<"$rest") ;;
    *) echo "container: $instruction is not known" >&2; exit 1 ;;
  esac
done <"$work/instructions"

[ "$entry" = whit ] || { echo "container: the entry point is '$entry'" >&2; exit 1; }
objects=
within "$entry" --version
within "$entry" render whitted --size 64x40 -o there.png --quiet
test -s "$system/work/there.png"
[ "$(within id -un)" = whit ]
within "$entry" turntable whitted --size 64x40 --count 4 -o there.mp4 --quiet
test -s "$system/work/there.mp4"
if within touch /usr/bin/of_others 2>/dev/null; then
  echo "container: it does not run as a user" >&2
  exit 1
fi
echo "container: its steps work in a clean Debian 12"
