#!/usr/bin/env python3
"""How well --budget keeps its promises: time used over the budget, and FLIP over that of the best of a sweep.

Renders views, drawn by a seed, of the shipped scenes, sponza-mirror and five models of $WHIT_DATA within each
budget. The reference has every knob exact and as many samples as fit in --truth seconds. The sweep renders the
combinations of its grid with as many samples as fit in the budget and takes the one with the least FLIP. Run on a
machine at rest, from the top folder, after the targets `whit` and `whit_python` are built:

  PYTHONPATH=build/python /usr/bin/python3 tests/accuracy/budget.py --views 3 --budgets 100ms 1s
"""

import argparse
import itertools
import json
import math
import os
import random
import statistics
import subprocess
import sys
import tempfile

import whit

SCENES = ["atrium", "whitted", "glass", "mirrors", "landscape", "glossy", "matte", "cornell", "orrery",
          "sponza-mirror"]
MODELS = ["TransmissionRoughnessTest.glb", "FlightHelmet/FlightHelmet.gltf",
          "blender_15_transmission/15_transmission.gltf", "blender_17_ior/17_ior.gltf", "glass-table.glb"]
EXACT = {"depth": 64, "light_samples": 4, "glossy": 4, "ambient_samples": 4}
# The grid of the sweep: what differs most in cost. Values that a scene has no use for change nothing.
GRID = {"depth": [2, 8, 64], "cutoff": [1e-3, 1e-2], "light_samples": [1, 2], "glossy": [0, 1],
        "ambient_samples": [0, 1, 4]}
NEEDS = {"depth": ("mirror", "transmission"), "cutoff": ("mirror", "transmission"),
         "light_samples": ("softShadows",), "glossy": ("glossyReflection",),
         "ambient_samples": ("ambientOcclusion",)}


def effects_of(program, source):
    """The names of the effects that the scene calls for, as `whit info` lists them."""
    said = json.loads(subprocess.run([program, "info", source, "--quiet", "--json", "-", "--glossy", "1",
                                      "--light-samples", "2", "--ambient-samples", "1"],
                                     check=True, capture_output=True, text=True).stdout)
    return {name for name, effect in said["effects"].items() if effect["on"]}


def view_of(scene, rng):
    """The scene's first view, turned about its target by up to 20 degrees and a little nearer or farther."""
    camera = scene.camera().members
    eye, at = camera["eye"], camera["at"]
    turn, away = math.radians(rng.uniform(-20, 20)), rng.uniform(0.85, 1.1)
    x, z = eye[0] - at[0], eye[2] - at[2]
    return {"eye": [at[0] + away * (x * math.cos(turn) - z * math.sin(turn)),
                    at[1] + away * (eye[1] - at[1]),
                    at[2] + away * (x * math.sin(turn) + z * math.cos(turn))], "at": at}


def milliseconds(budget):
    return float(budget[:-2]) if budget.endswith("ms") else 1000 * float(budget[:-1])


