"""The same bits as the program's, whatever happens around a picture."""

import gc
import unittest
from pathlib import Path

import numpy as np
from numpy.testing import assert_array_equal

import whit
from samples import (SIZE, assert_other, assert_same, error_of, expect_picture, in_threads, pixels,
                     scene_of, temporary_folder)
from whit import _options

CASES = [
    ("whitted", {}, {}),
    ("whitted", {}, {"spp": 4, "adaptive": True, "camera": "above", "depth": 5}),
    ("whitted", {"/lights/0/intensity": 40.5, "/materials/floor/diffuse": [1, 0, 0.25]},
     {"eye": (1, 2.5, 5), "fov": 40.25, "crop": (8, 4, 30, 20)}),
    ("glossy", {}, {"glossy": 2, "light_samples": 3, "tonemap": "filmic"}),
    ("matte", {}, {"mode": "reference", "threads": 1}),
    ("landscape?triangles=2000", {}, {"texture_filter": "trilinear"}),
]


def words_of(settings, options):
    """The same on the command line."""
    words = [f"--set={pointer}={value}" for pointer, value in settings.items()]
    for keyword, value in options.items():
        words += ["--" + keyword.replace("_", "-"), _options.OPTIONS[keyword].text(value)]
    return words


class Bits(unittest.TestCase):
    def test_pictures_are_those_of_the_program(self):
        with temporary_folder():
            for name, settings, options in CASES:
                with self.subTest(name=name, **options):
                    picture = whit.Scene(name, settings=settings).render(size=SIZE, **options)
                    expect_picture(picture, name, *words_of(settings, options))

    def test_the_camera_of_a_model_fits_the_size_of_its_scene(self):
        size = ("--size", "30x48")
        with temporary_folder():
            Path("wide.obj").write_text("v -2 0 0\nv 2 0 0\nv 2 1 0\nf 1 2 3\n")
            scene = whit.Scene({"view": "model", "size": [30, 48], "scene": [{"model": "wide.obj"}]})
            expect_picture(scene.render(), "wide.obj", *size)
            camera = {"eye": (1, 2, 5), "at": (0, 0, 0)}
            picture = whit.Scene("wide.obj").render(size=(30, 48), **camera)
            expect_picture(picture, "wide.obj", *size, *words_of({}, camera))

    def test_they_are_told_from_others(self):
        with temporary_folder(), self.assertRaisesRegex(AssertionError, "^whit compare"):
            expect_picture(whit.Scene("whitted").render(size=SIZE), "whitted", "--depth", "1")

    def test_time_is_that_of_the_program(self):
        with temporary_folder():
            scene = whit.Scene("orrery", moves=True)
            scene.set_time(6)
            scene.render(size=SIZE)
            scene.set_time(2.5)
            expect_picture(scene.render(size=SIZE), "orrery", "--time", "2.5")

    def test_what_is_set_between_pictures(self):
        scene = whit.Scene("whitted")
        scene.render(size=SIZE)
        for pointer, value in {"/lights/0/intensity": 40, "/cameras/main/eye": np.array([1, 2, 5.5]),
                               "/scene/1/radius": np.float64(0.5)}.items():
            scene.set(pointer, value)
            whit.Scene("whitted", settings={pointer: value}).render(size=SIZE)
        assert_same(scene, whit.Scene("whitted", settings={
            "/lights/0/intensity": 40, "/cameras/main/eye": [1, 2, 5.5], "/scene/1/radius": 0.5}))

    def test_a_budget_chooses_options_that_make_the_same_picture(self):
        scene = whit.Scene("whitted")
        for within in ({"budget": "100ms"}, {"target": "flip=0.1"}):
            picture = scene.render(size=SIZE, depth=3, **within)
            receipt = picture.receipt
            self.assertNotIn("depth", receipt["chosen"])
            self.assertIn("chosen --spp", receipt["text"])
            self.assertLessEqual(receipt["error_low"], receipt["error_high"])
            options = {name.replace("-", "_"): value for name, value in receipt["chosen"].items()}
            same = scene.render(size=SIZE, depth=3, **options)
            assert_array_equal(picture.rgb, same.rgb)
            self.assertIsNone(same.receipt)
        with self.assertRaisesRegex(whit.Error, "expected a time"):
            scene.render(size=SIZE, budget="soon")

    def test_options_hold_for_one_picture(self):
        scene = whit.Scene("whitted")
        before = pixels(scene)
        assert_other(before, scene.render(size=SIZE, depth=0).rgb)
        error_of(scene.render, size=SIZE, depth=0, spp=-1)
        assert_same(before, scene)

    def test_pictures_outlive_their_scene_and_those_that_follow(self):
        scene = whit.Scene("whitted")
        picture = scene.render(size=SIZE)
        kept, rgb, lent = picture.rgb.copy(), picture.rgb, np.from_dlpack(picture.rgb)
        scene.render(size=SIZE, depth=0)
        del scene, picture
        gc.collect()
        for array in (rgb, lent):
            assert_array_equal(kept, array)

    def test_four_threads_render_four_scenes_at_once(self):
        def work(name):
            scene = whit.Scene(name)
            return [scene.render(size=SIZE, spp=2).rgb for _ in range(12)]

        names = ["whitted", "glossy", "matte", "orrery"]
        for name, found in zip(names, in_threads(work, names)):
            expected = whit.Scene(name).render(size=SIZE, spp=2).rgb
            for rgb in found:
                assert_array_equal(rgb, expected)

    def test_threads_take_turns_at_one_scene(self):
        scene = scene_of()

        def work(depth):
            return [scene.render(size=SIZE, eye=(depth, 3, 2)).rgb for _ in range(25)]

        for depth, found in enumerate(in_threads(work, range(4))):
            for rgb in found:
                assert_array_equal(rgb, scene.render(size=SIZE, eye=(depth, 3, 2)).rgb)


if __name__ == "__main__":
    unittest.main()
