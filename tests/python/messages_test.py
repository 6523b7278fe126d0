"""Errors as Python users expect them: by their types, and by names that Python has."""

import errno
import inspect
import os
import pathlib
import re
import unittest
import warnings

import numpy as np

import whit
from samples import SIZE, scene_of, square_scene, temporary_folder
from whit import _options
from whit._error import in_python

SOURCES = pathlib.Path(__file__).resolve().parents[2] / "src"
NOT_IN_THE_LIBRARY = ("cli", "command_line", "output", "accuracy", "python")
COMMAND_LINE = re.compile(r"(?<![\w-])--[a-z]|[A-Za-z]::[a-z]|POINTER=VALUE|\bset[A-Z][a-z]+\b|updateMesh")


def literals():
    """The string literals of the library's sources; those that the compiler joins are one."""
    for path in sorted(SOURCES.rglob("*")):
        room = path.relative_to(SOURCES).parts[0]
        if path.suffix not in (".cpp", ".h") or room in NOT_IN_THE_LIBRARY:
            continue
        code = re.sub(r"^\s*(//|#).*$", "", path.read_text(), flags=re.M)
        for joined in re.findall(r'(?:"(?:[^"\\\n]|\\.)*"\s*)+', code):
            yield "".join(re.findall(r'"((?:[^"\\\n]|\\.)*)"', joined)), path


