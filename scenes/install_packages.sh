#!/bin/sh
# Installs the packages of packages.txt that are missing: install_packages.sh build|view|check...
# Touches neither network nor apt when all are there. Elsewhere than on Debian and Ubuntu it says
# what is needed and succeeds: the build then finds it, or says what it misses.
set -eu

list=$(dirname "$0")/packages.txt
wanted=
for group in "$@"; do
  wanted="$wanted $(sed -n "s/^$group \([^ ]*\).*/\1/p" "$list")"
done

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "Not a Debian or Ubuntu system. Needed, by their names there:" $wanted >&2
  exit 0
fi

missing=
for package in $wanted; do
  state=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$state" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

echo "Installing:$missing" >&2
run=
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "Neither root nor sudo. As root: apt-get install$missing" >&2
    exit 1
  fi
  run=sudo
fi
export DEBIAN_FRONTEND=noninteractive
$run apt-get update -qq >&2
# shellcheck disable=SC2086  # a list of words
$run apt-get install -y -qq --no-install-recommends $missing >&2
