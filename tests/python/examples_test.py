"""The examples of the module's page, as they stand there, and its signatures."""

import os
import re
import subprocess
import sys
import types
import unittest
from pathlib import Path

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal

import whit
from samples import (SIZE, assert_same, pixels, program, python, scene_of, square, square_scene,
                     temporary_folder)
from whit import _options
from whit._error import in_python

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PAGES = ROOT / "src" / "python" / "README.md", ROOT / "README.md"
WHITTED = whit.Scene("whitted")
PARALLEL = {"eye": [0, 3, 0], "at": [0, 0, 0], "up": [0, 0, -1], "orthographicHeight": 4}


def render(**options):
    return WHITTED.render(size=SIZE, **options)


def examples():
    """By their headings: those of the module's page and of README."""
    return {heading: code for page in PAGES
            for heading, code in re.findall(r"^##+ ([^\n]+)\n(?:(?!^##).)*?```python\n(.+?)```",
                                            page.read_text(), re.DOTALL | re.MULTILINE)}


class Examples(unittest.TestCase):
    def run_example(self, heading, *files):
        with temporary_folder():
            done = python(examples()[heading], "-W", "error",
                          env={**os.environ, "MPLBACKEND": "Agg"})
            self.assertEqual(done.returncode, 0, done.stderr)
            for file in files:
                self.assertGreater(os.path.getsize(file), 500, file)
            return done.stdout

    def test_a_picture(self):
        said = self.run_example("A picture", "whitted.png")
        self.assertTrue(said.startswith("(480, 640, 3) float32\n"), said)

    def test_readme(self):
        said = self.run_example("In Python", "chess.png")
        self.assertRegex(said, r"^0\.\d+ .+ king 0\.9\d+\n$")

    def test_what_rays_hit(self):
        said = self.run_example("What rays hit")
        cloud, camera = said.splitlines()
        points, components, certain, *shares = map(float, re.findall(r"[0-9.e-]+", cloud))
        self.assertGreater(points, 30000)
        self.assertEqual(components, 3)
        self.assertGreater(certain, 0.999)
        for share in shares:
            self.assertTrue(0.1 < share < 1, said)
        self.assertRegex(camera, r"^True \d+$")

    def test_depth_of_a_mesh(self):
        nearest, farthest = map(float, self.run_example(
            "The depth of a mesh made of arrays").split())
        self.assertAlmostEqual(nearest, 2.75, delta=0.01)
        self.assertAlmostEqual(farthest, 3.25, delta=0.01)

    def test_a_mesh_that_moves(self):
        said = self.run_example("A mesh that moves", *[f"sea{i:04}.jpg" for i in range(3)])
        self.assertAlmostEqual(float(said), 0.1 * np.sin(-2), delta=0.003)

    def test_a_film(self):
        self.run_example("A film, and a lidar that turns while things move",
                         *[f"frame{i:04}.png" for i in range(12)])

    def test_all_are_tested(self):
        self.assertEqual(len(examples()), 6)


