"""Pickles and copies of scenes and pictures, and scenes in spawned processes."""

import copy
import os
import pickle
import unittest
from pathlib import Path

import numpy as np
from numpy.testing import assert_array_equal

import whit
from samples import (SIZE, assert_other, assert_same, error_of, expect_in_processes, pixels,
                     scene_of, square, square_scene, temporary_folder)

def restored(thing):
    return pickle.loads(pickle.dumps(thing))


def copies(thing):
    return restored(thing), copy.copy(thing), copy.deepcopy(thing)


class Pickles(unittest.TestCase):
    def assert_same(self, one, other):
        assert_same(one, other)
        self.assertEqual(one.name, other.name)

    def test_scenes(self):
        image = np.random.default_rng(3).integers(0, 256, (4, 4, 3)).astype(np.uint8)
        textured = square_scene(square(uvs=[[0, 0], [0, 1], [1, 1], [1, 0]]),
                                textures={"noise": image},
                                materials={"red": {"diffuseMap": "noise"}})
        for scene in (whit.Scene("whitted"), whit.Scene(square_scene(), name="mine"),
                      whit.Scene(textured, sky="studio"),
                      whit.Scene("whitted", settings={"/lights/0/intensity": 9})):
            for other in (*copies(scene), restored(restored(scene))):
                self.assert_same(scene, other)

    def test_changes_are_kept(self):
        scene = whit.Scene("orrery", moves=True, movable=["/scene/0"])
        before = pixels(scene).copy()
        for pointer, value in (("/lights/0/intensity", 5),
                               ("/lights/-", {"position": [0, 9, 0], "intensity": 30}),
                               ("/lights/0/intensity", 7), ("/lights/1/intensity", 31)):
            scene.set(pointer, value)
        scene.set_time(2.5)
        scene.set_transform("/scene/0", np.diag([1, 1.5, 1, 1]))
        assert_other(scene, before)
        for other in copies(scene):
            self.assert_same(scene, other)
            # What is changed in one of them is not changed in the other.
            other.set("/lights/0/intensity", 50)
            other.set_transform("/scene/0", np.diag([1, 0.5, 1, 1]))
            self.assert_same(scene, restored(scene))
            assert_other(scene, other)

    def test_a_file_is_found_from_another_folder(self):
        with temporary_folder():
            Path("a.json").write_text(
                '{"whit": 1, "cameras": {"a": {"eye": [0, 0, 5], "at": [0, 0, 0]}}, '
                '"scene": [{"shape": "sphere"}], "ambient": {"color": [1, 1, 1]}}')
            scene = whit.Scene("a.json")
            os.mkdir("b")
            os.chdir("b")
            self.assert_same(scene, restored(scene))

    def test_a_shipped_scene_is_found_beside_a_folder_of_its_name(self):
        with temporary_folder():
            os.mkdir("whitted")
            scene = whit.Scene("whitted")
            for other in copies(scene):
                self.assert_same(scene, other)

    def test_pictures(self):
        scene = whit.Scene("whitted")
        names = ["depth", "position", "normal", "albedo", "uv", "object", "material", "triangle",
                 "rays", "alpha", "error", "roughness", "metallic", "motion"]
        with temporary_folder():
            for options in ({}, {"channels": names}, {"crop": (5, 6, 40, 21), "channels": ["uv"]},
                            {"background": "transparent", "exposure": 1.5}):
                picture = scene.render(size=SIZE, **options)
                picture.write("a.exr")
                for other in copies(picture):
                    assert_array_equal(picture.rgb, other.rgb)
                    assert_array_equal(picture.srgb, other.srgb)
                    self.assertEqual(list(picture.channels), list(other.channels))
                    for name, values in picture.channels.items():
                        assert_array_equal(values, other[name], strict=True)
                    for name in ("width", "height", "left", "top", "statistics"):
                        self.assertEqual(getattr(picture, name), getattr(other, name))
                    self.assertEqual(picture.png(), other.png())
                    other.write("b.exr")
                    self.assertEqual(Path("a.exr").read_bytes(), Path("b.exr").read_bytes())

    def test_bytes_that_are_no_picture(self):
        make, (data, statistics) = whit.Scene("whitted").render(size=(4, 3)).__reduce__()
        version = whit.__version__.encode()
        for wrong in (b"", b"hello", data[:-9], data + b"x"):
            error_of(make, wrong, statistics)
        with self.assertRaisesRegex(ValueError, f"expected those of whit {whit.__version__}"):
            make(data.replace(version, b"9" * len(version)), statistics)

    def test_errors(self):
        for error in (whit.Error("a"), whit.Error("a", 4, "/no/such/file", "1:2", "all"),
                      whit.Error("a", 4, "/"), whit.Error("a", 5), whit.Error("a", 130),
                      error_of(whit.Scene, {"size": [0, 1]}, name="mine")):
            other = restored(error)
            self.assertEqual((type(other), str(other), vars(other)),
                             (type(error), str(error), vars(error)))

    def test_spawned_processes(self):
        scene = scene_of()
        scene.set("/lights/0/intensity", 20)
        expect_in_processes("spawn", scene, 1)


if __name__ == "__main__":
    unittest.main()
