#!/bin/sh
# Installs the module by pip into a virtual environment, without the network, and uses it there:
# pip_test.sh PYTHON BUILD-FOLDER; status 77 where there is no pip or no venv.
set -eu

root=$(cd "$(dirname "$0")/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset PYTHONPATH
export PYTHONDONTWRITEBYTECODE=1
# Untracked files beside the sources, without the caches of other programs.
untracked() {
  git -C "$root" status --porcelain --untracked-files=all -- src/python 2>/dev/null |
    sed -n '/__pycache__/d; /^??/p'
}
untracked >"$work/before"
"$1" -m venv --system-site-packages "$work/venv" >"$work/log" 2>&1 || { cat "$work/log"; exit 77; }

# The build folder is relative to the caller's folder, and CMake is told how many compilers may run.
mkdir "$work/bin"
cat >"$work/bin/cmake" <<END
#!/bin/sh
echo "\$@" >>"$work/calls"
exec "$(command -v cmake)" "\$@"
END
chmod +x "$work/bin/cmake"
cd "$(dirname "$2")"
PATH="$work/bin:$PATH" "$work/venv/bin/pip" install --no-index --no-build-isolation \
  --disable-pip-version-check --config-settings "build-dir=$(basename "$2")" "$root/src/python" \
  >"$work/log" 2>&1 || { cat "$work/log"; exit 1; }
grep -q -- "--build $(pwd -P)/$(basename "$2") --parallel $(nproc) " "$work/calls" ||
  { cat "$work/calls"; exit 1; }

cd "$work"
venv/bin/python -c '
import whit
assert whit.__file__.startswith("'"$work"'"), whit.__file__
assert whit.Scene("whitted").render(size=(48, 30)).rgb.max() > 0.1
assert whit.Scene("chess.glb").triangles > 1000'
test -s venv/lib/python3*/site-packages/whit/scenes/whitted.json
venv/bin/pip uninstall -y whit >"$work/log" 2>&1
test ! -e venv/lib/python3*/site-packages/whit
untracked >"$work/after"
diff "$work/before" "$work/after" # nothing left behind
echo "pip: installed, used and removed"
