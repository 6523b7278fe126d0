#!/usr/bin/env bash
# Channels as programs read them that are not ours: OpenEXR's exrheader and exrinfo, and the Python
# modules of OpenImageIO, OpenCV and imageio: openexr_test.sh WHIT
set -euo pipefail

whit=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0

# A square of side 2 at z = 0, from z = 5: its middle is 5 away, and on the border of the picture there is
# nothing.
cat >"$work/scene.json" <<'END'
{"whit": 1, "size": [64, 40],
 "cameras": {"main": {"eye": [0, 0, 5], "at": [0, 0, 0], "fov": 40}},
 "materials": {"other": {"diffuse": 0.1}, "paper": {"diffuse": [0.5, 0.25, 0.125]}},
 "scene": [{"shape": "sphere", "radius": 0.1, "material": "other", "transform": {"translate": [0, 0, 9]}},
           {"shape": "quad", "material": "paper", "transform": {"rotate": [1, 0, 0, 90]}}]}
END
"$whit" render "$work/scene.json" -o "$work/a.exr" --quiet \
  --channels depth,position,normal,albedo,uv,object,material,triangle,rays

if command -v exrheader >/dev/null && command -v exrinfo >/dev/null; then
  exrheader "$work/a.exr" >"$work/header"
  exrinfo "$work/a.exr" >"$work/info" || true  # version 3.1.5 returns a status that it never sets
  for name in albedo.{R,G,B} depth.{Z,distance} normal.{X,Y,Z} position.{X,Y,Z} uv.{U,V}; do
    grep -q "    $name, 32-bit floating-point, sampling 1 1" "$work/header"
    grep -q "'$name': float samp 1 1" "$work/info"
  done
  for name in object.id material.id triangle.id rays.count; do
    grep -q "    $name, 32-bit unsigned integer, sampling 1 1" "$work/header"
    grep -q "'$name': uint samp 1 1" "$work/info"
  done
  grep -qF 'whit:objects (type string): "{"0":"/scene/0","1":"/scene/1"}"' "$work/header"
  passed=$((passed + 1))
else
  echo "openexr is not installed: what exrheader and exrinfo read is NOT checked"
fi

python=/usr/bin/python3  # of the system, which its modules are for
if $python -c 'import OpenImageIO, numpy' 2>/dev/null; then
  $python - "$work/a.exr" <<'END'
import json, sys
import numpy, OpenImageIO as oiio

image = oiio.ImageInput.open(sys.argv[1])
spec = image.spec()
formats = spec.channelformats or [spec.format] * spec.nchannels
layers = {}
for i, name in enumerate(spec.channelnames):
    isNumber = name in ("object.id", "material.id", "triangle.id", "rays.count")
    assert formats[i] == (oiio.UINT32 if isNumber else oiio.FLOAT), (name, formats[i])
    layers[name] = image.read_image(0, 0, i, i + 1, formats[i])[:, :, 0]
for name, layer in layers.items():
    assert layer.shape == (40, 64), (name, layer.shape)
y, x = numpy.mgrid[0:40, 0:64] + 0.5
half = numpy.tan(numpy.radians(20))
across, up = (2 * x / 64 - 1) * half * 64 / 40 * 5, (1 - 2 * y / 40) * half * 5
inside = (abs(across) < 1) & (abs(up) < 1)
outside = (abs(across) > 1) | (abs(up) > 1)
assert inside.sum() > 50 and outside.sum() > 50

def near(name, wanted, bound=2e-6):
    found = layers[name][inside]
    assert abs(found - (wanted[inside] if isinstance(wanted, numpy.ndarray) else wanted)).max() <= bound, name

def nothing(name, wanted):
    assert (layers[name][outside] == wanted).all(), name

near("depth.Z", 5)
near("depth.distance", numpy.sqrt(25 + across**2 + up**2))
near("position.X", across), near("position.Y", up), near("position.Z", 0)
near("normal.X", 0), near("normal.Y", 0), near("normal.Z", 1)
near("albedo.R", 0.5, 0), near("albedo.G", 0.25, 0), near("albedo.B", 0.125, 0)
for name in ("depth.Z", "depth.distance"): nothing(name, numpy.inf)
for name in ("position.X", "normal.Z", "albedo.R", "uv.U"): nothing(name, 0)
for name in ("object.id", "material.id", "triangle.id"): nothing(name, 0xffffffff)
materials = json.loads(spec.getattribute("whit:materials"))
objects = json.loads(spec.getattribute("whit:objects"))
assert {objects[str(i)] for i in layers["object.id"][inside]} == {"/scene/1"}
assert {materials[str(i)] for i in layers["material.id"][inside]} == {"paper"}
assert set(layers["triangle.id"][inside]) == {0, 1}
assert (layers["rays.count"] == 1).all()
END
  passed=$((passed + 1))
else
  echo "python3-openimageio is not installed: what it reads is NOT checked"
fi

# A channel alone is what programs without knowledge of channels read: one float, or three.
for channel in depth normal object; do
  "$whit" render "$work/scene.json" -o "$work/a.$channel.exr" --quiet
done
cat >"$work/alone.py" <<'END'
import sys
import numpy

# BGR: the order of the colors is that of OpenCV.
def check(read, bgr):
    depth, normal, number = (read(f"{sys.argv[1]}/a.{name}.exr") for name in ("depth", "normal", "object"))
    for gray in depth, number:
        assert gray.dtype == numpy.float32, gray.dtype
        gray.shape = (40, 64)
    assert normal.shape == (40, 64, 3) and normal.dtype == numpy.float32, (normal.shape, normal.dtype)
    assert abs(depth[20, 32] - 5) < 1e-5 and numpy.isinf(depth[0, 0]), (depth[20, 32], depth[0, 0])
    facing = (1, 0, 0) if bgr else (0, 0, 1)
    assert abs(normal[20, 32] - facing).max() < 1e-6, normal[20, 32]
    assert not normal[0, 0].any(), normal[0, 0]
    assert (number[20, 32], number[0, 0]) == (1, -1), (number[20, 32], number[0, 0])
END
cat >"$work/opencv.py" <<'END'
from alone import check
import cv2
check(lambda file: cv2.imread(file, cv2.IMREAD_UNCHANGED), True)
END
cat >"$work/by_imageio.py" <<'END'
import sys
from alone import check
try:
    from imageio.v3 import imread
except ImportError:  # of Debian 12
    from imageio import imread
try:
    imread(f"{sys.argv[1]}/a.depth.exr")
except (OSError, ValueError, RuntimeError) as none:  # it has no plugin of its own for EXRs
    print(none)
    sys.exit(77)
check(imread, False)
END
export OPENCV_IO_ENABLE_OPENEXR=1  # without it OpenCV reads none

# readBy MODULE PACKAGE SCRIPT
readBy() {
  local status=0
  if ! $python -c "import $1, numpy" 2>/dev/null; then
    echo "$2 is not installed: what it reads is NOT checked"
    return
  fi
  $python "$work/$3" "$work" || status=$?
  case $status in
    0) passed=$((passed + 1)) ;;
    77) echo "$2 has nothing that reads EXRs: what it reads is NOT checked" ;;
    *) exit 1 ;;
  esac
}
readBy cv2 python3-opencv opencv.py
readBy imageio python3-imageio by_imageio.py
echo "channels read by others: $passed passed"
