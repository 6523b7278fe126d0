"""Scenes of arrays: the pictures of files that say the same, and errors for what is wrong."""

import copy
import json
import unittest
from pathlib import Path

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal

import whit
from samples import (SIZE, assert_other, assert_same, error_of, expect_picture, pixels, scene_of,
                     square, square_scene, temporary_folder)

SQUARE_OBJ = "v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3\nf 1 3 4\n"


def as_kind(array, kind):
    return array.tolist() if kind is list else array.astype(kind)


class Arrays(unittest.TestCase):
    def test_the_picture_of_a_file(self):
        with temporary_folder():
            Path("square.obj").write_text(SQUARE_OBJ)
            scene = square_scene(whit=1)
            scene["scene"] = [{"model": "square.obj", "materials": {"*": scene["materials"]["red"]}}]
            Path("scene.json").write_text(json.dumps(scene))
            picture = scene_of().render(size=SIZE)
            expect_picture(picture, "scene.json")
            self.assertGreater(picture.rgb.max(), 0.3)

    def test_any_kind_of_numbers(self):
        scene = scene_of()
        mesh = square()
        for floats in (np.float32, np.float64, np.float16, int, list):
            for indices in (np.uint32, np.int32, np.int64, np.uint8, list):
                other = whit.Mesh(as_kind(mesh.positions, floats), as_kind(mesh.triangles, indices))
                assert_same(scene_of(other), scene)
        strided = np.repeat(mesh.positions, 2, axis=0)[::2]
        self.assertFalse(strided.flags.c_contiguous)
        assert_same(scene_of(square(positions=strided)), scene)

    def test_arrays_are_read_where_they_are(self):
        positions, triangles = square().positions, square().triangles
        mesh = whit.Mesh(positions, triangles, normals=np.ones_like(positions))
        self.assertIs(mesh.positions, positions)
        self.assertIs(mesh.triangles, triangles)
        signed = triangles.astype(np.int32)
        self.assertTrue(np.shares_memory(whit.Mesh(positions, signed).triangles, signed))

    def test_arrays_that_a_program_puts_into_a_mesh(self):
        corners, triangles = square().positions, square().triangles
        for positions in (corners.astype(np.float64), corners.astype(np.float16), corners.tolist(),
                          np.repeat(corners, 2, axis=0)[::2]):
            mesh = square(positions=np.zeros((4, 3), np.float32))
            mesh.positions, mesh.triangles = positions, triangles.astype(np.int64)
            scene = scene_of(mesh)
            others = [np.full((4, 3), 7, np.float32) for _ in range(1000)]  # where it was freed
            assert_same(scene, scene_of())
            self.assertEqual(len(others), 1000)
        mesh.positions = np.zeros((4, 2))
        self.expect("positions", "(n, 3)", scene_of, mesh)

    def test_triangles_one_after_the_other(self):
        mesh = square()
        assert_same(scene_of(whit.Mesh(mesh.positions[mesh.triangles.ravel()])), scene_of(mesh))

    def test_textures(self):
        codes = np.arange(4 * 6 * 3, dtype=np.uint8).reshape(4, 6, 3) * 3
        shares = codes / 255
        linear = np.where(shares <= 0.04045, shares / 12.92, ((shares + 0.055) / 1.055) ** 2.4)

        def picture(texture):
            return pixels(scene_of(square(uvs=[[0, 0], [0, 1], [1, 1], [1, 0]]),
                                   materials={"red": {"diffuse": 1, "diffuseMap": "codes"}},
                                   textures={"codes": texture}))

        expected = picture(codes)
        assert_array_equal(picture({"array": codes, "wrap": "repeat"}), expected)
        # Textures are kept in 10 bits of the square root, to which both are rounded.
        assert_allclose(picture(linear), expected, atol=2e-3)
        assert_other(scene_of(), expected)

    def test_what_is_moved(self):
        place = np.eye(4)
        place[:3, 3] = (0.25, 0.5, 0)
        turn = np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])

        def placed(matrix):
            description = square_scene()
            description["scene"][0]["transform"] = {"matrix": matrix[:3].ravel()}
            # What can be moved is traced in its own space, with roundings of its own.
            return whit.Scene(description, movable=["/scene/0", "/lights/0"])

        scene = placed(np.eye(4))
        rest = pixels(scene)
        scene.set_transform("/scene/0", place)
        assert_other(rest, scene)
        there = placed(place)
        assert_same(scene, there)
        scene.set_transform("/scene/0", np.eye(4)[:3])
        assert_same(rest, scene)
        # The item's own transform is applied first.
        there.set_transform("/scene/0", turn)
        assert_same(there, placed(turn @ place))

    def test_vertices_that_move(self):
        mesh = square(name="sheet")
        scene = scene_of(mesh)
        rest = pixels(scene)
        positions = mesh.positions + np.array([0, 0.5, 0.25], np.float32)
        expected = pixels(scene_of(square(positions=positions)))
        assert_other(expected, rest)

        moving = positions.astype(np.float64)
        scene.update_mesh("sheet", moving)
        moving[:] = 0  # the scene has a copy
        for moved in (scene, copy.copy(scene)):
            assert_same(moved, expected)
        self.assertAlmostEqual(float(scene.closest([0, 2, 0], [0, -1, 0]).t), 1.5)
        scene.update_mesh("sheet", mesh.positions)
        assert_same(scene, rest)

    def test_other_arrays_of_a_mesh(self):
        normals, tilted = np.tile([[[0, 1, 0]], [[0.6, 0.8, 0]]], (1, 4, 1))
        mesh = square(name="sheet", normals=normals)
        scene = scene_of(mesh)
        for given, expected in ((None, normals), (tilted, tilted), (None, tilted)):
            scene.update_mesh("sheet", mesh.positions, normals=given)
            assert_same(scene, scene_of(square(normals=expected)))

        half = square(triangles=[[0, 1, 2]])
        scene.update_mesh("sheet", half)
        self.assertEqual(scene.triangles, 1)
        assert_same(scene, scene_of(half))

    def test_vertices_that_cannot_move(self):
        mesh = square(name="sheet")
        scene = scene_of(mesh)
        rest = pixels(scene)
        corners = mesh.positions
        for place, expected, arguments in (
                ("name", "'sheet'", ("shet", corners)),
                ("positions", "(4, 3)", ("sheet", corners[:3])),
                ("positions", "(n, 3)", ("sheet", None))):
            with self.subTest(place=place, expected=expected):
                self.expect(place, expected, scene.update_mesh, *arguments)
        self.expect("/scene/0/mesh", "normals", scene.update_mesh, "sheet", corners,
                    normals=[[0, 1, 0]])
        self.expect("update_mesh", "a dict", whit.Scene("whitted").update_mesh, "a", corners)
        assert_same(scene, rest)

        # One mesh in two places is kept once; another one may not have its name.
        self.assertEqual(scene_of(scene=2 * [{"mesh": mesh}]).triangles, 4)
        items = [{"mesh": mesh}, {"mesh": square(name="sheet")}]
        self.expect("/scene/1/mesh", "different names", scene_of, scene=items)

    def expect(self, place, expected, make, *arguments, status=3, **named):
        """Expects an error of that place and status which says what was expected."""
        error = error_of(make, *arguments, **named)
        self.assertEqual((error.exit_status, error.place), (status, place), str(error))
        self.assertIn(expected, error.expected or "", str(error))

    def test_arrays_are_given_when_the_scene_is_made(self):
        dots = np.full((2, 2, 3), 200, np.uint8)
        scene = scene_of(textures={"dots": dots}, materials={"red": {"diffuseMap": "dots"}})
        rest = pixels(scene)
        for pointer, value in (("/scene/0/mesh", square(positions=square().positions / 2)),
                               ("/scene/-", {"mesh": square()}), ("/textures/dots", dots // 2),
                               ("/textures/dots/array", dots // 2)):
            with self.subTest(pointer=pointer):
                error = error_of(scene.set, pointer, value)
                self.assertEqual((error.exit_status, error.place), (3, pointer))
                self.assertRegex(str(error), r"given when the scene is made.* update_mesh\(\)")
        assert_same(scene, rest)

        # Lists of numbers may be arrays.
        scene.set("/cameras/above/eye", np.array([0, 4, 2]))
        assert_other(scene, rest)

    def test_arrays_that_are_no_mesh(self):
        for positions in (None, np.zeros((4, 2), np.float32), np.zeros(12, np.float32),
                          np.zeros((4, 3), complex), np.zeros((4, 3), bool), "many",
                          [[1, 2, 3], [1, 2]], [[object()] * 3]):
            with self.subTest(positions=positions):
                self.expect("positions", "(n, 3)", whit.Mesh, positions)

        for expected, arrays in (
                ("(n, 3)", {"triangles": [[0, 1]]}),
                ("(n, 3)", {"triangles": [[0.0, 1.0, 2.0]]}),
                ("numbers of vertices", {"triangles": [[0, 1, -2]]}),
                ("numbers of vertices", {"triangles": [[0, 1, 2**40]]}),
                ("(n, 3)", {"normals": np.zeros((4, 4))}),
                ("(n, 2)", {"uvs": np.zeros((4, 3))})):
            with self.subTest(arrays=arrays):
                self.expect(*arrays, expected, square, **arrays)

        # SceneBuilder.WhatIsWrongHasItsPlace has all that may be wrong with a mesh.
        for expected, arrays in (
                ("finite numbers in positions", {"positions": square().positions * 1e300}),
                ("numbers from 0", {"colors": np.full((4, 3), 1.5)})):
            with self.subTest(arrays=arrays):
                self.expect("/scene/0/mesh", expected, scene_of, square(**arrays))

    def test_empty_meshes(self):
        none = np.empty((0, 3))
        for arrays in ([[]], [none], [none, np.empty((0, 3), int)]):
            self.assertEqual(pixels(scene_of(whit.Mesh(*arrays))).max(), 0)

    def test_arrays_that_are_no_texture(self):
        for array in (np.zeros((4, 4, 5), np.uint8), np.zeros((4, 4), np.int32),
                      np.zeros((0, 4), np.uint8), np.zeros(4, np.uint8),
                      np.zeros((2, 2, 2, 2), np.uint8), np.zeros((4, 4), np.uint16)):
            with self.subTest(shape=array.shape, dtype=array.dtype):
                error_of(scene_of, textures={"bad": array})
        for value in (np.nan, -1, np.inf):
            self.expect("/textures/bad/array", "", scene_of,
                        textures={"bad": np.full((2, 2, 3), value, np.float32)},
                        materials={"red": {"diffuseMap": "bad"}})

    def test_descriptions_that_make_no_sense(self):
        loop = []
        loop.append(loop)
        for place, members in (
                ("/lights/0/intensity", {"lights": [{"position": [0, 1, 0], "intensity": np.nan}]}),
                ("/lights/0", {"lights": [{"intensity": 1}]}),
                ("/sky/image", {"sky": {"image": "/etc/passwd"}}),
                ("/materials/red/diffuse/2", {"materials": {"red": {"diffuse": [0, 0, 2]}}}),
                ("/cameras/a~1b", {"cameras": {"a/b": {"eye": [0, 0, 0], "at": [0, 0, 0]}}}),
                ("/scene/0/mesh", {"scene": [{"mesh": "nothing"}]}),
                ("/ambient/color", {"ambient": {"color": object()}}),
                ("/lights", {"lights": {1: 2}})):
            with self.subTest(place=place):
                self.expect(place, "", scene_of, **members)
        self.assertTrue(error_of(scene_of, path=loop).place.startswith("/path/0/0/0"))

    def test_huge_counts(self):
        description = square_scene()
        self.expect(None, "", whit.Scene, description, max_memory_gb=1e-8, status=5)
        self.expect(None, "", scene_of().render, size=(65536, 65536), status=5)
        description["scene"][0]["repeat"] = {"count": [10000, 10000, 1], "step": [1, 1, 1]}
        self.expect("/scene/0/repeat/count", "10000000", whit.Scene, description)

    def test_matrices(self):
        scene = whit.Scene(square_scene(), movable=["/scene/0"])
        for matrix in (np.eye(3), np.zeros((4, 4)), "no", np.eye(4, dtype=complex), None):
            with self.subTest(matrix=matrix):
                error_of(scene.set_transform, "/scene/0", matrix)
        for value in (np.nan, np.inf, 1e300):
            self.expect(None, "", scene.set_transform, "/scene/0", np.full((3, 4), value), status=2)


if __name__ == "__main__":
    unittest.main()
