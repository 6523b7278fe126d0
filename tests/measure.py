#!/usr/bin/env python3
"""Measures speed and accuracy and writes the tables of the pages that state them.

  tests/measure.py                 all, on a machine at rest: some twenty minutes on two cores
  tests/measure.py --speed         speed: tests/bench/README.md and the table in README.md (8 min)
  tests/measure.py --avx2          speed on AVX2: its table in tests/bench/README.md (2 min)
  tests/measure.py --accuracy      accuracy: src/accuracy/README.md and the table in README.md (6 min)
  tests/measure.py --transport     against all transport: src/accuracy/README.md and its charts (7 min)
  tests/measure.py --tables-only   only the tables, from what was measured before
  tests/measure.py --hashes        image hashes: tests/verify/image_hashes.cpp

What the programs in build/ say lies in build/measured/, as JSON and CSV. A table stands between two
comments of its name; the text around them is written by hand. All figures of a page are of one commit and one
machine, but for those on AVX2 and those against all transport, which say their own: where they are not,
nothing is written and the exit status is 1. sponza-mirror needs
its model ($WHIT_DATA); without it its figures are left out, loudly.
"""
import argparse
import csv
import datetime
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build"
OUT = BUILD / "measured"
PICTURES = ROOT / "scenes/pictures"
SPEED_PAGE, ACCURACY_PAGE = "tests/bench/README.md", "src/accuracy/README.md"

FRAME = "--depth 8 --floor --frames 20"
SIZES = ["480x300", "1280x720"]
FRAME_SCENES = ["sponza-mirror", "atrium", "landscape", "whitted"]
CHOICE_SCENES = ["sponza-mirror", "atrium"]
CHOICES = ["--batch frame", "--robust off", "--threads 1", "--threads 8", "--mode reference"]
ROUNDS = 3
TRIANGLES = [1000000, 20000000]
LONG_PATHS = ["matte", "sponza-mirror", "mirrors", "whitted", "glass"]
CUTOFFS = ["1e-3", "1e-4"]
SEGMENTS = [0, 16, 48, 192]
COMPARED = ["matte", "whitted", "glass", "mirrors", "atrium", "landscape", "sponza-mirror"]
SWEPT = ["whitted", "mirrors", "atrium", "sponza-mirror", "glass"]
TRANSPORTED = ["atrium", "whitted", "glass", "sponza-mirror"]
TRANSPORT_SIZE, TRANSPORT_BUDGET = "96x60", "20"
HASHED_SIZES = ["480x300", "48x30"]


def complain(text):
    print("!! " + text, file=sys.stderr)


def has_sponza():
    return (pathlib.Path(os.environ.get("WHIT_DATA", "")) / "crytek_sponza").is_dir()


def here(scenes):
    """Those scenes whose files are here."""
    return [scene for scene in scenes if scene != "sponza-mirror" or has_sponza()]


def all_here(scenes):
    """The same as words of a command line."""
    return " ".join(here(scenes))


def run(words, **options):
    print("$ " + " ".join(str(word) for word in words), flush=True)
    return subprocess.run([str(word) for word in words], cwd=ROOT, check=True, text=True,
                          stdout=subprocess.PIPE, **options).stdout


def bench(line):
    return json.loads(run([BUILD / "whit", "bench", *line.split(), "--json", "-", "--quiet"]))


def keep(name, data):
    (OUT / name).write_text(json.dumps(data, indent=1) + "\n")


def merged(parts):
    """Several answers of whit bench as one; each comes with what its runs are to be called."""
    whole = {"machine": parts[0][0]["machine"], "runs": []}
    for answer, notes in parts:
        whole["runs"] += [{**one, **notes} for one in answer["runs"]]
    return whole


# Measuring.

def measure_choices():
    """The default, each other choice, the default again: what drifts touches all of them."""
    parts = []
    for scene in here(CHOICE_SCENES):
        for turn in range(ROUNDS):
            for choice in ["", *CHOICES, ""]:
                frames = "2" if "reference" in choice else "10"
                parts.append((bench(f"{scene} --size 480x300 --depth 8 --frames {frames} {choice}"),
                              {"choice": choice, "turn": turn}))
    keep("choices.json", merged(parts))


