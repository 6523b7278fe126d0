#!/usr/bin/env python3
"""Crytek's Sponza with three point lights: whit, OSPRay and Tachyon in turn.

  tests/bench/peers.py [--rounds N] [--size WxH] [--threads N] [--pictures DIR] [--page]

All trace primary rays and shadow rays of the same triangles, view and lights, one sample a pixel.
OSPRay and Tachyon shade them in one gray; whit is measured so as well, and with the textures, alpha
masks and sky of its scene. Prints the medians of the times of frames and their ratios to whit's;
--page writes them to tests/bench/README.md. OSPRay comes from Debian 13, unpacked into build/peers;
Tachyon is Debian's tachyon-bin-nox. tests/bench/spheres_povray.py measures POV-Ray on spheres.
Needs build/whit, g++ and $WHIT_DATA; exits 77 where something is missing.
"""
import argparse
import math
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys

from turns import ROOT, WHIT, take_turns, time_whit

sys.path.append(str(ROOT / "tests"))
import measure

WORK = ROOT / "build/peers"
MODEL = pathlib.Path(os.environ.get("WHIT_DATA", ROOT / "../shared/data")) / "crytek_sponza/sponza.obj"
# As in scenes/sponza-mirror.json.
EYE, AT, FOV = (-1100, 180, -40), (600, 300, -40), 65
LIGHTS = [((0, 400, -40), (500000, 440000, 350000)), ((-900, 300, -40), (260000, 230000, 190000)),
          ((500, 1150, -40), (900000, 900000, 950000))]
BARE = "textures,normalMaps,alphaMasks,skyImage"
FRAMES = 5  # of one program before the next takes its turn


def missing(text):
    print(f"peers.py: {text}: nothing is compared", file=sys.stderr)
    sys.exit(77)


def words_of(numbers):
    return ",".join(str(n) for n in numbers)


def fetch_ospray():
    """The program that renders with Debian 13's OSPRay."""
    system, program = WORK / "debian13", WORK / "ospray_frames"
    script = (f'leaveOut() {{ echo "$1" >&2; exit 77; }}; . {ROOT}/tests/debian13.sh; '
              f'fetchDebian13 {system} amd64 libospray-dev')
    if platform.machine() != "x86_64":
        missing("this is not a 64-bit PC")
    if subprocess.run(["bash", "-euc", script]).returncode:
        missing("OSPRay could not be fetched")
    libraries = system / "usr/lib/x86_64-linux-gnu"
    linked = ["--allow-shlib-undefined", "--disable-new-dtags", "-rpath", libraries,
              "--dynamic-linker", libraries / "ld-linux-x86-64.so.2"]
    subprocess.run(["g++", "-std=c++20", "-O2", ROOT / "tests/bench/ospray_frames.cpp",
                    f"-I{system}/usr/include", f"-L{libraries}", "-lospray",
                    "-Wl," + ",".join(str(word) for word in linked), "-o", program], check=True)
    return program


def time_ospray(program, renderer, job):
    lights = [words_of(position + color) for position, color in LIGHTS]
    said = subprocess.run([program, MODEL, str(job.width), str(job.height), renderer, str(FRAMES),
                           job.folder / f"ospray-{renderer}.ppm", words_of(EYE), words_of(AT),
                           str(FOV), *lights], check=True, text=True, capture_output=True,
                          env=dict(os.environ, OSPRAY_NUM_THREADS=str(job.threads))).stdout
    return [float(ms) for ms in said.split()]


def write_tachyon_scene(path, job):
    """Tachyon's z points the other way."""
    def vector(v):
        return f"{v[0]} {v[1]} {-v[2]}"
    way = [a - e for a, e in zip(AT, EYE)]
    lines = [f"begin_scene resolution {job.width} {job.height}",
             f"camera zoom {0.5 / math.tan(math.radians(FOV / 2))} aspectratio 1 antialiasing 0 "
             f"raydepth 1 center {vector(EYE)} viewdir {vector(way)} updir 0 1 0 end_camera",
             "background 0 0 0",
             "texdef gray ambient 0.05 diffuse 0.7 specular 0 opacity 1 color 1 1 1 texfunc 0"]
    lines += [f"light center {vector(position)} rad 1 color 1 1 1" for position, _ in LIGHTS]
    corners = []
    for line in MODEL.read_text(errors="replace").splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            corners.append([float(w) for w in words[1:4]])
        elif words[:1] == ["f"]:
            polygon = [int(w.split("/")[0]) for w in words[1:]]
            places = [corners[n - 1 if n > 0 else n] for n in polygon]
            lines += [f"tri v0 {vector(places[0])} v1 {vector(a)} v2 {vector(b)} gray"
                      for a, b in zip(places[1:], places[2:])]
    path.write_text("\n".join(lines + ["end_scene", ""]))


def time_tachyon(scene, job):
    said = subprocess.run(["tachyon-nox", scene, "-numthreads", str(job.threads), "-fullshade", "-o",
                           job.folder / "tachyon.tga"], check=True, text=True,
                          capture_output=True).stdout
    return [1000 * float(re.search(r"Ray Tracing Time: *([0-9.]+) seconds", said).group(1))]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--size", default="480x300")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--pictures", type=pathlib.Path, help="folder of the pictures of all")
    parser.add_argument("--page", action="store_true", help="write the table to the page")
    job = parser.parse_args()
    job.width, job.height = (int(side) for side in job.size.split("x"))
    if not WHIT.exists() or not MODEL.exists():
        missing(f"{WHIT if not WHIT.exists() else MODEL} is not there")
    if not shutil.which("tachyon-nox"):
        missing("Tachyon is not there (apt-get install tachyon-bin-nox)")
    WORK.mkdir(parents=True, exist_ok=True)
    job.folder = job.pictures or WORK
    job.folder.mkdir(parents=True, exist_ok=True)
    ospray, tachyon = fetch_ospray(), WORK / "sponza.dat"
    write_tachyon_scene(tachyon, job)
    whit = ["sponza-mirror", "--size", job.size, "--depth", "0", "--threads", str(job.threads),
            "--frames", str(FRAMES)]
    takers = {
        "whit, in gray": lambda: time_whit(*whit, "--disable", BARE),
        "whit, with textures, masks and sky": lambda: time_whit(*whit),
        "OSPRay 3.2, scivis": lambda: time_ospray(ospray, "scivis", job),
        "OSPRay 3.2, pathtracer": lambda: time_ospray(ospray, "pathtracer", job),
        "Tachyon 0.99": lambda: time_tachyon(tachyon, job),
    }
    medians = take_turns(takers, job.rounds)
    own = medians["whit, in gray"]
    table = measure.table([f"{job.size}, {job.threads} threads", "ms", "times whit"],
                          [[name, f"{ms:.1f}", f"{ms / own:.2f}"] for name, ms in medians.items()])
    print(table)
    if job.page:
        measure.put(measure.SPEED_PAGE, {"peers": table})
    return 0


if __name__ == "__main__":
    sys.exit(main())
