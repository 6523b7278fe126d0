# For scripts that build against Debian 13's libraries beside a system that has others; to be
# sourced, after leaveOut() has been defined: it is called with the reason when there is no way.

# Ends the script with 77: a mirror out of reach, or a system that forbids, is no fault of the project.
cannot() {
  echo "!! NOT checked: $1" >&2
  exit 77
}

# The mirror that this machine installs from, if it is Debian's; else the usual one.
mirror() {
  apt-get indextargets --format '$(REPO_URI) $(ORIGIN) $(RELEASE)' 'Created-By: Packages' 2>/dev/null |
    awk '$2 == "Debian" && $1 !~ /security/ { print $1; found = 1; exit }
         END { if (!found) print "http://deb.debian.org/debian" }'
}

# privateApt FOLDER ARCHITECTURE WORDS...: apt-get with lists, sources and cache of its own; those of
# the system are neither read nor changed.
privateApt() {
  apt-get -qq -o Dir::Etc="$1/etc" -o Dir::Etc::sourcelist="$1/etc/sources.list" \
    -o Dir::Etc::sourceparts=- -o Dir::State="$1/state" -o Dir::Cache="$1/cache" \
    -o Dir::State::status="$1/status" -o Debug::NoLocking=1 -o APT::Architecture="$2" \
    -o APT::Architectures::="$2" -o APT::Sandbox::User=root -o Acquire::Languages=none \
    -o Acquire::Retries=2 -o Acquire::http::Timeout=20 "${@:3}"
}

# fetchDebian13 FOLDER ARCHITECTURE PACKAGE...: unpacks the packages and what they depend on, but
# for the C library's headers: compilers bring their own.
fetchDebian13() {
  local folder=$1 architecture=$2 apt=$1/apt package
  local keys=/usr/share/keyrings/debian-archive-keyring.gpg
  shift 2
  if [ -e "$folder/complete" ]; then return; fi
  command -v apt-get >/dev/null || leaveOut "there is no apt-get here"
  [ -e "$keys" ] || leaveOut "Debian's keys are not here (apt-get install debian-archive-keyring)"
  rm -rf "$folder"
  mkdir -p "$apt"/{etc/preferences.d,state/lists/partial,cache/archives/partial}
  : >"$apt/status"
  echo "deb [signed-by=$keys] $(mirror) trixie main" >"$apt/etc/sources.list"
  privateApt "$apt" "$architecture" update >&2 ||
    cannot "no package lists of Debian 13 from $(mirror)"
  privateApt "$apt" "$architecture" install -y --no-install-recommends --download-only "$@" >&2 ||
    cannot "no packages of Debian 13 from $(mirror)"
  for package in "$apt"/cache/archives/*.deb; do
    case $package in
      */libc6-dev_* | */linux-libc-dev_* | */libcrypt-dev_*) ;;
      *) dpkg -x "$package" "$folder" ;;
    esac
  done
  # A compiler of another system does not look where Debian keeps what differs by architecture.
  for package in "$folder"/usr/include/*-linux-gnu; do
    [ ! -d "$package" ] || cp -r "$package/." "$folder/usr/include/"
  done
  [ -e "$folder/lib" ] || ln -s usr/lib "$folder/lib"
  rm -rf "$apt"
  touch "$folder/complete"
}