def measure_spheres():
    """Exact ones and triangles in turn."""
    keep("spheres.json",
         merged([(bench("whitted --size 480x300 --depth 8 --frames 9 "
                        f"--sphere-segments {segments}"), {"segments": segments})
                 for _ in range(ROUNDS) for segments in SEGMENTS]))


def measure_speed():
    for size in SIZES:
        keep(f"frames-{size}.json", bench(f"{all_here(FRAME_SCENES)} --size {size} {FRAME}"))
    keep("widths.json", merged([(bench(f"{scene} --size 480x300 {FRAME} --widths"), {})
                                for scene in here(CHOICE_SCENES)]))
    measure_choices()
    keep("effects-kernels.json", bench("matte --ab-effects --size 480x300 --frames 40"))
    keep("triangles.json",
         merged([(bench(f"landscape?triangles={n} --size 480x300 --frames 5"), {})
                 for n in TRIANGLES]))
    keep("long-paths.json",
         merged([(bench(f"{all_here(LONG_PATHS)} --size 480x300 --frames 3 --cutoff {cutoff}"),
                  {"cutoff": cutoff}) for cutoff in CUTOFFS]))
    measure_spheres()
    run([BUILD / "whit", "effects", "--out", OUT / "effects", "--quiet"])


def measure_avx2():
    for size in SIZES:
        keep(f"frames-avx2-{size}.json",
             bench(f"{all_here(FRAME_SCENES)} --size {size} {FRAME} --simd avx2"))


def measure_accuracy():
    compared = []
    for scene in here(COMPARED):
        try:
            text = run([BUILD / "whit", "compare", scene, "--size", "480x300", "--depth", "8",
                        "--cutoff", "3e-4", "--stages", "--json", "-", "--quiet"])
        except subprocess.CalledProcessError as error:  # a stage is beyond its limit, as it shows
            complain(f"{scene}: whit compare ends with {error.returncode}")
            text = error.stdout
        compared.append({"scene": scene, **json.loads(text)})
    keep("compare.json", {"machine": bench("matte --size 8x8 --frames 1")["machine"],
                          "runs": compared})
    run([BUILD / "whit", "accuracy", *here(SWEPT), "--out", OUT / "accuracy", "--quiet"])


def measure_transport():
    run([BUILD / "whit", "accuracy", *here(TRANSPORTED), "--truth", "transport", "--size",
         TRANSPORT_SIZE, "--time-budget", TRANSPORT_BUDGET, "--out", OUT / "transport", "--quiet"])
    keep("transport.json", bench("matte --size 8x8 --frames 1"))


# Tables.

def read(name):
    path = OUT / name
    return json.loads(path.read_text()) if path.exists() else None


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---|" + "---:|" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def number(value, digits=1):
    return "" if value is None else f"{value:,.{digits}f}"


def scene_of(row):
    return row["scene"].split("/")[-1].removesuffix(".json")


def scenes_of(rows):
    return list(dict.fromkeys(scene_of(r) for r in rows))


def million_rays(row):
    return sum(row["rays"].values()) / 1e6


def frame_table(data):
    runs = data["runs"]
    cells = [[f"`{stage}`"] + [number(r["stages_ms"][stage], 2) for r in runs]
             for stage in runs[0]["stages_ms"]]
    cells.append(["**frame**"] + ["**" + number(r["frame_ms"]["median"]) + "**" for r in runs])
    for name, value in [
            ("95 % of the frames within", lambda r: number(r["frame_ms"]["p95"])),
            ("Embree alone, same rays", lambda r: number(r["floor_ms"])),
            ("million rays", lambda r: number(million_rays(r), 2)),
            ("lanes filled, shadow rays", lambda r: number(r["lanes_filled"]["shadow"], 3)),
            ("lanes filled, reflections", lambda r: number(r["lanes_filled"]["reflection"], 3)),
            ("reading and decoding, ms", lambda r: number(r["load_ms"], 0)),
            ("building the BVH, ms", lambda r: number(r["build_ms"], 0))]:
        cells.append([name] + [value(r) for r in runs])
    return table(["ms a frame", *[scene_of(r) for r in runs]], cells)


