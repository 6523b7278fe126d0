"""Scenes of arrays: the pictures of files that say the same, and errors for what is wrong."""

import copy
import pickle
import unittest

import numpy as np
from numpy.testing import assert_array_equal

import whit
from samples import SIZE, pixels, program, scene_of, square, square_scene, temporary_folder

SHAPE_SCENE = """{"whit": 1,
  "cameras": {"above": {"eye": [0, 3, 2], "at": [0, 0, 0], "fov": 50}},
  "lights": [{"position": [2, 4, 1], "intensity": 60}],
  "materials": {"red": {"diffuse": [0.8, 0.2, 0.1]}},
  "scene": [{"model": "square.obj", "materials": {"*": {"diffuse": [0.8, 0.2, 0.1]}}}]}"""
SQUARE_OBJ = "v -1 0 -1\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nf 1 2 3\nf 1 3 4\n"


class Arrays(unittest.TestCase):
    def test_the_picture_of_a_file(self):
        with temporary_folder():
            with open("square.obj", "w", encoding="utf-8") as file:
                file.write(SQUARE_OBJ)
            with open("scene.json", "w", encoding="utf-8") as file:
                file.write(SHAPE_SCENE)
            program("render", "scene.json", "--size", "48x30", "-o", "program.exr", "--quiet")
            picture = scene_of().render(size=SIZE)
            picture.write("module.exr")
            program("compare", "module.exr", "program.exr", "--tolerance", "0", "--quiet")
            self.assertGreater(picture.rgb.max(), 0.3)

    def test_any_kind_of_numbers(self):
        expected = pixels(scene_of())
        mesh = square()
        for floats in (np.float32, np.float64, np.float16, int, list):
            for indices in (np.uint32, np.int32, np.int64, np.uint8, list):
                positions = (mesh.positions.tolist() if floats is list
                             else mesh.positions.astype(floats))
                triangles = (mesh.triangles.tolist() if indices is list
                             else mesh.triangles.astype(indices))
                other = whit.Mesh(positions, triangles)
                rgb = pixels(scene_of(other))
                assert_array_equal(rgb, expected)
        strided = np.repeat(mesh.positions, 2, axis=0)[::2]
        self.assertFalse(strided.flags.c_contiguous)
        rgb = pixels(scene_of(whit.Mesh(strided, mesh.triangles)))
        assert_array_equal(rgb, expected)

    def test_arrays_are_read_where_they_are(self):
        positions, triangles = square().positions, square().triangles
        mesh = whit.Mesh(positions, triangles, normals=np.ones_like(positions))
        self.assertIs(mesh.positions, positions)
        self.assertIs(mesh.triangles, triangles)
        signed = triangles.astype(np.int32)
        self.assertTrue(np.shares_memory(whit.Mesh(positions, signed).triangles, signed))

    def test_triangles_one_after_the_other(self):
        mesh = square()
        soup = whit.Mesh(mesh.positions[mesh.triangles.ravel()])
        assert_array_equal(pixels(scene_of(soup)), pixels(scene_of(mesh)))

    def test_textures(self):
        codes = np.arange(4 * 6 * 3, dtype=np.uint8).reshape(4, 6, 3) * 3
        uvs = np.array([[0, 0], [0, 1], [1, 1], [1, 0]], np.float32)
        materials = {"red": {"diffuse": 1, "diffuseMap": "codes"}}
        linear = np.where(codes / 255 <= 0.04045, codes / 255 / 12.92,
                          ((codes / 255 + 0.055) / 1.055) ** 2.4)
        pictures = []
        for array in (codes, {"array": codes, "wrap": "repeat"}, linear, codes[:, :, :]):
            scene = square_scene(square(uvs=uvs), materials=materials, textures={"codes": array})
            pictures.append(pixels(whit.Scene(scene)))
        assert_array_equal(pictures[0], pictures[1])
        assert_array_equal(pictures[0], pictures[3])
        # Textures are kept in 10 bits of the square root, to which both are rounded.
        np.testing.assert_allclose(pictures[0], pictures[2], atol=2e-3)
        self.assertFalse(np.array_equal(pictures[0], scene_of().render(size=SIZE)))

    def test_one_mesh_in_two_places_is_kept_once(self):
        mesh = square()
        items = [{"mesh": mesh}, {"mesh": mesh, "transform": {"translate": [0, 1, 0]}}]
        scene = scene_of(scene=items)
        self.assertEqual(scene.triangles, 4)

    def test_what_is_moved(self):
        scene = whit.Scene(square_scene(), movable=["/scene/0", "/lights/0"])
        rest = pixels(scene)
        place = np.eye(4)
        place[:3, 3] = (0.25, 0.5, 0)
        scene.set_transform("/scene/0", place)
        moved = pixels(scene)
        self.assertFalse(np.array_equal(rest, moved))
        description = square_scene()
        description["scene"][0]["transform"] = {"matrix": place[:3].ravel()}
        # What can be moved is traced in its own space, with roundings of its own.
        placed = whit.Scene(description, movable=["/scene/0", "/lights/0"])
        assert_array_equal(moved, pixels(placed))
        scene.set_transform("/scene/0", np.eye(4)[:3])
        assert_array_equal(rest, pixels(scene))
        # The item's own transform is applied first.
        turn = np.array([[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        placed.set_transform("/scene/0", turn)
        description["scene"][0]["transform"] = {"matrix": (turn @ place)[:3].ravel()}
        assert_array_equal(pixels(placed), pixels(whit.Scene(description, movable=["/scene/0"])))

    def test_vertices_that_move(self):
        mesh = square(name="sheet")
        scene = scene_of(mesh)
        rest = pixels(scene)
        positions = mesh.positions + np.array([0, 0.5, 0.25], np.float32)
        expected = pixels(scene_of(square(positions=positions)))
        self.assertFalse(np.array_equal(expected, rest))

        moving = positions.astype(np.float64)
        scene.update_mesh("sheet", moving)
        moving[:] = 0  # the scene has a copy
        assert_array_equal(pixels(scene), expected)
        assert_array_equal(pixels(copy.copy(scene)), expected)
        self.assertAlmostEqual(float(scene.closest([0, 2, 0], [0, -1, 0]).t), 1.5)
        scene.update_mesh("sheet", mesh.positions)
        assert_array_equal(pixels(scene), rest)

        # Members that were set before stay.
        scene.set("/lights/0/intensity", 6)
        dim = pixels(scene)
        scene.update_mesh("sheet", positions)
        scene.update_mesh("sheet", mesh.positions)
        assert_array_equal(pixels(scene), dim)

    def test_other_arrays_of_a_mesh(self):
        normals = np.tile(np.array([0, 1, 0], np.float32), (4, 1))
        tilted = np.tile(np.array([0.6, 0.8, 0], np.float32), (4, 1))
        mesh = square(name="sheet", normals=normals)
        scene = scene_of(mesh)
        for given, expected in ((None, normals), (tilted, tilted), (None, tilted)):
            scene.update_mesh("sheet", mesh.positions, normals=given)
            other = scene_of(square(normals=expected))
            assert_array_equal(pixels(scene), pixels(other))

        half = square(triangles=[[0, 1, 2]])
        scene.update_mesh("sheet", half)
        self.assertEqual(scene.triangles, 1)
        assert_array_equal(pixels(scene), pixels(scene_of(half)))

    def test_vertices_that_cannot_move(self):
        mesh = square(name="sheet")
        scene = scene_of(mesh)
        rest = pixels(scene)
        nan = mesh.positions * np.nan
        cases = [
            ("name", "'sheet'", lambda: scene.update_mesh("shet", mesh.positions)),
            ("update_mesh", "a dict", lambda: whit.Scene("whitted").update_mesh("a", mesh.positions)),
            ("positions", "(4, 3)", lambda: scene.update_mesh("sheet", mesh.positions[:3])),
            ("positions", "(n, 3)", lambda: scene.update_mesh("sheet", None)),
            ("/scene/0/mesh", "finite", lambda: scene.update_mesh("sheet", nan)),
            ("/scene/0/mesh", "normals", lambda: scene.update_mesh("sheet", mesh.positions,
                                                                   normals=[[0, 1, 0]])),
        ]
        for place, expected, make in cases:
            with self.subTest(place=place, expected=expected):
                self.expect(place, expected, make)
        assert_array_equal(pixels(scene), rest)
        scene.set("/materials/red/diffuseMap", None)  # reads the scene again
        assert_array_equal(pixels(scene), rest)

        items = [{"mesh": mesh}, {"mesh": square(name="sheet")}]
        self.expect("/scene/1/mesh", "different names", lambda: scene_of(scene=items))

    def expect(self, place, expected, make, status=3):
        with self.assertRaises(whit.Error) as caught:
            make()
        error = caught.exception
        self.assertEqual(error.exit_status, status, str(error))
        self.assertEqual(error.place, place, str(error))
        self.assertIn(expected, error.expected or "", str(error))

    def test_arrays_that_are_no_mesh(self):
        nan = square().positions.copy()
        nan[2, 1] = np.nan
        huge = square().positions.astype(np.float64) * 1e300
        cases = [
            ("positions", "(n, 3)", lambda: whit.Mesh(None)),
            ("positions", "(n, 3)", lambda: whit.Mesh(np.zeros((4, 2), np.float32))),
            ("positions", "(n, 3)", lambda: whit.Mesh(np.zeros(12, np.float32))),
            ("positions", "(n, 3)", lambda: whit.Mesh(np.zeros((4, 3), complex))),
            ("positions", "(n, 3)", lambda: whit.Mesh(np.zeros((4, 3), bool))),
            ("positions", "(n, 3)", lambda: whit.Mesh("many")),
            ("positions", "(n, 3)", lambda: whit.Mesh([[1, 2, 3], [1, 2]])),
            ("positions", "(n, 3)", lambda: whit.Mesh([[object()] * 3])),
            ("triangles", "(n, 3)", lambda: square(triangles=[[0, 1]])),
            ("triangles", "(n, 3)", lambda: square(triangles=[[0.0, 1.0, 2.0]])),
            ("triangles", "numbers of vertices", lambda: square(triangles=[[0, 1, -2]])),
            ("triangles", "numbers of vertices", lambda: square(triangles=[[0, 1, 2**40]])),
            ("normals", "(n, 3)", lambda: square(normals=np.zeros((4, 4)))),
            ("uvs", "(n, 2)", lambda: square(uvs=np.zeros((4, 3)))),
        ]
        scenes = [
            ("vertices below 4", square(triangles=[[0, 1, 4]])),
            ("finite numbers in positions", square(positions=nan)),
            ("finite numbers in positions", square(positions=huge)),
            ("finite numbers in normals", square(normals=nan)),
            ("normals for 4 vertices", square(normals=np.ones((3, 3)))),
            ("uvs for 4 vertices", square(uvs=np.ones((5, 2)))),
            ("numbers from 0", square(colors=np.full((4, 3), 1.5))),
            ("a multiple of 3 vertices", whit.Mesh(square().positions)),
        ]
        for place, expected, make in cases:
            with self.subTest(expected=expected):
                self.expect(place, expected, make)
        for expected, mesh in scenes:
            with self.subTest(expected=expected):
                self.expect("/scene/0/mesh", expected, lambda: scene_of(mesh))

    def test_empty_meshes(self):
        for mesh in (whit.Mesh([]), whit.Mesh(np.empty((0, 3))),
                     whit.Mesh(np.empty((0, 3)), np.empty((0, 3), int))):
            rgb = pixels(scene_of(mesh))
            self.assertEqual(rgb.max(), 0)

    def test_arrays_that_are_no_texture(self):
        for array in (np.zeros((4, 4, 5), np.uint8), np.zeros((4, 4), np.int32),
                      np.zeros((0, 4), np.uint8), np.zeros(4, np.uint8),
                      np.zeros((2, 2, 2, 2), np.uint8), np.zeros((4, 4), np.uint16)):
            with self.subTest(shape=array.shape, dtype=array.dtype):
                with self.assertRaises(whit.Error):
                    scene_of(textures={"bad": array})
        for value in (np.nan, -1, np.inf):
            array = np.full((2, 2, 3), value, np.float32)
            self.expect("/textures/bad/array", "", lambda: scene_of(
                textures={"bad": array}, materials={"red": {"diffuseMap": "bad"}}))

    def test_descriptions_that_make_no_sense(self):
        loop = []
        loop.append(loop)
        cases = [
            ("/lights/0/intensity", {"lights": [{"position": [0, 1, 0], "intensity": np.nan}]}),
            ("/lights/0/intensity", {"lights": [{"position": [0, 1, 0], "intensity": -1}]}),
            ("/lights/0", {"lights": [{"intensity": 1}]}),
            ("/sky/image", {"sky": {"image": "/etc/passwd"}}),
            ("/materials/red/diffuse/2", {"materials": {"red": {"diffuse": [0, 0, 2]}}}),
            ("/cameras/a~1b", {"cameras": {"a/b": {"eye": [0, 0, 0], "at": [0, 0, 0]}}}),
            ("/scene/0/mesh", {"scene": [{"mesh": "nothing"}]}),
            ("/ambient/color", {"ambient": {"color": object()}}),
            ("/nonsense", {"nonsense": 1}),
            ("/lights", {"lights": {1: 2}}),
        ]
        for place, members in cases:
            with self.subTest(place=place):
                self.expect(place, "", lambda: scene_of(**members))
        with self.assertRaises(whit.Error) as caught:
            scene_of(path=loop)
        self.assertTrue(caught.exception.place.startswith("/path/0/0/0"))

    def test_huge_counts(self):
        self.expect(None, "", lambda: whit.Scene(square_scene(), max_memory_gb=1e-8), 5)
        self.expect(None, "", lambda: scene_of().render(size=(65536, 65536)), 5)
        repeat = {"count": [10000, 1000, 1], "step": [1, 1, 1]}
        description = square_scene()
        description["scene"][0]["repeat"] = dict(repeat, count=[10000, 10000, 1])
        self.expect("/scene/0/repeat/count", "10000000", lambda: whit.Scene(description))

    def test_matrices(self):
        scene = whit.Scene(square_scene(), movable=["/scene/0"])
        for matrix in (np.eye(3), np.zeros((4, 4)), "no", np.eye(4, dtype=complex), None):
            with self.subTest(matrix=matrix), self.assertRaises(whit.Error):
                scene.set_transform("/scene/0", matrix)
        for value in (np.nan, np.inf, 1e300):
            self.expect(None, "", lambda: scene.set_transform("/scene/0", np.full((3, 4), value)), 2)

    def test_errors_are_pickled(self):
        with self.assertRaises(whit.Error) as caught:
            whit.Scene({"size": [0, 1]}, name="mine")
        error = pickle.loads(pickle.dumps(caught.exception))
        self.assertEqual((error.file, error.place, error.exit_status), ("mine", "/size/0", 3))
        self.assertTrue(error.expected.startswith("a whole number from 1"), error.expected)


if __name__ == "__main__":
    unittest.main()
