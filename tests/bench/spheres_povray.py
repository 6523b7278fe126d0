#!/usr/bin/env python3
"""Nine spheres of glass, air and mirrors over a checkered floor: whit and POV-Ray in turn.

  tests/bench/spheres_povray.py [--rounds N] [--size WxH] [--pictures DIR]

Both have exact spheres, the same view, light, indices and reflectances, depth 8, the same smallest
contribution (--cutoff, adc_bailout) and two threads; glass casts no shadow in either. Prints the
medians of the times to trace, whit's also with spheres of 192 segments. Needs povray, and build/whit;
exits 77 without either.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from turns import WHIT, take_turns, time_whit

DEPTH, CUTOFF, THREADS, SEGMENTS = 8, 0.001, 2, 192
GLASS, AIR, MIRROR = "glass", "air", "mirror"
# Center, radius, material.
SPHERES = [((-1.6, 0.8, 0.4), 0.8, GLASS), ((-1.6, 0.8, 0.4), 0.7, AIR),
           ((0.2, 0.6, 1.3), 0.6, GLASS), ((1.8, 0.9, 0.2), 0.9, GLASS),
           ((1.8, 0.9, 0.2), 0.8, AIR), ((0.1, 1.0, -1.2), 1.0, MIRROR),
           ((-2.6, 0.5, -1.4), 0.5, MIRROR), ((2.6, 0.5, -1.6), 0.5, MIRROR),
           ((-0.7, 0.3, 1.9), 0.3, MIRROR)]
EYE, AT, FOV = (0, 2.2, 6.5), (0, 0.7, 0), 42
LIGHT = (5, 8, 6)


def whit_scene(segments):
    def item(sphere):
        center, radius, material = sphere
        return {"shape": "sphere", "radius": radius, "material": material, "segments": segments,
                "transform": {"translate": list(center)}}
    clear = {"diffuse": 0, "transmission": 1}
    return {
        "whit": 1,
        "cameras": {"main": {"eye": list(EYE), "at": list(AT), "fov": FOV}},
        "lights": [{"position": list(LIGHT), "intensity": 110}],
        "sky": {"color": [0.35, 0.5, 0.75]},
        "ambient": {"up": 0.2, "down": 0.2},
        "textures": {"fields": {"pattern": "checker", "color": [0.8, 0.8, 0.8],
                                "color2": [0.6, 0.1, 0.1], "columns": 2, "rows": 2}},
        "materials": {
            "floor": {"diffuse": 1, "diffuseMap": "fields"},
            GLASS: dict(clear, ior=1.5),
            # Within the glass: of higher priority, so that it is what a ray is in there.
            AIR: dict(clear, ior=1, priority=1),
            MIRROR: {"diffuse": 0.1, "mirror": 0.8}},
        "scene": [{"shape": "quad", "width": 80, "depth": 80, "uvRepeat": 2, "material": "floor"}] +
                 [item(sphere) for sphere in SPHERES]}


def povray_scene(width, height):
    def vector(v):  # its z points the other way
        return f"<{v[0]}, {v[1]}, {-v[2]}>"
    glass = ("pigment {{ rgbt <1, 1, 1, 1> }} interior {{ ior {} }} "
             "finish {{ ambient 0 diffuse 0 conserve_energy reflection {{ 0, 1 fresnel on }} }}")
    textures = {GLASS: glass.format(1.5), AIR: glass.format(1),
                MIRROR: "pigment { rgb 1 } finish { ambient 0.02 diffuse 0.1 reflection 0.8 }"}
    lines = [
        "#version 3.7;",
        f"global_settings {{ assumed_gamma 1 max_trace_level {DEPTH} adc_bailout {CUTOFF} }}",
        f"camera {{ location {vector(EYE)} right x*{width}/{height} up y look_at {vector(AT)} "
        f"angle 2*degrees(atan(tan(radians({FOV}/2))*{width}/{height})) }}",
        f"light_source {{ {vector(LIGHT)} rgb 1 }}",
        "background { rgb <0.35, 0.5, 0.75> }",
        "plane { y, 0 pigment { checker rgb 0.8, rgb <0.6, 0.1, 0.1> } "
        "finish { ambient 0.2 diffuse 0.8 } }"]
    for center, radius, material in SPHERES:
        shadow = "" if material == MIRROR else " no_shadow"
        lines.append(f"sphere {{ {vector(center)}, {radius} {textures[material]}{shadow} }}")
    return "\n".join(lines) + "\n"


def trace_povray(scene, width, height, picture):
    words = ["povray", f"+I{scene}", f"+W{width}", f"+H{height}", f"+WT{THREADS}", "-D", "-A"]
    words += [f"+O{picture}"] if picture else ["-F"]
    said = subprocess.run(words, check=True, text=True, capture_output=True).stderr
    found = re.search(r"Trace Time:.*\(([0-9.]+) seconds\)", said)
    if not found:
        sys.exit("POV-Ray says nothing of its time to trace:\n" + said)
    return [1000 * float(found.group(1))]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--size", default="480x300")
    parser.add_argument("--pictures", type=pathlib.Path)
    given = parser.parse_args()
    if not shutil.which("povray") or not WHIT.exists():
        print("povray or build/whit is not there: nothing is compared", file=sys.stderr)
        return 77
    width, height = (int(side) for side in given.size.split("x"))
    options = ["--size", given.size, "--depth", str(DEPTH)]
    timed = [*options, "--cutoff", str(CUTOFF), "--threads", str(THREADS), "--frames", "9"]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        exact, facets, pov = folder / "exact.json", folder / "facets.json", folder / "spheres.pov"
        exact.write_text(json.dumps(whit_scene(0)))
        facets.write_text(json.dumps(whit_scene(SEGMENTS)))
        pov.write_text(povray_scene(width, height))
        if given.pictures:
            subprocess.run([WHIT, "render", exact, *options, "-o", given.pictures / "whit.png",
                            "--quiet"], check=True)
            trace_povray(pov, width, height, given.pictures / "povray.png")
        medians = take_turns({
            "whit": lambda: time_whit(exact, *timed),
            "POV-Ray": lambda: trace_povray(pov, width, height, None),
            f"whit, {SEGMENTS} segments": lambda: time_whit(facets, *timed)}, given.rounds)
    for name, median in medians.items():
        print(f"{name:20} {median:8.1f} ms  {median / medians['whit']:6.2f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
