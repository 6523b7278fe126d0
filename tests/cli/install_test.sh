#!/bin/sh
# Installs what was built into a folder of its own and uses it there: install_test.sh BUILD-FOLDER
set -eu
build=$(realpath "$1")

prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cmake --install "$1" --prefix "$prefix" >/dev/null

# A scene that exists only there: found, so the installed ones are.
cp "$prefix/share/whit/scenes/whitted.json" "$prefix/share/whit/scenes/only-installed.json"
cd "$prefix"
bin/whit render only-installed --size 32x20 -o picture.png --quiet
test -s picture.png
bin/whit info only-installed --quiet | grep triangles >/dev/null
test -s share/doc/whit/copyright
# All name the same version.
version=$(bin/whit --version | sed -n 's/^whit //p')
grep -qx "version: $version" share/doc/whit/CITATION.cff
grep -q "^## $version (" share/doc/whit/CHANGELOG.md
test -s share/doc/whit/tests/example/CMakeLists.txt
# Links of installed pages lead to installed files.
find share/doc/whit -name '*.md' | while read -r page; do
  grep -oE '\]\([^)#]+' "$page" | sed 's/](//' | grep -v '^http' | while read -r link; do
    test -s "$(dirname "$page")/$link" || { echo "$page: there is no $link" >&2; exit 1; }
  done
done
# No folder of this machine is part of a program, but for those with sanitizers, which name their sources.
for program in bin/*; do
  if grep -qa __asan_init "$program"; then continue; fi
  for folder in "$WHIT_SOURCE_DIR" "$build"; do
    ! grep -qaF "$folder" "$program" || { echo "$program names $folder" >&2; exit 1; }
  done
done
for program in bin/*; do
  name=$(basename "$program")
  [ "$name" != whit-verify ] || continue  # a test program: --help is its manual
  gzip -dc "share/man/man1/$name.1.gz" | cmp - "$build/$name.1"
  test -s "share/bash-completion/completions/$name"
  test -s "share/zsh/vendor-completions/_$name"
  test -s "share/fish/vendor_completions.d/$name.fish"
done
if [ -x bin/whit-view ]; then
  grep -qx 'Exec=whit-view %f' share/applications/whit-view.desktop
  icon=$(sed -n 's/^Icon=//p' share/applications/whit-view.desktop)
  python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse(sys.argv[1])' \
    "share/icons/hicolor/scalable/apps/$icon.svg"
  if command -v desktop-file-validate >/dev/null; then
    desktop-file-validate share/applications/whit-view.desktop
  fi
fi
echo "installed and used: 1 passed"
