#!/usr/bin/env bash
# The two commands of README.md, scenes/demo.sh and tests/run.sh, on fresh systems: Debian 12 as
# debootstrap's minbase makes it, and in it nothing but the sources of this checkout's last commit.
#   tests/fresh.sh                  as root, and as a user with sudo
#   tests/fresh.sh root | user      as one of them
#   tests/fresh.sh --brief          both, but tests/run.sh as root only
#   tests/fresh.sh --cold [...]     without what this system has compiled before: as long as it takes there
# Otherwise ccache is installed there as well, if it is here, and shares this system's objects. Needs root,
# the network and 8 GB in $TMPDIR (/tmp); exits 77 where there is no way to it. $WHIT_DATA is there, too.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
. "$root/tests/debian13.sh"
. "$root/tests/clean_system.sh"
. "$root/tests/compiler_cache.sh"
cold=false
brief=false
visitors=()
for word in "$@"; do
  case $word in
    --cold) cold=true ;;
    --brief) brief=true ;;
    root | user) visitors+=("$word") ;;
    *) echo "tests/fresh.sh: unknown word '$word' (--brief, --cold, root, user)" >&2; exit 2 ;;
  esac
done
[ ${#visitors[@]} -gt 0 ] || visitors=(root user)

needCleanSystems
unshare --mount --pid --fork true 2>/dev/null || cannot "nothing can be mounted here"
commit=$(git -C "$root" rev-parse --short HEAD 2>/dev/null) || cannot "this is not a checkout by git"
[ "$(df --output=avail -k "${TMPDIR:-/tmp}" | tail -1)" -gt 8000000 ] ||
  cannot "there is no room for it in ${TMPDIR:-/tmp}"

work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
logs=$root/build-fresh
mkdir -p "$logs"
objects=
if ! $cold && command -v ccache >/dev/null; then
  objects=$(ccache --get-config=cache_dir)
  mkdir -p "$objects"
fi

# What is run apart: mounts what a running system has, and enters.
enter=$work/enter
cat >"$enter" <<'END'
set -e
system=$1 archives=$2 objects=$3 data=$4
shift 4
mount -t proc proc "$system/proc"
mount -t devpts -o newinstance,ptmxmode=0666 devpts "$system/dev/pts"
mount --bind "$system/dev/pts/ptmx" "$system/dev/ptmx"
mount -t tmpfs -o mode=1777 tmpfs "$system/dev/shm"
mount --bind "$archives" "$system/var/cache/apt/archives"
if [ -n "$objects" ]; then
  mkdir -p "$system/var/cache/ccache"
  mount --bind "$objects" "$system/var/cache/ccache"
fi
if [ -n "$data" ]; then
  mkdir -p "$system/data"
  mount --bind "$data" "$system/data"
  mount -o remount,bind,ro "$system/data"
fi
cd /
chroot "$@"  # as a child: the first process of its own kind would take no notice of interruptions
END

# within SYSTEM USER COMMAND...
within() {
  local system=$1 user=$2 home=/root settings=()
  shift 2
  if [ "$user" != root ]; then home=/home/$user; fi
  if [ -n "$objects" ]; then
    mapfile -t settings < <(
      CCACHE_BASEDIR=$home/whit
      useCompilerCache "$home/whit"
      env | grep -E '^(CCACHE_(SLOPPINESS|BASEDIR|NOHASHDIR)|CMAKE_CXX_COMPILER_LAUNCHER)='
    )
    settings+=(CCACHE_DIR=/var/cache/ccache)
    # The objects are root's.
    if [ "$user" != root ]; then settings+=(CCACHE_READONLY=1 CCACHE_TEMPDIR=/tmp/ccache); fi
  fi
  if [ -n "${WHIT_DATA:-}" ]; then settings+=(WHIT_DATA=/data); fi
  apart bash "$enter" "$system" "$work/archives" "$objects" "${WHIT_DATA:-}" --userspec="$user:$user" "$system" \
    /usr/bin/env -i --chdir="$home" HOME="$home" USER="$user" DEBIAN_FRONTEND=noninteractive \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "${settings[@]}" "$@" </dev/null
}

# timed WHO COMMAND...: its time, and the end of what it says when it fails.
timed() {
  local who=$1 start=$SECONDS status=0 log
  log=$logs/$(tr -cs 'a-z\n' - <<<"$1").log
  shift
  "$@" >"$log" 2>&1 || status=$?
  if [ $status -ne 0 ]; then
    tail -40 "$log" | cut -c 1-200
    echo "!! $who: ended with $status, see $log" >&2
  fi
  echo "$who: $((SECONDS - start)) s"
  return $status
}

base=$work/base
mkdir "$work/archives"
echo "-- a fresh Debian 12, and commit $commit"
makeCleanSystem bookworm "$base" "$work/debootstrap.log"
within "$base" root apt-get update -qq || cannot "there is no package list for the fresh system"
if [ -n "$objects" ]; then
  within "$base" root apt-get install -y -qq --no-install-recommends ccache >"$work/log" 2>&1 ||
    { tail -5 "$work/log"; cannot "ccache cannot be installed in the fresh system"; }
fi

# visit VISITOR: both commands, and what was built put where it belongs.
visit() {
  local visitor=$1 system=$work/$1 user=root home=/root status=0
  cp -a "$base" "$system"
  if [ "$visitor" = user ]; then
    user=visitor home=/home/visitor
    within "$system" root apt-get install -y -qq --no-install-recommends sudo >"$work/log" 2>&1 ||
      { tail -5 "$work/log"; cannot "sudo cannot be installed in the fresh system"; }
    within "$system" root useradd --create-home visitor
    echo 'visitor ALL=(ALL) NOPASSWD: ALL' >"$system/etc/sudoers.d/visitor"
  fi
  mkdir "$system$home/whit"
  git -C "$root" archive HEAD | tar -x -C "$system$home/whit"
  within "$system" root chown -R "$user:$user" "$home/whit"
  timed "$visitor scenes/demo.sh" within "$system" "$user" whit/scenes/demo.sh &&
    timed "$visitor the rest to install" \
      within "$system" "$user" cmake --build whit/build --target shipped &&
    timed "$visitor cmake --install" \
      within "$system" "$user" cmake --install whit/build --prefix "$home/installed" || status=1
  if ! $brief || [ "$user" = root ]; then
    timed "$visitor tests/run.sh" within "$system" "$user" whit/tests/run.sh || status=1
    grep -E 'tests passed|^NOT CHECKED|^-- release' "$logs/$visitor-tests-run-sh.log" | sed 's/^/   /' || true
  fi
  rm -rf --one-file-system "$system"
  return $status
}
failed=()
for visitor in "${visitors[@]}"; do
  # Not as a condition: the shell would then go on after what fails within.
  set +e
  (set -e; visit "$visitor")
  status=$?
  set -e
  case $status in
    0) ;;
    77) exit 77 ;;
    *) failed+=("$visitor") ;;
  esac
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "fresh: failed as ${failed[*]}" >&2
  exit 1
fi
echo "fresh: both commands work as ${visitors[*]}"
