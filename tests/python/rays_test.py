"""Queries of rays from arrays: shapes, kinds of numbers, and what is refused. What they find is
tested in tests/example/rays_test.cpp."""

import unittest

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal

import whit
from samples import error_of, in_threads, scene_of

SCENE = scene_of()
DOWN = np.array([0.0, -1.0, 0.0])


def grid(rows, columns):
    """Points above the square, which lies in y = 0 from -1 to 1."""
    x, z = np.meshgrid(np.linspace(-1.5, 1.5, columns), np.linspace(-1.4, 1.4, rows))
    return np.stack([x, np.full_like(x, 2.0), z], -1)


class Rays(unittest.TestCase):
    def test_shapes_and_values(self):
        points = grid(4, 5)
        hits = SCENE.closest(points, DOWN)
        inside = (abs(points[..., 0]) < 1) & (abs(points[..., 2]) < 1)
        assert_array_equal(hits.hit, inside)
        assert_array_equal(hits.t, np.where(inside, 2.0, np.inf))
        assert_allclose(hits.point[inside], points[inside] * (1, 0, 1), atol=1e-15)
        self.assertEqual(hits.geometric_normal.shape, (4, 5, 3))
        assert_array_equal(hits.geometric_normal[inside] * hits.side[inside, None],
                           np.tile([0, 1, 0], (inside.sum(), 1)))
        assert_array_equal(hits.object, np.where(inside, 0, 0xffffffff))
        assert_array_equal(SCENE.occluded(points, DOWN), inside)
        everything = SCENE.all_hits(points, DOWN)
        assert_array_equal(np.diff(everything.offsets.astype(int)), inside.ravel())
        self.assertEqual(everything.point.shape, (inside.sum(), 3))

    def test_one_ray(self):
        """Its answers are single numbers; arrays of any leading shape give arrays of that shape."""
        hits = SCENE.closest([0.25, 2, 0], [0, -1, 0])
        self.assertEqual((hits.t.shape, hits.point.shape, hits.uv.shape), ((), (3,), (2,)))
        self.assertEqual((hits.t, hits.side, hits.hit), (2, 1, True))
        assert_allclose(hits.point, [0.25, 0, 0], atol=1e-15)
        self.assertEqual(repr(hits), "<whit.Hits: 1 of shape ()>")
        self.assertFalse(SCENE.closest([3, 2, 0], DOWN).hit)

        everything = SCENE.all_hits([0.25, 2, 0], DOWN)
        self.assertEqual((everything.t.tolist(), everything.offsets.tolist()), ([2], [0, 1]))
        for x, expected in (0.25, True), (3, False):
            occluded = SCENE.occluded([x, 2, 0], DOWN)
            self.assertEqual((occluded.shape, bool(occluded)), ((), expected))
            seen, certain = SCENE.visible([x, 2, 0], [x, -1, 0], return_certain=True)
            self.assertEqual((seen.shape, bool(seen), bool(certain)), ((), not expected, True))
        open_ = SCENE.ambient_occlusion([0, 0, 0], [0, 1, 0], 10, 16)
        self.assertEqual((open_.shape, open_), ((), 1))

        for shape in (1,), (2, 1), (3, 0, 2), (1, 2, 1, 2):
            points = np.zeros((*shape, 3)) + [0.25, 2, 0]
            hits = SCENE.closest(points, DOWN)
            self.assertEqual((hits.t.shape, hits.point.shape), (shape, (*shape, 3)))
            self.assertEqual(SCENE.occluded(points, DOWN).shape, shape)

    def test_any_kind_of_numbers(self):
        points = grid(3, 3).astype(np.float32)
        expected = SCENE.closest(points, DOWN).t
        for same, tolerance in ((points.tolist(), 0), (points.astype(float), 0),
                                (points.astype(np.float16), 1e-2)):
            assert_allclose(SCENE.closest(same, DOWN).t, expected, tolerance)
        strided = np.asfortranarray(points)[::-1]
        assert_array_equal(SCENE.closest(strided, DOWN).t, expected[::-1])

    def test_limits(self):
        points = grid(3, 3)
        self.assertFalse(SCENE.occluded(points, DOWN, t_far=1.9).any())
        # Only the middle one of these rays meets the square.
        far = np.full((3, 3), 2.5)
        self.assertTrue(SCENE.occluded(points, DOWN, t_far=far)[1, 1])
        far[1, 1] = 1
        self.assertFalse(SCENE.occluded(points, DOWN, t_far=far).any())

    def test_between_surfaces(self):
        points = np.array([[0.5, 0, 0], [0, 0, 0.5]])
        self.assertTrue(SCENE.visible(points, [0, 3, 0]).all())
        seen, certain = SCENE.visible(points + DOWN, [0, 3, 0], return_certain=True)
        assert_array_equal(seen, [False, False])
        self.assertEqual(certain.shape, (2,))
        assert_array_equal(SCENE.ambient_occlusion(points, -DOWN, 10, 16), [1, 1])

    def test_nothing_to_ask(self):
        hits = SCENE.closest(np.empty((0, 3)), np.empty((0, 3)))
        self.assertEqual(hits.point.shape, (0, 3))
        self.assertEqual(SCENE.all_hits(grid(1, 1) + 9, DOWN).t.shape, (0,))

    def test_what_is_refused(self):
        three, six = np.zeros(3), np.zeros((2, 3))
        closest = SCENE.closest
        for words, ask in (
                ("origins", lambda: closest(np.zeros((2, 2)), DOWN)),
                ("origins", lambda: closest("here", DOWN)),
                ("directions", lambda: closest(six, np.zeros((3, 3)))),
                ("directions", lambda: closest(three, None)),
                ("t_far", lambda: closest(six, DOWN, t_far=three)),
                ("limit: expected None or at least 0",
                 lambda: SCENE.all_hits(three, DOWN, limit=-1)),
                ("radius", lambda: SCENE.ambient_occlusion(three, DOWN, -1))):
            with self.subTest(words=words), self.assertRaisesRegex(ValueError, words):
                ask()

    def test_progress_can_end_it(self):
        points = np.zeros((300000, 3)) + [0, 1, 0]
        error = error_of(SCENE.closest, points, DOWN, progress=lambda *_: False)
        self.assertEqual(error.exit_status, 130)
        self.assertTrue(SCENE.occluded([0, 1, 0], DOWN))

    def test_threads_ask_in_turn(self):
        points = grid(40, 40)
        expected = SCENE.closest(points, DOWN).t
        for hits in in_threads(SCENE.closest, [points] * 4, [DOWN] * 4):
            assert_array_equal(hits.t, expected)


if __name__ == "__main__":
    unittest.main()