class Messages(unittest.TestCase):
    def test_every_message_names_what_python_has(self):
        known = set(_options.OPTIONS) | set(inspect.signature(whit.Scene.__init__).parameters)
        known |= {"set", "max_memory", "up", "viewpoint"}  # have rules of their own
        known |= set(inspect.signature(whit.Scene.render).parameters)
        known |= {"time", "knobs"}  # of the programs alone
        seen = 0
        for text, path in literals():
            if "ktx extract" in text or text in ("--", " --"):  # another program; an option follows
                continue
            for word in re.findall(r"(?<![\w-])--([a-z][a-z-]*)", text):
                seen += 1
                self.assertIn(word.replace("-", "_"), known, path)
            self.assertIsNone(COMMAND_LINE.search(in_python(text)), f"{path}: {text}")
        self.assertGreater(seen, 20)

    def test_the_documentation_of_render(self):
        self.assertIsNone(COMMAND_LINE.search(whit.Scene.render.__doc__), whit.Scene.render.__doc__)

    def test_errors(self):
        scene = whit.Scene("whitted")
        cases = [
            (lambda: scene.render(spp=0), ValueError, "^spp: expected"),
            (lambda: scene.render(size=SIZE, light_samples="x"), ValueError, "^light_samples: exp"),
            (lambda: scene.render(size=SIZE, crop=(0, 0, 99, 9)), ValueError, "^crop must lie"),
            (lambda: scene.render(simd="sse9"), ValueError, "^simd"),
            (lambda: scene.set_time(1), ValueError, "^set_time: .* made without moves=True$"),
            (lambda: scene.set_transform("/scene/0", [[1e30] * 4] * 3), ValueError, "^set_transf"),
            (lambda: scene.set("lights", 4), ValueError, "^'lights=4': expected a JSON pointer such"),
            (lambda: whit.Scene("whitted", max_memory_gb=-1), ValueError, "^max_memory_gb: expected"),
            (lambda: whit.Scene("whitted", max_memory_gb=float("nan")), ValueError, "^max_memory_gb"),
            (lambda: whit.Scene("whitted", threads=-1), ValueError, "^threads: expected a whole"),
            (lambda: whit.Camera({"eye": [0, 0, 5]}, SIZE), ValueError, '^camera: .* member "at"'),
            (lambda: whit.Camera({"at": [0, 0, 5]}, SIZE), ValueError, '^camera: .* member "eye"'),
            (lambda: scene.render(size=64), ValueError, r"^size: expected \(width, height\) in p"),
            (lambda: scene.render(eye=(0, 1)), ValueError, r"expected three numbers \(x, y, z\), f"),
            (lambda: scene.set_transform("/scene/0", np.eye(4)), ValueError, r"movable=\[...\]"),
            (lambda: scene.update_mesh("x", np.zeros((3, 3))), ValueError, "whit.Mesh\\(...\\)"),
            (lambda: scene.render(size=SIZE).write("x.albedo.png"), ValueError,
             r"no channel 'albedo': render\(channels=\['albedo'\]\)$"),
            (lambda: whit.Scene("whitted", sphere_segments=2), ValueError, "^sphere_segments exp"),
            (lambda: whit.Scene("no-such-scene"), ValueError, "no-such-scene"),
            (lambda: whit.Scene({"lights": 4}), ValueError, "/lights"),
            (lambda: whit.Scene("none.json"), FileNotFoundError, "none.json"),
            (lambda: scene.render(size=SIZE).write("/no/such/a.png"), FileNotFoundError, "such/a.png"),
            (lambda: scene.render(size=SIZE).write("/proc/a.png"), OSError, "/proc/a.png"),
            (lambda: whit.Scene("atrium", max_memory_gb=1e-5), MemoryError, "."),
            (lambda: whit.Scene("landscape", progress=lambda *_: False), whit.Error, "progress"),
        ]
        for number, (call, kind, words) in enumerate(cases):
            with self.subTest(number=number), self.assertRaisesRegex(kind, words) as caught:
                call()
            self.assertIsInstance(caught.exception, whit.Error)
            self.assertIsNone(COMMAND_LINE.search(str(caught.exception)))

    def test_a_camera_is_no_dict(self):
        with self.assertRaisesRegex(TypeError, r"whit\.Camera\(members, size\)"):
            whit.Scene("whitted").render(camera={"eye": [0, 0, 5], "at": [0, 0, 0]})

    def test_errors_of_files_are_those_of_the_system(self):
        picture = whit.Scene("whitted").render(size=SIZE)
        with temporary_folder():
            os.mkdir("folder.png")
            cases = [
                (lambda: whit.Scene("none.json"), FileNotFoundError, errno.ENOENT, "none.json"),
                (lambda: picture.write("no/a.png"), FileNotFoundError, errno.ENOENT, "no/a.png"),
                (lambda: picture.write("folder.png"), OSError, errno.EISDIR, "folder.png"),
            ]
            for call, kind, number, file in cases:
                with self.subTest(file=file), self.assertRaises(kind) as caught:
                    call()
                error = caught.exception
                self.assertEqual((error.errno, error.filename, error.file), (number, file, file))
                self.assertEqual(isinstance(error, FileNotFoundError), number == errno.ENOENT)
                self.assertRegex(str(error), f"^cannot (open|write) '?{file}'?: ")
        self.assertIsNone(whit.Error("a device failed", 4, "/").errno)

    def test_options_of_other_programs(self):
        scene = whit.Scene("whitted")
        for options, words in (({"samples": 4}, "did you mean 'spp'"),
                               ({"width": 64}, "did you mean 'size'"),
                               ({"light-samples": 4}, "did you mean 'light_samples'"),
                               ({"nonsense": 64}, r"'nonsense'; help\(whit\.Scene\.render\)"),
                               ({"light_sample": 4}, "did you mean 'light_samples'"),
                               ({"time": 1.0}, r"use Scene\.set_time\(seconds\), or path_time"),
                               ({"sky": "none"}, r"use an argument of whit\.Scene\(\)")):
            with self.subTest(**options), self.assertRaisesRegex(TypeError, words):
                scene.render(**options)

    def test_what_is_told_of_scenes(self):
        dark = {"lights": []}
        with self.assertWarnsRegex(UserWarning, "^cellar is black: it has no lights, ") as caught:
            scene = whit.Scene(square_scene(**dark), name="cellar")
        self.assertEqual(caught.filename, __file__)
        self.assertEqual([str(caught.warning)], scene.warnings)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for light in ({"lights": [{"position": [0, 3, 0], "intensity": 1}]},
                          {**dark, "sky": {"color": 1}}, {**dark, "ambient": {"color": 0.5}},
                          {**dark, "materials": {"red": {"emission": 1}}}):
                self.assertEqual(scene_of(**light).warnings, [])

    def test_files_outside_and_strict(self):
        with temporary_folder():
            with open("a.json", "w", encoding="utf-8") as file:
                file.write('{"whit": 1, "sky": {"image": "/etc/passwd"}, "scene": []}')
            with self.assertRaisesRegex(ValueError, r"\(allow_outside=True permits that\)"):
                whit.Scene("a.json")
            with open("a.obj", "w", encoding="utf-8") as file:
                file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n")
            with self.assertWarnsRegex(UserWarning, "^degenerate triangle dropped"):
                self.assertTrue(whit.Scene("a.obj").warnings)
            with self.assertRaisesRegex(ValueError, r"\(refused by strict=True\)"):
                whit.Scene("a.obj", strict=True)


if __name__ == "__main__":
    unittest.main()