def side_by_side(runs, name_of, cells_of):
    """A row a name, with the cells of all its runs in their order."""
    rows = {}
    for one in runs:
        rows.setdefault(name_of(one), []).extend(cells_of(one))
    return [[name, *cells] for name, cells in rows.items()]


def width_table(data):
    scenes = scenes_of(data["runs"])
    head = ["packets of"] + [word for scene in scenes for word in (scene + ", ms", "over floor")]
    return table(head, side_by_side(
        data["runs"], lambda r: str(r["packet"]),
        lambda r: [number(r["frame_ms"]["median"]), number(r["frame_over_floor"], 2)]))


def choice_table(data):
    scenes = scenes_of(data["runs"])

    def times(scene, choice, turn):
        return [r["frame_ms"]["median"] for r in data["runs"]
                if (scene_of(r), r["choice"], r["turn"]) == (scene, choice, turn)]

    def ratio(scene, choice):
        ratios = [times(scene, choice, turn)[0] / statistics.mean(times(scene, "", turn))
                  for turn in range(ROUNDS)]
        return number(statistics.median(ratios), 2)

    return table(["", *scenes],
                 [[f"`{choice}`"] + [ratio(scene, choice) for scene in scenes] for choice in CHOICES])


def triangle_table(data):
    return table(["million triangles", "ms", "Mray/s", "building the BVH, ms", "peak memory, MB"],
                 [[number(r["triangles"] / 1e6, 2), number(r["frame_ms"]["median"]),
                   number(r["mrays_per_s"]), number(r["build_ms"], 0), number(r["peak_rss_mb"], 0)]
                  for r in data["runs"]])


def long_path_table(data):
    columns = [f"{what}, `--cutoff {cutoff}`" for cutoff in CUTOFFS for what in ["ms", "million rays"]]
    return table(["", *columns], side_by_side(
        data["runs"], scene_of,
        lambda r: [number(r["frame_ms"]["median"]), number(million_rays(r), 2)]))


def sphere_table(data):
    def median(segments):
        return statistics.median(r["frame_ms"]["median"] for r in data["runs"]
                                 if r["segments"] == segments)

    rows = []
    for segments in SEGMENTS:
        one = next(r for r in data["runs"] if r["segments"] == segments)
        rows.append([str(segments) if segments else "exact", number(one["triangles"], 0),
                     number(median(segments)), number(median(segments) / median(0), 2),
                     number(million_rays(one), 2)])
    return table(["whitted, `--sphere-segments`", "triangles", "ms", "times the exact",
                  "million rays"], rows)


def compare_table(data):
    def row(r):
        worst = max(s["worst_ulp"] / s["limit_ulp"] if s["limit_ulp"] else s["worst_ulp"]
                    for s in r["stages"])
        return [r["scene"], f"{100 - r['pixels_ge_2_codes_pct']:.3f} %", f"{r['flip_mean']:.5f}",
                f"{r['rmse']:.1e}", number(r["path_flips_per_mpx"], 0), number(worst, 2),
                str(r["nonfinite"])]
    return table(["scene", "within one code", "FLIP", "RMSE", "path divergences a Mpixel",
                  "worst stage, share of its limit", "not finite"], [row(r) for r in data["runs"]])


def transport_table(rows):
    """What the baseline is off by, apart by cause, and what the truth is."""
    def row(r):
        error = value(r, "truth_standard_error") / value(r, "truth_mean_radiance")
        causes = ["sampling", "arithmetic", "algorithm", "transport", "total"]
        return [scene_of(r), *(f"{value(r, cause + '_flip'):.4f}" for cause in causes),
                r["truth_samples"], f"{100 * error:.2g} %", f"{value(r, 'truth_noise_flip'):.4f}"]
    return table(["FLIP of `standard`", "sampling", "arithmetic", "algorithm", "transport", "all",
                  "samples of the truth", "its standard error", "FLIP between its halves"],
                 [row(r) for r in rows if r["kind"] == "baseline"])


def transport_charts(scenes):
    return " ".join(f"![Error against all transport over time, {scene}]"
                     f"(../../scenes/pictures/transport-{scene}.svg)" for scene in scenes)


def sweep(folder="accuracy"):
    path = OUT / folder / "sweep.csv"
    return list(csv.DictReader(path.open())) if path.exists() else []


def value(row, column):
    return float(row[column]) if row and row[column] else None


