"""Errors as Python users expect them: by their types, and by names that Python has."""

import errno
import inspect
import os
import re
import unittest
import warnings
from pathlib import Path

import numpy as np

import whit
from samples import SIZE, assert_other, assert_same, error_of, scene_of, square_scene, temporary_folder
from whit import _options
from whit._error import in_python

SOURCES = Path(__file__).resolve().parents[2] / "src"
NOT_IN_THE_LIBRARY = ("cli", "command_line", "output", "accuracy", "python")
KINDS = {2: ValueError, 3: ValueError, 4: OSError, 5: MemoryError, 130: whit.Error}
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
        self.assertNotRegex(whit.Scene.render.__doc__, "or y, z or x|see below")

    def expect(self, status, words, call, *arguments, **named):
        """Expects an error of that exit status, of Python's own type for it, in Python's words."""
        with self.subTest(status=status, words=words):
            error = error_of(call, *arguments, **named)
            self.assertEqual(error.exit_status, status)
            self.assertIsInstance(error, KINDS[status])
            self.assertRegex(str(error), words)
            self.assertIsNone(COMMAND_LINE.search(str(error)))

    def test_errors(self):
        scene = whit.Scene("whitted")
        picture = scene.render(size=SIZE)
        for words, options in (("nobody", {"camera": "nobody"}), ("^spp: expected", {"spp": 0}),
                               ("size", {"size": "wide"}), ("size", {"size": (0, 5)}),
                               (r"^size: expected \(width, height\) in p", {"size": 64}),
                               ("filmic", {"tonemap": "flmic"}), ("fov", {"fov": float("nan")}),
                               (r"expected three numbers \(x, y, z\), f", {"eye": (0, 1)}),
                               ("^crop must lie", {"crop": (0, 0, 1000, 9)}),
                               ("sphere_segments", {"sphere_segments": 16}),
                               ("^simd", {"simd": "sse9"}), ("depth", {"depth": 2**70}),
                               ("^light_samples: exp", {"light_samples": "x"})):
            self.expect(2, words, scene.render, **options)
        for status, words, arguments in (
                (3, "^max_memory_gb: expected", {"max_memory_gb": -1}),
                (3, "^max_memory_gb", {"max_memory_gb": float("nan")}),
                (3, "^threads: expected a whole", {"threads": -1}),
                (3, "^movable: expected a list", {"movable": "/lights/0"}),
                (2, "^sphere_segments exp", {"sphere_segments": 2}),
                (5, ".", {"max_memory_gb": 1e-5}),
                (130, "progress", {"progress": lambda *_: False})):
            self.expect(status, words, whit.Scene, "atrium", **arguments)
        for status, words, call, *arguments in (
                (2, "^set_time: .* made without moves=True$", scene.set_time, 1),
                (2, "^set_transf", scene.set_transform, "/scene/0", [[1e30] * 4] * 3),
                (2, r"movable=\[...\]", scene.set_transform, "/scene/0", np.eye(4)),
                (3, r"whit.Mesh\(...\)", scene.update_mesh, "x", np.zeros((3, 3))),
                (2, "^'lights=4': expected a JSON pointer such", scene.set, "lights", 4),
                (3, "intensity", scene.set, "/lights/0/intensity", float("inf")),
                (3, '^camera: .* member "at"', whit.Camera, {"eye": [0, 0, 5]}, SIZE),
                (3, '^camera: .* member "eye"', whit.Camera, {"at": [0, 0, 5]}, SIZE),
                (2, r"no channel 'albedo': render\(channels=\['albedo'\]\)$",
                 picture.write, "x.albedo.png"),
                (2, "a.gif", picture.write, "a.gif"),
                (4, "/proc/a.png", picture.write, "/proc/a.png"),
                (2, "no-such-scene", whit.Scene, "no-such-scene"),
                (3, "/lights", whit.Scene, {"lights": 4})):
            self.expect(status, words, call, *arguments)
        # None of them changes the scene.
        assert_same(scene, picture.rgb)

    def test_errors_of_files_are_those_of_the_system(self):
        picture = whit.Scene("whitted").render(size=SIZE)
        with temporary_folder():
            os.mkdir("folder.png")
            for call, number, file in ((whit.Scene, errno.ENOENT, "none.json"),
                                       (picture.write, errno.ENOENT, "no/a.png"),
                                       (picture.write, errno.EISDIR, "folder.png")):
                error = error_of(call, file)
                self.assertIsInstance(error, OSError)
                self.assertEqual((error.errno, error.filename, error.file), (number, file, file))
                self.assertEqual(isinstance(error, FileNotFoundError), number == errno.ENOENT)
                self.assertRegex(str(error), f"^cannot (open|write) '?{file}'?: ")
        self.assertIsNone(whit.Error("a device failed", 4, "/").errno)

    def test_options_of_other_programs(self):
        scene = whit.Scene("whitted")
        for options, words in (({"samples": 4}, "did you mean 'spp'"),
                               ({"width": 64}, "did you mean 'size'"),
                               ({"sise": SIZE}, "did you mean 'size'"),
                               ({"depth": object()}, "depth: expected N"),
                               ({"camera": {"eye": [0, 0, 5], "at": [0, 0, 0]}},
                                r"whit\.Camera\(members, size\)"),
                               ({"light-samples": 4}, "did you mean 'light_samples'"),
                               ({"nonsense": 64}, r"'nonsense'; help\(whit\.Scene\.render\)"),
                               ({"light_sample": 4}, "did you mean 'light_samples'"),
                               ({"time": 1.0}, r"use Scene\.set_time\(seconds\), or path_time"),
                               ({"sky": "none"}, r"use an argument of whit\.Scene\(\)")):
            with self.subTest(**options), self.assertRaisesRegex(TypeError, words):
                scene.render(**options)

    def test_a_path_places_the_camera_alone(self):
        scene = whit.Scene("whitted")
        camera = scene.camera()
        for keyword, value in (("budget", "1s"), ("target", "flip=0.1"), ("camera", "above"),
                               ("camera", camera)):
            with self.subTest(**{keyword: value}):
                error = error_of(scene.render, size=SIZE, path_time=0.5, **{keyword: value})
                self.assertEqual(error.exit_status, 2)
                self.assertIn(f"{keyword} cannot be used with path_time", str(error))
        assert_other(scene.render(size=SIZE, path_time=0.5).rgb, scene)

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
            Path("a.json").write_text('{"whit": 1, "sky": {"image": "/etc/passwd"}, "scene": []}')
            with self.assertRaisesRegex(ValueError, r"\(allow_outside=True permits that\)"):
                whit.Scene("a.json")
            Path("a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 2\n")
            with self.assertWarnsRegex(UserWarning, "^degenerate triangle dropped"):
                self.assertTrue(whit.Scene("a.obj").warnings)
            with self.assertRaisesRegex(ValueError, r"\(refused by strict=True\)"):
                whit.Scene("a.obj", strict=True)


if __name__ == "__main__":
    unittest.main()
