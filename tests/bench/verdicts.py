#!/usr/bin/env python3
"""What verdicts of shadow save: whit bench with and without them in turn, as a table.

usage: verdicts.py [--whit build/whit] [--rounds 5] [--sizes 480x300,1280x720] SCENE...
"""
import argparse
import json
import statistics
import subprocess


def bench(whit, scene, size, verdicts):
    command = [whit, "bench", scene, "--size", size, "--depth", "8", "--frames", "9",
               "--verdicts", verdicts, "--quiet", "--json", "-"]
    return json.loads(subprocess.run(command, check=True, capture_output=True).stdout)["runs"][0]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--whit", default="build/whit")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--sizes", default="480x300,1280x720")
    parser.add_argument("scenes", nargs="+")
    args = parser.parse_args()
    print("| scene | size | off, ms | warm, ms | ratio | rays proved | filling, ms | MB |")
    print("|---|---|---:|---:|---:|---:|---:|---:|")
    for scene in args.scenes:
        for size in args.sizes.split(","):
            off, warm, ratios = [], [], []
            for _ in range(args.rounds):
                plain = bench(args.whit, scene, size, "off")
                proved = bench(args.whit, scene, size, "auto")
                if plain["image_hash"] != proved["image_hash"]:
                    raise SystemExit(f"{scene} {size}: the pictures differ")
                off.append(plain["frame_ms"]["median"])
                warm.append(proved["frame_ms"]["median"])
                ratios.append(warm[-1] / off[-1])
            use = proved["verdicts"]
            share = 100 * (use["lit"] + use["dark"]) / proved["rays"]["shadow"]
            print(f"| {scene} | {size} | {statistics.median(off):.1f} | "
                  f"{statistics.median(warm):.1f} | {statistics.median(ratios):.2f} | "
                  f"{share:.1f} % | {use['fill_ms']:.0f} | {use['bytes'] / 1e6:.1f} |", flush=True)


if __name__ == "__main__":
    main()
