#!/usr/bin/env bash
# The two commands of README.md, scenes/demo.sh and tests/run.sh, on fresh systems as debootstrap's
# minbase makes them, and in them nothing but the sources of this checkout's last commit:
#   tests/fresh.sh                  all of those below
#   tests/fresh.sh VISITOR...       debian12: as root. debian12-sudo: as a user with sudo. debian13: as a
#                                   user without sudo, once root has installed the packages
#   tests/fresh.sh --brief [...]    as debian13 those tests only that meet other versions of libraries
#   tests/fresh.sh --cold [...]     without what this system has compiled before: as long as it takes there
# $WHIT_DATA is not there; tests that had to do without are run again with it, as debian12. Otherwise
# ccache is installed there as well, if it is here, and shares this system's objects. A warning of the
# compiler and a file that is left in the user's home are failures. Needs root, the network and 8 GB in
# $TMPDIR (/tmp); exits 77 where there is no way to it.
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
    debian12 | debian12-sudo | debian13) visitors+=("$word") ;;
    *)
      echo "tests/fresh.sh: unknown word '$word' (--brief, --cold, debian12, debian12-sudo, debian13)" >&2
      exit 2
      ;;
  esac
done
[ ${#visitors[@]} -gt 0 ] || visitors=(debian12 debian12-sudo debian13)

needCleanSystems
unshare --mount --pid --fork true 2>/dev/null || cannot "nothing can be mounted here"
commit=$(git -C "$root" rev-parse --short HEAD 2>/dev/null) || cannot "this is not a checkout by git"
[ "$(df --output=avail -k "${TMPDIR:-/tmp}" | tail -1)" -gt 8000000 ] ||
  cannot "there is no room for it in ${TMPDIR:-/tmp}"

work=$(mktemp -d)
beside=
trap '[ -z "$beside" ] || kill -- "-$beside" 2>/dev/null; rm -rf --one-file-system "$work"' EXIT
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

# Set by visit(): the release, the system's folder, the user and the home of the visitor, and $WHIT_DATA.
release='' system='' user='' home='' data=''

# within USER COMMAND...: in the system at hand, at home.
within() {
  local user=$1 home=$home settings=()
  shift
  if [ "$user" = root ]; then home=/root; fi
  if [ -n "$objects" ]; then
    mapfile -t settings < <(
      CCACHE_BASEDIR=$home/whit
      useCompilerCache "$home/whit"
      env | grep -E '^(CCACHE_(SLOPPINESS|BASEDIR|NOHASHDIR)|CMAKE_CXX_COMPILER_LAUNCHER)='
    )
    settings+=(CCACHE_DIR=/var/cache/ccache)
    # Those are root's: a user has some of his own, which are kept as well.
    if [ "$user" != root ]; then settings+=(CCACHE_DIR=/var/cache/ccache/visitor); fi
  fi
  if [ -n "$data" ]; then settings+=(WHIT_DATA=/data); fi
  apart bash "$enter" "$system" "$work/$release-archives" "$objects" "$data" --userspec="$user:$user" \
    "$system" /usr/bin/env -i --chdir="$home" HOME="$home" USER="$user" DEBIAN_FRONTEND=noninteractive \
    PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin "${settings[@]}" "$@" </dev/null
}

# installed PACKAGE...
installed() {
  within root apt-get install -y -qq --no-install-recommends "$@" >"$work/$release.log" 2>&1 ||
    { tail -5 "$work/$release.log"; cannot "$* cannot be installed in the fresh system"; }
}

# timed WHAT COMMAND...: its time, and the end of what it says when it fails or its compiler warns.
timed() {
  local what="$visitor, $1" start=$SECONDS status=0 log
  log=$logs/$(tr -cs 'a-z0-9\n' - <<<"$what").log
  shift
  within "$user" "$@" >"$log" 2>&1 || status=$?
  if grep -m 5 'warning: .*\[-W' "$log"; then
    echo "!! $what: warnings, see $log" >&2
    status=1
  elif [ $status -ne 0 ]; then
    tail -40 "$log" | cut -c 1-200
    echo "!! $what: ended with $status, see $log" >&2
  fi
  echo "$what: $((SECONDS - start)) s"
  return $status
}

# makeBase RELEASE: the system that visitors get copies of.
makeBase() {
  release=$1 system=$work/$1
  mkdir "$work/$release-archives"
  echo "-- a fresh $release, and commit $commit"
  makeCleanSystem "$release" "$system" "$work/$release.log"
  within root apt-get update -qq || cannot "there is no package list for the fresh system"
  if [ -n "$objects" ]; then installed ccache; fi
}

# answers: whether `whit serve` gives its page to who has its address.
answers() {
  # shellcheck disable=SC2016  # expanded there
  within "$user" bash -c '
    whit/build/whit serve matte --size 64x40 --port 0 --quiet >address &
    for _ in $(seq 300); do [ ! -s address ] || break; sleep 0.1; done
    IFS=/: read -r _ _ _ host port path <address
    exec 3<>"/dev/tcp/$host/$port"
    printf "GET /%s/ HTTP/1.0\r\nHost: %s:%s\r\n\r\n" "$path" "$host" "$port" >&3
    head -1 <&3 | grep " 200 "
    status=$?
    kill $!
    rm address
    exit $status' >"$work/$release.log" 2>&1 ||
    { cat "$work/$release.log"; echo "!! $visitor: whit serve does not answer" >&2; return 1; }
}

# testWithData: those tests again that were skipped because $WHIT_DATA was missing.
testWithData() {
  local skipped
  skipped=$(awk '/WHIT_DATA/ { missing = 1 }
                 /^\[ RUN      \]/ { missing = 0 }
                 /^\[  SKIPPED \] .*\(/ && missing { printf "%s:", $4 }' \
    "$system$home/whit/build/Testing/Temporary/LastTest.log" | tr -d ,)
  data=$WHIT_DATA
  timed "tests with \$WHIT_DATA" env GTEST_FILTER="${skipped:?}" \
    ctest --test-dir whit/build --output-on-failure --no-label-summary -R 'part_|readme'
  data=
}

# visit VISITOR: both commands, and what was built put where it belongs.
visit() {
  local visitor=$1 areas=() status=0 log before
  case $visitor in
    debian12*) release=bookworm ;;
    debian13*) release=trixie ;;
  esac
  [ -d "$work/$release" ] || makeBase "$release"
  system=$work/$visitor user=root home=/root
  cp -a "$work/$release" "$system"
  if [ "$visitor" != debian12 ]; then
    user=visitor home=/home/visitor
    within root useradd --create-home visitor
    if [ -n "$objects" ]; then within root install -d -o visitor /var/cache/ccache/visitor; fi
  fi
  if [ "$visitor" = debian12-sudo ]; then
    installed sudo
    echo 'visitor ALL=(ALL) NOPASSWD: ALL' >"$system/etc/sudoers.d/visitor"
  fi
  mkdir "$system$home/whit"
  git -C "$root" archive HEAD | tar -x -C "$system$home/whit"
  if [ "$visitor" = debian13 ]; then
    within root "$home/whit/scenes/install_packages.sh" build view python test >"$work/$release.log" 2>&1 ||
      { tail -5 "$work/$release.log"; cannot "the packages cannot be installed in the fresh system"; }
  fi
  within root chown -R "$user:$user" "$home/whit"
  before=$(ls -A "$system$home")

  timed "scenes/demo.sh" whit/scenes/demo.sh && answers || status=1
  if $brief && [ "$visitor" = debian13 ]; then areas=(hard io images serve); fi
  timed "tests/run.sh" whit/tests/run.sh "${areas[@]}" || status=1
  log=$logs/$visitor-tests-run-sh.log
  grep -E 'tests passed|^NOT CHECKED|^!! LEFT OUT|^-- release' "$log" | sed 's/^/   /' || true
  if [ -s "$system$home/whit/build/left_out.txt" ]; then status=1; fi
  diff <(echo "$before") <(ls -A "$system$home") || { echo "!! $visitor: files left at home"; status=1; }

  if [ "$visitor" = debian12 ]; then
    if [ -n "${WHIT_DATA:-}" ]; then testWithData || status=1; fi
    timed "the rest to install" cmake --build whit/build --target shipped &&
      timed "cmake --install" cmake --install whit/build --prefix "$home/installed" || status=1
  fi
  rm -rf --one-file-system "$system"
  return $status
}

# visitAll VISITOR...: one after the other; those that fail are named in a file.
visitAll() {
  local visitor status
  for visitor in "$@"; do
    # Not as a condition: the shell would then go on after what fails within.
    set +e
    (set -e; visit "$visitor")
    status=$?
    set -e
    case $status in
      0) ;;
      77) exit 77 ;;
      *) echo "$visitor" >>"$work/failed" ;;
    esac
  done
}

# Much of a visit has one thread or waits for the network: Debian 13 is visited beside the other.
ofDebian13=() ofDebian12=()
for visitor in "${visitors[@]}"; do
  case $visitor in
    debian13) ofDebian13+=("$visitor") ;;
    *) ofDebian12+=("$visitor") ;;
  esac
done
set -m  # a process group of its own, for the trap
visitAll "${ofDebian13[@]}" >"$work/beside.log" 2>&1 &
beside=$!
set +m
visitAll "${ofDebian12[@]}"
status=0
wait "$beside" || status=$?
beside=
cat "$work/beside.log"
[ $status -eq 0 ] || exit $status
if [ -s "$work/failed" ]; then
  echo "fresh: failed as $(xargs <"$work/failed")" >&2
  exit 1
fi
echo "fresh: both commands work as ${visitors[*]}"