def find(rows, scene, knob, wanted):
    return next((row for row in rows if scene_of(row) == scene and row["knob"] == knob
                 and row["value"] == wanted), None)


def baseline(rows, scene):
    return next(r for r in rows if scene_of(r) == scene and r["kind"] == "baseline")


def rays(row):
    return sum(value(row, kind + "_rays") for kind in
               ["primary", "shadow", "reflection", "refraction"])


def knob_table(rows):
    """A row a knob, with its values side by side."""
    knobs = {}
    for row in rows:
        if scene_of(row) == "whitted" and row["kind"] != "joint":
            knobs.setdefault(row["knob"] or "quality", []).append(row)
    columns = [("x_baseline", 2), ("total_flip", 4), ("same_samples_flip", 4)]
    return table(["whitted", "values", "time", "FLIP", "FLIP, equal samples"],
                 [[f"`--{knob}`", ", ".join(row["value"] for row in of_knob),
                   *(", ".join(number(value(row, column), digits) or "-" for row in of_knob)
                     for column, digits in columns)] for knob, of_knob in knobs.items()])


def preset_table(rows):
    """A row a scene: the presets, and what standard leaves at equal samples."""
    def preset(scene, name):
        row = baseline(rows, scene) if name == "standard" else find(rows, scene, "quality", name)
        return (f"{number(value(row, 'x_baseline'), 2)}, {number(value(row, 'total_flip'), 4)}"
                if row else "")
    names = ["standard", "reference"]
    cells = []
    for scene in scenes_of(rows):
        row, eight = baseline(rows, scene), find(rows, scene, "depth", "8")
        cells.append([scene, *(preset(scene, name) for name in names),
                      f"{value(row, 'same_samples_ge2_pct'):.3f} %",
                      number(value(row, "same_samples_flip"), 4),
                      number(value(row, "path_flips_per_mpx"), 0),
                      number(value(row, "arithmetic_max_code"), 0),
                      number(rays(row) / rays(eight), 2) if eight else ""])
    return table(["time, FLIP", *(f"`{name}`" for name in names), "two codes or more", "FLIP",
                  "path divergences a Mpixel", "codes on the same path", "rays over depth 8"], cells)


def adaptive_table(rows):
    """A row a scene, with the contrasts side by side."""
    cells = []
    for scene in scenes_of(rows):
        all16 = find(rows, scene, "spp", "16")
        found = {contrast: find(rows, scene, *knob) for contrast, knob in
                 [("4", ("contrast", "4")), ("8", ("adaptive", "on")), ("16", ("contrast", "16")),
                  ("24", ("contrast", "24"))]}
        found = {contrast: row for contrast, row in found.items() if row}
        if not all16 or not found:
            continue
        def beside(text):
            return ", ".join(text(row) for row in found.values())
        cells.append([scene, ", ".join(found), beside(lambda row: number(rays(row) / rays(all16), 2)),
                      beside(lambda row: number(value(row, "x_baseline") / value(all16, "x_baseline"), 2)),
                      beside(lambda row: f"{value(row, 'total_relmse'):.1e}"),
                      beside(lambda row: number(value(row, "total_flip"), 4)),
                      f"{value(all16, 'total_relmse'):.1e}, {number(value(all16, 'total_flip'), 4)}"])
    return table(["`--adaptive on --spp 24`", "contrast", "rays", "time", "relMSE", "FLIP",
                  "16 samples: relMSE, FLIP"], cells)


def sizes_table(frames, scenes):
    rows = []
    for size, data in frames:
        for r in data["runs"]:
            if scene_of(r) in scenes:
                rows.append([f"{scene_of(r)}, {size}", number(r["frame_ms"]["median"]),
                             number(r["fps"]), number(r["frame_over_floor"], 2),
                             number(r["mrays_per_s"])])
    return table(["", "ms a frame", "frames a second", "frame over floor", "Mray/s"], rows)


def home_speed(frames):
    """README.md: one scene at two sizes."""
    first = frames[0][1]["runs"][0]
    return (f"{first['threads']} threads, packets of {first['packet']}, {machine_text(frames[0][1])}:"
            "\n\n" + sizes_table(frames, ["atrium"]))


