"""What comparisons with other renderers share: whit's time, and programs that take turns."""
import json
import pathlib
import statistics
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WHIT = ROOT / "build/whit"


def run_whit(*words):
    """What whit prints as JSON."""
    said = subprocess.run([WHIT, *words, "--json", "-", "--quiet"], check=True,
                          stdout=subprocess.PIPE, text=True).stdout
    return json.loads(said)


def time_whit(*words):
    """The median of the times of frames, in milliseconds."""
    return [run_whit("bench", *words)["runs"][0]["frame_ms"]["median"]]


def take_turns(takers, rounds):
    """The medians of the times that takers return, by their names."""
    times = {name: [] for name in takers}
    for _ in range(rounds):
        for name, take in takers.items():
            times[name] += take()
    return {name: statistics.median(taken) for name, taken in times.items()}
