"""What mypy finds in programs that use the module: nothing in the examples of its page, and mistakes
where there are some."""

import importlib.util
import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

import whit
from examples_test import examples
from samples import temporary_folder

MISTAKES = """import whit
scene = whit.Scene("whitted")
scene.render(spp="many")
scene.render(camera=scene)
scene.camera().fow
scene.closest([0, 0, 0], [0, 0, 1]).hits
whit.Meshes([])
scene.update_mesh(3, [])
"""


def check(**programs):
    """The lines of mypy's report about programs, by their names."""
    with temporary_folder() as folder:
        for name, code in programs.items():
            Path(f"{name}.py").write_text(code)
        done = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", f"{folder}/cache",
                               *Path().glob("*.py")], capture_output=True, text=True, check=False,
                              env={**os.environ, "MYPYPATH": str(Path(whit.__file__).parents[1])})
        if done.returncode not in (0, 1):
            raise AssertionError(done.stdout + done.stderr)
        return done.stdout.splitlines()


class Types(unittest.TestCase):
    def test_examples_have_none_that_are_wrong(self):
        report = check(**{f"example{i}": code for i, code in enumerate(examples().values())})
        self.assertEqual(len(report), 1, "\n".join(report))
        self.assertIn(f"no issues found in {len(examples())} source files", report[0])

    def test_mistakes_are_found(self):
        report = check(mistakes=MISTAKES)
        found = set(re.findall(r"mistakes\.py:(\d+): error", "\n".join(report)))
        self.assertEqual(found, set("345678"), report)


if importlib.util.find_spec("mypy") is None:
    print("!! NOT checked: mypy is not installed, so that the types of the examples are unknown")
    sys.exit(77)

if __name__ == "__main__":
    unittest.main()
