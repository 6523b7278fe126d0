#!/bin/sh
# Installs what was built into a folder of its own and uses it there: install_test.sh BUILD-FOLDER
set -eu

prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
cmake --install "$1" --prefix "$prefix" >/dev/null

# A scene that exists only there: found, so the installed ones are.
cp "$prefix/share/whit/scenes/whitted.json" "$prefix/share/whit/scenes/only-installed.json"
cd "$prefix"
bin/whit render only-installed --size 32x20 -o picture.png --quiet
test -s picture.png
bin/whit info only-installed --quiet | grep triangles >/dev/null
test -s share/doc/whit/LICENSE
for program in bin/*; do
  test -s "share/man/man1/$(basename "$program").1"
done
echo "installed and used: 1 passed"