class Signatures(unittest.TestCase):
    def test_stubs_are_those_of_the_options(self):
        done = subprocess.run([sys.executable, HERE / "make_stubs.py", "--check"],
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_every_option_is_told_of(self):
        for keyword, option in _options.OPTIONS.items():
            self.assertIn(f"{keyword} (", whit.Scene.render.__doc__)
            self.assertIn(in_python(option.help), whit.Scene.render.__doc__)

    def test_every_option_takes_its_preset(self):
        expected = pixels(WHITTED)
        for keyword, option in _options.OPTIONS.items():
            if option.preset and keyword != "size":
                assert_array_equal(render(**{keyword: option.preset}).rgb, expected, keyword)

    def test_values_as_python_has_them(self):
        for keyword, value, text in (("size", (640, 480), "640x480"),
                                     ("size", np.array([640, 480]), "640x480"),
                                     ("eye", np.array([0.5, 1, -2]), "0.5,1.0,-2.0"),
                                     ("crop", [np.int64(1), 2, 3, 4], "1,2,3,4"),
                                     ("adaptive", True, "on"),
                                     ("disable", ["shadows", "mirror"], "shadows,mirror"),
                                     ("spp", np.uint8(4), "4"),
                                     ("exposure", "auto", "auto")):
            self.assertEqual(_options.OPTIONS[keyword].text(value), text)

    def test_colors_as_python_has_them(self):
        text = _options.OPTIONS["background"].text
        for color, expected in (((1, 0.5, 0), "ff8000"), ((255, 128, 0), "ff8000"),
                                ([1.0, 0.5, 0.0], "ff8000"),
                                (np.array([255, 128, 0], np.uint8), "ff8000"),
                                ((0, 0, 0), "000000"), ((1, 1, 1), "ffffff"), ("sky", "sky")):
            self.assertEqual(text(color), expected)
        for color in (), (1, 1), (1, 1, 1, 1), (0, 0, 256), (-0.1, 0, 0), (0, float("nan"), 0):
            with self.subTest(color=color), self.assertRaisesRegex(ValueError, "^background: exp"):
                text(color)
        picture = scene_of().render(size=SIZE, background=(1, 0.5, 0))
        self.assertEqual(picture.srgb[0, 0].tolist(), [255, 128, 0])

    def test_the_module_lists_what_it_offers(self):
        self.assertEqual(dir(whit), sorted([*whit.__all__, "__version__"]))
        for name in dir(whit):
            self.assertTrue(hasattr(whit, name), name)

    def test_shipped_scenes_have_names(self):
        with temporary_folder():
            chess = whit.Scene("chess.glb")
            self.assertEqual(chess.name, "chess")
            self.assertGreater(chess.triangles, 1000)
            self.assertEqual(whit.Scene("whitted.json").triangles, WHITTED.triangles)


class Pictures(unittest.TestCase):
    def test_arrays(self):
        picture = render()
        for array, components, kind in ((picture.rgb, 3, np.float32), (picture.srgb, 3, np.uint8),
                                        (picture.rgba, 4, np.uint8), (np.asarray(picture), 3, np.float32),
                                        (np.asarray(picture, np.float64), 3, np.float64)):
            self.assertEqual((array.shape, array.dtype), ((30, 48, components), kind))
        self.assertTrue(np.shares_memory(picture.rgb, picture.rgb))
        self.assertTrue(np.shares_memory(picture.rgba, picture.srgb))
        assert_array_equal(picture.rgba[..., :3], picture.srgb)
        assert_array_equal(picture.rgba[..., 3], 255)

    def test_alpha(self):
        alpha = scene_of().render(size=SIZE, background="transparent").rgba[..., 3]
        self.assertEqual((alpha[0, 0], alpha[15, 24]), (0, 255))

    def test_files_by_their_names(self):
        picture = render(channels=["depth"])
        with temporary_folder():
            picture.write("a.jpg")
            self.assertTrue(Path("a.jpg").read_bytes().startswith(b"\xff\xd8\xff"))
            picture.write("a.depth.exr")
            for refused, name, words in (
                    (picture, "a.normal.exr", "normal"),
                    (picture, "a.depth.jpg", "a JPEG holds no channel: write 'a.depth.png'"),
                    (render(background="transparent"), "b.jpg",
                     "b.jpg': a JPEG has no alpha: write a PNG")):
                with self.assertRaisesRegex(ValueError, words):
                    refused.write(name)
            self.assertEqual(sorted(os.listdir()), ["a.depth.exr", "a.jpg"])

    def test_arrays_for_other_libraries(self):
        picture = render(channels=["depth", "object", "normal"])
        for array in (picture.rgb, picture["depth.Z"], picture["depth.distance"], picture["normal.X"],
                      picture["object"], picture["object.id"], *picture.channels.values()):
            self.assertTrue(array.flags.c_contiguous)
            self.assertTrue(np.shares_memory(np.from_dlpack(array), array))
            self.assertEqual(memoryview(array).tobytes(), array.tobytes())
        self.assertTrue(np.shares_memory(np.from_dlpack(picture.srgb), picture.srgb))
        self.assertIs(picture["depth.Z"], picture["depth.Z"])
        assert_array_equal(picture["depth.distance"], picture["depth"][:, :, 1])
        assert_array_equal(picture["normal.Z"], picture["normal"][:, :, 2])

    def test_what_is_written_to_arrays_is_in_files(self):
        with temporary_folder():
            picture = render()
            picture.rgb[:] = 0.5
            picture.srgb[:] = 188
            for name in ("a.exr", "a.png"):
                picture.write(name)
            program("compare", "a.exr", "a.png", "--tolerance", "0.01", "--quiet")

    def test_which_files_have_which_arrays(self):
        kinds = {"x.exr", "x.depth.exr", "x.depth.png", "x.png", "x.jpg"}

        def files(picture):
            for name in kinds:
                picture.write(name)
            return {name: Path(name).read_bytes() for name in kinds}

        with temporary_folder():
            for take, changed in (
                    (lambda p: p.rgb, {"x.exr"}),
                    (lambda p: p.rgba, {"x.png", "x.jpg"}),
                    (lambda p: p["depth"], {"x.exr", "x.depth.exr", "x.depth.png"}),
                    (lambda p: p["depth.Z"], set())):
                picture = scene_of().render(size=SIZE, channels=["depth"])
                png, before = picture.png(), files(picture)
                take(picture)[:] = 1
                after = files(picture)
                self.assertEqual({name for name in kinds if before[name] != after[name]}, changed)
                self.assertEqual(picture.png() != png, "x.png" in changed)

    def test_a_mesh_of_trimesh(self):
        """The page's line, with a stand-in that has trimesh's members and kinds of arrays."""
        line = re.search(r"`(whit\.Mesh\(m\.vertices.*?\))`", PAGES[0].read_text())[1]

        class TrackedArray(np.ndarray):
            pass

        def tracked(values, kind):
            return np.array(values, kind).view(TrackedArray)

        mesh = eval(line, {"whit": whit, "m": types.SimpleNamespace(
            vertices=tracked(square().positions, np.float64),
            faces=tracked(square().triangles, np.int64),
            vertex_normals=tracked([[0, 1, 0]] * 4, np.float64),
            visual=types.SimpleNamespace(uv=np.array([[0, 1], [0, 0], [1, 0], [1, 1]], float)))})
        assert_same(scene_of(mesh), scene_of())
        self.assertEqual(mesh.uvs.shape, (4, 2))

    def test_the_top_row_comes_first(self):
        rgb = pixels(whit.Scene({
            "cameras": {"c": {"eye": [0, 0, 0], "at": [1, 0, 0], "fov": 120}},
            "sky": {"zenith": [0, 0, 1], "horizon": [1, 1, 1], "ground": [0, 1, 0]}}))
        self.assertGreater(rgb[0, 24, 2], rgb[0, 24, 1])
        self.assertGreater(rgb[-1, 24, 1], rgb[-1, 24, 2])

    def test_crops_know_their_place(self):
        crop = render(crop=(8, 4, 20, 16))
        self.assertEqual((crop.left, crop.top, crop.width, crop.height), (8, 4, 12, 12))
        assert_array_equal(crop.rgb, render().rgb[4:16, 8:20])

    def test_pictures_are_mappings_of_channels(self):
        picture = render(channels=["depth", "object"])
        self.assertEqual((list(picture), len(picture)), (["depth", "object"], 2))
        self.assertEqual(set(dict(picture)), set(picture.keys()))
        for name in ("depth", "depth.Z", "object.id"):
            self.assertIn(name, picture)
        for name in ("normal", "depth.X", "normal.X", "", 0, None):
            self.assertNotIn(name, picture)
        without = render()
        self.assertEqual((list(without), without.channels), ([], {}))
        self.assertTrue(without)

    def test_channels(self):
        """Of a square in the plane y = 0, seen from 3 above by parallel rays, 2 high."""
        scene = scene_of(cameras={"above": PARALLEL})
        self.assertEqual(scene.materials, ["red"])
        picture = scene.render(size=(40, 40), channels=["depth", "normal", "material", "rays"])
        self.assertEqual(list(picture.channels), ["depth", "normal", "material", "rays"])
        there = np.zeros((40, 40), bool)
        there[10:30, 10:30] = True
        assert_array_equal(picture["material"] == 0, there)
        self.assertEqual(picture["material"].dtype, np.uint32)
        assert_allclose(picture["depth.Z"][there], 3, rtol=1e-6)
        assert_array_equal(picture["depth"][..., 0], picture["depth.Z"])
        self.assertTrue(np.all(np.isinf(picture["depth.Z"][~there])))
        assert_allclose(picture["normal"][there], np.tile([0, 1, 0], (400, 1)))
        self.assertTrue(np.all(picture["rays"] >= 1))
        for name in ("albedo", "depth.W", "nothing"):
            with self.assertRaises(KeyError):
                picture[name]
        with self.assertRaises(whit.Error):
            scene.render(channels=["dept"])

    def test_motion_counts_from_the_picture_before(self):
        """Parallel rays, 10 pixels a unit, of a square that moves by (0.5, 0, 1) and then, with the
        camera, by (-1, 0, 0) more: by what is left in the picture."""
        scene = whit.Scene(square_scene(cameras={"above": PARALLEL}), movable=["/scene/0"])

        def move(x):
            place = np.eye(4)
            place[:3, 3] = (x, 0, 1)
            scene.set_transform("/scene/0", place)

        def motion(**options):
            picture = scene.render(size=(40, 40), channels=["motion", "object"], **options)
            return picture["motion"][picture["object"] == 0]

        assert_allclose(motion(), np.zeros((400, 2)), atol=1e-5)
        move(0.5)
        assert_allclose(motion(), np.tile([5, 10], (400, 1)), atol=1e-5)
        move(-0.5)
        moved = whit.Camera({**PARALLEL, "eye": [-0.75, 3, 0], "at": [-0.75, 0, 0]}, (40, 40))
        assert_allclose(motion(camera=moved) - [-2.5, 0], 0, atol=1e-5)
        assert_allclose(motion(camera=moved), 0, atol=1e-5)

    def test_they_show_themselves(self):
        picture = render()
        self.assertEqual(picture._repr_png_()[:8], b"\x89PNG\r\n\x1a\n")
        with temporary_folder():
            picture.write("a.png")
            self.assertEqual(Path("a.png").read_bytes(), picture.png())

    def test_statistics(self):
        cost = render().statistics
        self.assertEqual(cost["rays"]["primary"], 48 * 30)
        self.assertGreater(cost["frame_ms"], 0)
        self.assertIn("generateRays", cost["stages_ms"])
        self.assertEqual((cost["non_finite_pixels"], cost["limited_pixels"]), (0, 0))
        # Glass branches at each surface, so a few rays a sample are too few for some pixels of it.
        limited = whit.Scene("glass").render(size=SIZE, max_rays=10).statistics["limited_pixels"]
        self.assertTrue(0 < limited < 48 * 30)


if __name__ == "__main__":
    unittest.main()
