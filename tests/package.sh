#!/usr/bin/env bash
# Makes the Debian packages, installs them in a clean system of the same release and uses them there:
# tests/package.sh. Needs Debian, root and the network; exits 77 where there is no way to it.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build-package

. "$root/tests/debian13.sh"
. "$root/tests/clean_system.sh"
[ -r /etc/os-release ] || cannot "this is not Debian"
. /etc/os-release
[ "${ID:-}" = debian ] || cannot "this is not Debian"
needCleanSystems
for program in dpkg-shlibdeps file; do
  command -v $program >/dev/null || cannot "there is no $program here (apt-get install dpkg-dev file)"
done

work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
cmake -G Ninja -S "$root" -B "$build" -DCMAKE_BUILD_TYPE=Release -DWHIT_TESTS=OFF \
  -DWHIT_PYTHON=ON -DWHIT_HOMEPAGE=https://example.org/whit >"$work/log" ||
  { cat "$work/log"; exit 1; }
cmake --build "$build" --parallel "$(nproc)"
(cd "$build" && cpack -G DEB -B "$work" >"$work/cpack.log") || { cat "$work/cpack.log"; exit 1; }
for deb in "$work"/*.deb; do
  dpkg-deb --info "$deb" | grep -E ' (Package|Version|Depends|Recommends):'
  [ "$(dpkg-deb --field "$deb" Homepage)" = https://example.org/whit ]
done
dpkg-deb --field "$work"/whit_*.deb Recommends | grep -qw ffmpeg
if command -v lintian >/dev/null; then
  lintian --fail-on error,warning "$work"/*.deb
else
  echo "!! lintian is not installed: it is NOT asked" >&2
fi

clean=$work/clean
makeCleanSystem "$VERSION_CODENAME" "$clean" "$work/debootstrap.log"
# The container's steps in copies of it. Its release is theirs.
if [ "$VERSION_CODENAME" = bookworm ]; then "$root/tests/container.sh" "$clean"; fi
cp "$work"/*.deb "$clean/"
within() {
  chroot "$clean" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
    DEBIAN_FRONTEND=noninteractive "$@"
}
# installed PACKAGE...
installed() {
  within apt-get install -y -qq --no-install-recommends "$@" >"$work/install.log" 2>&1 ||
    { tail -20 "$work/install.log"; exit 1; }
}
# Without libwhit-dev, whose dependencies could stand in for what the others forget to name.
mapfile -t packages < <(cd "$clean" && printf '/%s\n' *.deb | grep -v libwhit-dev)
installed "${packages[@]}"

within whit render whitted --size 64x40 -o /tmp/there.exr --quiet
"$build/whit" render whitted --size 64x40 -o "$work/here.exr" --quiet
cmp "$work/here.exr" "$clean/tmp/there.exr"
within whit --version

# The module, of a model and with a shipped scene.
printf 'v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 1 -1\nf 1 2 3\nf 1 3 4\n' >"$clean/tmp/sheet.obj"
within python3 -c '
import numpy, whit
picture = whit.Scene("/tmp/sheet.obj").render(size=(64, 40))
assert picture.rgb.shape == (40, 64, 3) and picture.rgb.dtype == numpy.float32, picture.rgb
assert numpy.isfinite(picture.rgb).all() and picture.rgb.max() > 0.1, picture.rgb
picture.write("/tmp/module-sheet.exr")
whit.Scene("whitted").render(size=(64, 40)).write("/tmp/module.exr")'
within whit render /tmp/sheet.obj --size 64x40 -o /tmp/sheet.exr --quiet
within whit compare /tmp/module-sheet.exr /tmp/sheet.exr --tolerance 0 --quiet >/dev/null
within whit compare /tmp/module.exr /tmp/there.exr --tolerance 0 --quiet >/dev/null
within whit info atrium --quiet | grep triangles >/dev/null
within test -s /usr/share/doc/whit/tests/example/embed.cpp
if [ -x "$build/whit-view" ]; then
  within test -s /usr/share/applications/whit-view.desktop
  within test -s /usr/share/icons/hicolor/scalable/apps/whit-view.svg
fi
for program in whit whit-view; do
  if [ ! -x "$build/$program" ]; then
    echo "!! $program was not built: it is NOT checked" >&2
    continue
  fi
  within "$program" --help >/dev/null
  within test -s "/usr/share/bash-completion/completions/$program"
  within test -s "/usr/share/man/man1/$program.1.gz"
done
# The library, by a program that is compiled there, once by each way to find it.
within test ! -e /usr/include/whit
installed "$(cd "$clean" && printf '/%s' libwhit-dev_*.deb)" g++ cmake make pkg-config
within sh -ec 'cp -r /usr/share/doc/whit/tests/example /tmp/example
  cmake -S /tmp/example -B /tmp/example/build >/dev/null
  cmake --build /tmp/example/build --target embed >/dev/null
  c++ -std=c++20 /tmp/example/embed.cpp -o /tmp/embed $(pkg-config --cflags --libs whit)
  /tmp/example/build/embed whitted /tmp/found.exr >/dev/null
  /tmp/embed whitted /tmp/configured.exr >/dev/null'
within whit render whitted --size 96x60 --depth 4 -o /tmp/rendered.exr --quiet
for picture in found configured; do
  within whit compare /tmp/$picture.exr /tmp/rendered.exr --tolerance 0 --quiet >/dev/null
done
within dpkg --purge python3-whit whit-view libwhit-dev whit >/dev/null
within test ! -e /usr/bin/whit
within test ! -e /usr/include/whit
within test ! -e /usr/lib/python3/dist-packages/whit
echo "package: installed, used and removed in a clean $VERSION_CODENAME"
