"""The same bits as the program's, whatever happens around a picture."""

import threading
import unittest

import numpy as np
from numpy.testing import assert_array_equal

import whit
from samples import SIZE, pixels, program, scene_of, temporary_folder

CASES = [
    ("whitted", {}, {}, []),
    ("whitted", {}, {"spp": 4, "adaptive": True, "camera": "above", "depth": 5},
     ["--spp", "4", "--adaptive", "on", "--camera", "above", "--depth", "5"]),
    ("whitted", {"settings": {"/lights/0/intensity": 40.5, "/materials/floor/diffuse": [1, 0, 0.25]}},
     {"eye": (1, 2.5, 5), "fov": 40.25, "crop": (8, 4, 30, 20)},
     ["--set", "/lights/0/intensity=40.5", "--set", "/materials/floor/diffuse=[1,0,0.25]",
      "--eye", "1,2.5,5", "--fov", "40.25", "--crop", "8,4,30,20"]),
    ("glossy", {}, {"glossy": 2, "light_samples": 3, "tonemap": "filmic"},
     ["--glossy", "2", "--light-samples", "3", "--tonemap", "filmic"]),
    ("matte", {}, {"mode": "reference", "threads": 1}, ["--mode", "reference", "--threads", "1"]),
    ("landscape?triangles=2000", {}, {"texture_filter": "trilinear"},
     ["--texture-filter", "trilinear"]),
]


def by_program(name, words):
    program("render", name, "-o", "program.exr", "--size", "48x30", "--quiet", *words)
    program("render", name, "-o", "program.png", "--size", "48x30", "--quiet", *words)


class Bits(unittest.TestCase):
    def test_pictures_are_those_of_the_program(self):
        with temporary_folder():
            for name, load, options, words in CASES:
                with self.subTest(name=name, **options):
                    by_program(name, words)
                    picture = whit.Scene(name, **load).render(size=SIZE, **options)
                    picture.write("module.exr")
                    picture.write("module.png")
                    for kind in ("exr", "png"):
                        program("compare", f"module.{kind}", f"program.{kind}", "--tolerance", "0",
                                "--quiet")

    def test_they_are_told_from_others(self):
        with temporary_folder():
            by_program("whitted", ["--depth", "1"])
            whit.Scene("whitted").render(size=SIZE).write("module.exr")
            with self.assertRaises(AssertionError):
                program("compare", "module.exr", "program.exr", "--tolerance", "0", "--quiet")

    def test_time_is_that_of_the_program(self):
        with temporary_folder():
            by_program("orrery", ["--time", "2.5"])
            scene = whit.Scene("orrery", moves=True)
            scene.set_time(6)
            scene.render(size=SIZE)
            scene.set_time(2.5)
            scene.render(size=SIZE).write("module.exr")
            program("compare", "module.exr", "program.exr", "--tolerance", "0", "--quiet")

    def test_what_is_set_between_pictures(self):
        scene = whit.Scene("whitted")
        scene.render(size=SIZE)
        for pointer, value in {"/lights/0/intensity": 40, "/cameras/main/eye": np.array([1, 2, 5.5]),
                               "/scene/1/radius": np.float64(0.5)}.items():
            scene.set(pointer, value)
            fresh = whit.Scene("whitted", settings={pointer: value})
            fresh.render(size=SIZE)
        settings = {"/lights/0/intensity": 40, "/cameras/main/eye": [1, 2, 5.5],
                    "/scene/1/radius": 0.5}
        expected = whit.Scene("whitted", settings=settings).render(size=SIZE)
        assert_array_equal(pixels(scene), expected.rgb)

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
        self.assertFalse(np.array_equal(before, scene.render(size=SIZE, depth=0).rgb))
        with self.assertRaises(whit.Error):
            scene.render(size=SIZE, depth=0, spp=-1)
        assert_array_equal(before, pixels(scene))

    def test_pictures_outlive_their_scene_and_those_that_follow(self):
        scene = whit.Scene("whitted")
        picture = scene.render(size=SIZE)
        kept, rgb = picture.rgb.copy(), picture.rgb
        scene.render(size=SIZE, depth=0)
        del scene, picture
        assert_array_equal(kept, rgb)

    def test_four_threads_render_four_scenes_at_once(self):
        names = ["whitted", "glossy", "matte", "orrery"]
        expected = {name: whit.Scene(name).render(size=SIZE, spp=2).rgb for name in names}
        wrong = []

        def work(name):
            scene = whit.Scene(name)
            for _ in range(12):
                if not np.array_equal(scene.render(size=SIZE, spp=2).rgb, expected[name]):
                    wrong.append(name)

        threads = [threading.Thread(target=work, args=(name,)) for name in names]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])

    def test_threads_take_turns_at_one_scene(self):
        scene = scene_of()
        expected = {depth: scene.render(size=SIZE, eye=(depth, 3, 2)).rgb for depth in range(4)}
        wrong = []

        def work(depth):
            for _ in range(25):
                picture = scene.render(size=SIZE, eye=(depth, 3, 2))
                if not np.array_equal(picture.rgb, expected[depth]):
                    wrong.append(depth)

        threads = [threading.Thread(target=work, args=(depth,)) for depth in expected]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    unittest.main()