class View:
    def __init__(self, source, arguments, rng, folder):
        self.program, self.folder = arguments.whit, folder
        self.scene = whit.Scene(source)
        self.effects = effects_of(arguments.whit, source)
        self.size = tuple(int(side) for side in arguments.size.split("x"))
        self.options = {"size": self.size, **view_of(self.scene, rng)}
        exact = {**EXACT, "cutoff": 3e-5 if "transmission" in self.effects else 0}
        if "indirect" in self.effects:
            exact["indirect"] = 4
        one = self.render(spp=1, **exact)
        samples = int(1000 * arguments.truth / one.statistics["frame_ms"])
        self.truth_samples = max(16, min(samples, 2048))
        self.truth = self.write("truth", self.render(spp=self.truth_samples, **exact))

    def render(self, **more):
        return self.scene.render(**{**self.options, **more})

    def write(self, name, picture):
        path = os.path.join(self.folder, name + ".exr")
        picture.write(path)
        return path

    def flip(self, picture):
        said = subprocess.run([self.program, "compare", self.write("picture", picture), self.truth, "--json",
                               "-", "--quiet", "--tolerance", "100"], capture_output=True, text=True).stdout
        return json.loads(said)["flip_mean"]

    def combinations(self, most, rng):
        names = [name for name in GRID if self.effects.intersection(NEEDS[name])]
        grid = [dict(zip(names, values)) for values in itertools.product(*(GRID[name] for name in names))]
        rng.shuffle(grid)
        return grid[:most]

    def best_of_sweep(self, ms, grid):
        best = math.inf
        for options in grid:
            self.render(spp=1, **options)
            once = self.render(spp=1, **options).statistics["frame_ms"]
            few = max(1, min(8, int(0.1 * ms / once)))
            cost = self.render(spp=few, **options).statistics["frame_ms"] / few
            samples = int(ms / cost)
            if samples >= 1:
                best = min(best, self.flip(self.render(spp=min(samples, 4096), **options)))
        return best


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--whit", default="build/whit")
    parser.add_argument("--views", type=int, default=20)
    parser.add_argument("--budgets", nargs="+", default=["100ms", "1s", "10s"])
    parser.add_argument("--size", default="480x300")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--combinations", type=int, default=72, help="of the sweep, at most; 0: no sweep")
    parser.add_argument("--truth", type=float, default=60, help="seconds for the reference of a view")
    arguments = parser.parse_args()
    data = os.environ.get("WHIT_DATA", "")
    models = [os.path.join(data, "gltf", model) for model in MODELS]
    missing = [model for model in models if not os.path.exists(model)]
    if not os.path.isdir(os.path.join(data, "crytek_sponza")):
        missing.append("sponza-mirror")
    for source in missing:
        print(f"!! NOT measured, its files are not in $WHIT_DATA: {source}", file=sys.stderr)
    sources = [source for source in SCENES + models if source not in missing]
    rng = random.Random(arguments.seed)
    views = sources + [rng.choice(sources) for _ in range(max(arguments.views - len(sources), 0))]
    rng.shuffle(views)
    print("| view | budget | time / budget | FLIP | FLIP / best of the sweep | as expected | note |")
    print("|---|---:|---:|---:|---:|---:|---|", flush=True)
    used, ratios, held = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        for number, source in enumerate(views[:arguments.views]):
            view = View(source, arguments, random.Random(f"{arguments.seed} {number}"), folder)
            grid = view.combinations(arguments.combinations, rng)
            for budget in arguments.budgets:
                picture = view.render(budget=budget)
                receipt, ms = picture.receipt, milliseconds(budget)
                share = (receipt["choose_ms"] + receipt["picture_ms"]) / ms
                flip = view.flip(picture)
                best = view.best_of_sweep(ms, grid) if grid else math.inf
                within = receipt["error_low"] <= flip <= receipt["error_high"]
                known = math.isfinite(receipt["error_high"])
                if known:
                    held.append(within)
                if "too small" not in receipt["note"] and "early" not in receipt["note"]:
                    used.append(share)
                if math.isfinite(best):
                    ratios.append(flip / best if best > 0 else 1.0)
                name = os.path.splitext(os.path.basename(source))[0]
                ratio = f"{ratios[-1]:.2f}" if math.isfinite(best) else "-"
                print(f"| {name} | {budget} | {share:.2f} | {flip:.4f} | {ratio} | "
                      f"{receipt['error']:.4f} {('yes' if within else 'no') if known else 'not known'} | "
                      f"{receipt['note'].split(':')[0]} |", flush=True)
    good = sum(0.85 <= share <= 1.15 for share in used)
    print(f"\nWithin 15 % of the budget: {good} of {len(used)} that it is neither too small nor too large for. "
          f"Within the stated error: {sum(held)} of {len(held)}.")
    if ratios:
        print(f"FLIP over that of the best of the sweep: median {statistics.median(ratios):.2f}, "
              f"largest {max(ratios):.2f}.")


if __name__ == "__main__":
    main()