def home_accuracy(data):
    """README.md: the worst scene and a common one."""
    rows = [[r["scene"], f"{100 - r['pixels_ge_2_codes_pct']:.3f} %", f"{r['flip_mean']:.5f}",
             number(r["path_flips_per_mpx"], 0)]
            for r in data["runs"] if r["scene"] in ("glass", "atrium")]
    return (f"480x300, {machine_text(data)}:\n\n" +
            table(["", "within one 8-bit code", "FLIP", "path divergences a Mpixel"], rows))


def machine_text(data):
    m = data["machine"]
    return (f"{m['cpu']}, {m['cores']} cores, kernels {m['simd']}, Embree {m['embree'].split()[0]}, "
            f"{m['compiler']}, commit {m['commit']}")


def machine_line(data, name):
    day = datetime.datetime.fromtimestamp((OUT / name).stat().st_mtime, datetime.timezone.utc)
    line = machine_text(data)
    if "packet" in data["runs"][0]:
        line += f", {data['runs'][0]['threads']} threads, packets of {data['runs'][0]['packet']}"
    return f"Measured on {day:%Y-%m-%d}: {line}."


def require_one_machine(parts):
    """Each part has a name and what it says of the machine, or nothing."""
    parts = [(name, machine) for name, machine in parts if machine]
    for name, machine in parts:
        if machine != parts[0][1]:
            sys.exit(f"tests/measure.py: {name} is of {machine}, {parts[0][0]} of {parts[0][1]}: "
                     "measure again")


def frames_of_one_machine(prefix, others=()):
    """The frames at each size, or nothing where they were not measured."""
    frames = [(size, read(f"{prefix}-{size}.json")) for size in SIZES]
    if not all(data for _, data in frames):
        complain(f"{OUT} has no {prefix}: their tables stay as they are")
        return None
    require_one_machine([(f"{prefix}-{size}.json", data["machine"]) for size, data in frames] +
                        [(name, data["machine"]) for name, data in others if data])
    return frames


def swept_machine(rows, machine):
    """What a sweep says of the machine it ran on, in the form of an answer of whit bench."""
    return {key: type(fact)(rows[0][key]) for key, fact in machine.items()} if rows else None


def put(page, tables):
    """Replaces what stands between the comments of each table's name."""
    path = ROOT / page
    text = path.read_text()
    for name, body in tables.items():
        pattern = re.compile(rf"(<!-- {re.escape(name)} -->\n).*?(<!-- /{re.escape(name)} -->)", re.S)
        text, count = pattern.subn(lambda m, body=body: m[1] + body.rstrip() + "\n" + m[2], text)
        if count != 1:
            sys.exit(f"tests/measure.py: {page} has {count} places for <!-- {name} -->")
    path.write_text(text)
    print(f"{page}: {', '.join(tables)}")


def write_speed():
    made = {"widths": width_table, "choices": choice_table,
           "triangles": triangle_table, "long-paths": long_path_table, "spheres": sphere_table}
    files = {name: read(name + ".json") for name in [*made, "effects-kernels"]}
    frames = frames_of_one_machine("frames", files.items())
    if not frames:
        return
    tables = {"machine": machine_line(frames[0][1], f"frames-{SIZES[0]}.json")}
    tables["frames-" + SIZES[0]] = frame_table(frames[0][1])
    tables["sizes"] = sizes_table(frames, ["sponza-mirror", "atrium", "landscape"])
    tables |= {name: make(files[name]) for name, make in made.items() if files[name]}
    if files["effects-kernels"]:
        ratio = files["effects-kernels"]["all_over_auto"][0]
        tables["effects-kernels"] = (
            f"With the steps of every effect, a frame of matte takes {ratio['frame']:.2f} times as "
            f"long, its part outside Embree {ratio['outside_embree']:.2f} times.")
    if (OUT / "effects/effects.csv").exists():
        put_charts("effects", {"effects": "effects.svg"})
    put(SPEED_PAGE, tables)
    put("README.md", {"speed": home_speed(frames)})


def write_avx2():
    """Kernels of AVX2 and packets of 8, on a machine that the page may have measured nothing else on."""
    frames = frames_of_one_machine("frames-avx2")
    if not frames:
        return
    machine = machine_line(frames[0][1], f"frames-avx2-{SIZES[0]}.json")
    put(SPEED_PAGE, {"avx2": machine + "\n\n" + sizes_table(frames, FRAME_SCENES)})


