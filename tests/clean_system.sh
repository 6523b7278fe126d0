# For scripts that try things in a clean Debian beside this system; to be sourced after debian13.sh.

# Ends the script where there is no way to another system within this one.
needCleanSystems() {
  [ "$(id -u)" = 0 ] || cannot "chroot needs root"
  chroot / true 2>/dev/null || cannot "chroot is not allowed here"
  "$root/scenes/install_packages.sh" clean || cannot "debootstrap cannot be installed"
  command -v debootstrap >/dev/null || cannot "there is no debootstrap here"
}

# apart COMMAND...: with mounts and processes of its own, which are gone when it ends, however it ends.
# As it is where the system does not allow that.
apart() {
  if unshare --mount --pid --fork true 2>/dev/null; then
    unshare --mount --propagation private --pid --fork --kill-child "$@"
  else
    "$@"
  fi
}

# debootstrapped RELEASE FOLDER LOG
debootstrapped() {
  apart debootstrap --variant=minbase "$1" "$2" "$(mirror)" >"$3" 2>&1 ||
    { tail -5 "$3"; cannot "debootstrap did not finish"; }
  echo force-unsafe-io >"$2/etc/dpkg/dpkg.cfg.d/unsafe"  # it need not survive a loss of power
}

# keepCleanSystem RELEASE: makes the system in $WHIT_CLEAN_SYSTEMS that others are copies of, or waits for
# who makes it.
keepCleanSystem() {
  local kept=$WHIT_CLEAN_SYSTEMS/$1
  (
    flock 9
    if [ ! -d "$kept" ]; then
      rm -rf "$kept.part"
      debootstrapped "$1" "$kept.part" "$kept.log"
      mv "$kept.part" "$kept"
    fi
  ) 9>"$kept.lock"
}

# makeCleanSystem RELEASE FOLDER LOG: the least that Debian has.
makeCleanSystem() {
  if [ -z "${WHIT_CLEAN_SYSTEMS:-}" ]; then
    debootstrapped "$@"
  else
    keepCleanSystem "$1" || exit
    cp -a "$WHIT_CLEAN_SYSTEMS/$1" "$2"
  fi
}