def put_charts(folder, pictures):
    """Charts of a report, by their names, as files: Chromium draws them. Their links are left out."""
    browser = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if not browser:
        return complain("there is no Chromium: the pictures of charts stay as they are")
    drawn = subprocess.run(
        [browser, "--headless=new", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000",
         "--dump-dom", (OUT / folder / "report.html").as_uri()],
        capture_output=True, text=True, check=True).stdout
    for name, picture in pictures.items():
        chart = re.search(rf'<svg [^>]*data-chart="{re.escape(name)}".*?</svg>', drawn, re.DOTALL)[0]
        (PICTURES / picture).write_text(re.sub(r"</?a\b[^>]*>", "", chart) + "\n")


def write_accuracy():
    compared, rows = read("compare.json"), sweep()
    if not compared:
        return complain(f"{OUT} has no comparisons: the tables of accuracy stay as they are")
    require_one_machine([("compare.json", compared["machine"]),
                         ("sweep.csv", swept_machine(rows, compared["machine"]))])
    tables = {"machine": machine_line(compared, "compare.json"),
              "compare": compare_table(compared)}
    if rows:
        tables |= {"presets": preset_table(rows), "knobs": knob_table(rows),
                   "adaptive": adaptive_table(rows)}
        put_charts("accuracy", {"knobs-whitted": "accuracy-whitted.svg"})
    put(ACCURACY_PAGE, tables)
    put("README.md", {"accuracy": home_accuracy(compared)})


def write_transport():
    machine, rows = read("transport.json"), sweep("transport")
    if not rows:
        return complain(f"{OUT} has no sweep against all transport: its tables stay as they are")
    require_one_machine([("transport.json", machine["machine"]),
                         ("transport/sweep.csv", swept_machine(rows, machine["machine"]))])
    put_charts("transport", {f"pareto-{scene}": f"transport-{scene}.svg" for scene in scenes_of(rows)})
    put(ACCURACY_PAGE, {"transport": "\n\n".join(
        [machine_line(machine, "transport.json"), transport_charts(scenes_of(rows)),
         transport_table(rows)])})


def write_hashes():
    """Publishes the image hashes of this machine for whit-verify."""
    source = ROOT / "tests/verify/image_hashes.cpp"
    text = source.read_text()
    found = {}
    for size in HASHED_SIZES:
        for target in ["avx2", "sse4"]:
            said = subprocess.run([BUILD / "whit-verify", "--hashes", size, "--simd", target],
                                  stdout=subprocess.PIPE, text=True, check=False).stdout
            for scene, digest in re.findall(r"^(.*?) +\d+x\d+ +([0-9a-f]{32}) ", said, re.M):
                hashes = found.setdefault((scene, size), [])
                if digest not in hashes:
                    hashes.append(digest)
    for (scene, size), hashes in found.items():
        text = re.sub(rf'({{"{re.escape(scene)}", "{size}"), "[0-9a-f]*"(,\s*"[0-9a-f]*")?',
                      rf"\g<1>" + "".join(f', "{digest}"' for digest in hashes), text)
    source.write_text(text)
    subprocess.run(["clang-format", "-i", source], check=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    jobs = {"speed": (measure_speed, write_speed), "avx2": (measure_avx2, write_avx2),
            "accuracy": (measure_accuracy, write_accuracy),
            "transport": (measure_transport, write_transport)}
    for name in [*jobs, "tables-only", "hashes"]:
        parser.add_argument("--" + name, action="store_true")
    wanted = vars(parser.parse_args())
    if wanted["hashes"]:
        return write_hashes()
    chosen = [job for name, job in jobs.items() if wanted[name]] or list(jobs.values())
    if not wanted["tables_only"]:
        if not (BUILD / "whit").exists():
            sys.exit("tests/measure.py: there is no build/whit; scenes/demo.sh makes it")
        if not has_sponza():
            complain("$WHIT_DATA has no crytek_sponza: sponza-mirror is left out")
        OUT.mkdir(parents=True, exist_ok=True)
        for measure, _ in chosen:
            measure()
    for _, write in chosen:
        write()


if __name__ == "__main__":
    main()
