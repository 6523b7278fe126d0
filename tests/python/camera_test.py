"""Cameras with a matrix K: poses, pixels, depths and points, against pictures."""

import unittest
from pathlib import Path

import numpy as np
from numpy.testing import assert_allclose, assert_array_equal

import whit
from samples import assert_other, error_of, scene_of, temporary_folder

SIZE = (64, 48)
K = np.array([[70.0, 3, 30.5], [0, 66, 21.25], [0, 0, 1]])


def pose(axes="opencv"):
    """Camera to scene: 4 units in front of the origin, turned a little about all axes."""
    a, b = 0.2, -0.15
    turn = (np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
            @ np.array([[1, 0, 0], [0, np.cos(b), -np.sin(b)], [0, np.sin(b), np.cos(b)]]))
    matrix = np.eye(4)
    matrix[:3, :3] = turn @ np.diag([1, -1, -1]) if axes == "opencv" else turn
    matrix[:3, 3] = turn @ (0.3, -0.2, 4)
    return matrix


CAMERA = whit.Camera.from_k(K, pose(), SIZE)
FRONT = {"eye": [0, 0, 5], "at": [0, 0, 0]}
PIXELS = np.stack(np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1])), -1)


def positions_of_wall(camera):
    """What a camera without distortion sees of a wall in the plane z = 0: the positions of its
    channel, to which its depths lead as well."""
    wall = whit.Scene({"scene": [{"shape": "quad", "width": 40, "depth": 40,
                                  "transform": {"rotate": [1, 0, 0, 90]}}]})
    picture = wall.render(camera=camera, channels=["depth", "position"])
    if "distortion" not in camera.members:
        assert_allclose(camera.unproject(picture["depth.Z"]), picture["position"], atol=2e-5)
    return picture["position"]


class Cameras(unittest.TestCase):
    def test_the_pose_comes_back_in_both_axes(self):
        for axes in ("opencv", "opengl"):
            camera = whit.Camera.from_k(K, pose(axes), SIZE, axes)
            assert_allclose(camera.pose, pose(axes), atol=1e-6)
            assert_array_equal(camera.k, K)
        assert_allclose(camera.members["at"], CAMERA.members["at"], atol=1e-12)

    def test_pixels_are_those_of_opencv(self):
        points = np.random.default_rng(1).uniform(-1, 1, (5, 7, 3))
        place = pose()
        seen = (points - place[:3, 3]) @ place[:3, :3] @ K.T
        assert_allclose(CAMERA.project(points), seen[..., :2] / seen[..., 2:], atol=1e-4)
        self.assertTrue(np.isnan(CAMERA.project(place[:3, 3] - place[:3, 2])).all())

    def test_points_come_back_from_pixels_and_depths(self):
        points = np.random.default_rng(2).uniform(-1, 1, (6, 3))
        depths = (points - CAMERA.pose[:3, 3]) @ CAMERA.pose[:3, 2]
        assert_allclose(CAMERA.unproject(depths, CAMERA.project(points)), points, atol=1e-12)

    def test_pictures_of_other_sizes_scale_the_matrix(self):
        camera = whit.Camera(CAMERA.members, (2 * SIZE[0], 3 * SIZE[1]))
        # From corner to corner of a pixel, as centers do not scale.
        assert_allclose(camera.k, np.array([[2, 0, 0.5], [0, 3, 1], [0, 0, 1]]) @ K, atol=1e-12)
        positions_of_wall(camera)

    def test_far_models_are_seen_in_coordinates_of_their_file(self):
        far = np.array([4000000.1, 0, 500000.2])
        with temporary_folder():
            corners = far + [(-20, 0, -20), (-20, 0, 20), (20, 0, 20), (20, 0, -20)]
            Path("far.obj").write_text(
                "".join("v {} {} {}\n".format(*corner) for corner in corners) + "f 1 2 3 4\n")
            scene = whit.Scene("far.obj")
        down = np.column_stack([[[1, 0, 0], [0, 0, -1], [0, 1, 0]], far + (0, 4, 0)])
        for camera in (scene.camera(), whit.Camera.from_k(K, down, SIZE)):
            picture = scene.render(camera=camera, size=SIZE, channels=["depth", "position"])
            points = whit.Camera(camera.members, SIZE).unproject(picture["depth.Z"])
            hit = np.isfinite(picture["depth.Z"])
            self.assertTrue(hit.sum() > 100)
            # Coordinates of the channel are in single precision.
            assert_allclose(points[hit], picture["position"][hit], atol=0.3)
            assert_allclose(points[hit][:, 1], 0, atol=1e-3)
            eye = camera.pose[:3, 3]
            ways = points[hit] - eye
            found = scene.closest(np.broadcast_to(eye, ways.shape), ways)
            assert_allclose(found.point, points[hit], atol=1e-3)

    def test_distortion_moves_what_is_projected(self):
        camera = whit.Camera.from_k(K, pose(), SIZE, distortion=[-0.2, 0.05, 0.01, -0.02, 0.01])
        assert_allclose(camera.project(positions_of_wall(camera)), PIXELS, atol=2e-3)
        self.assertIn("position", str(error_of(camera.unproject, np.ones(SIZE[::-1]))))

    def test_a_description_takes_a_camera_and_gives_it_back(self):
        cameras = {"a": CAMERA, "b": {**FRONT, "fov": 30}}
        scene = whit.Scene({"size": SIZE, "cameras": cameras, "scene": []})
        for camera in (scene.camera(), scene.camera("a")):
            assert_array_equal(camera.k, K)
            assert_allclose(camera.pose, CAMERA.pose, atol=1e-6)
        back = scene.camera("b", axes="opengl")
        self.assertAlmostEqual(back.fov, 30)
        wanted = np.eye(4)
        wanted[2, 3] = 5
        assert_allclose(back.pose, wanted, atol=1e-12)
        assert_allclose(back.k[1, 1], 24 / np.tan(np.radians(15)))
        assert_array_equal(back.k[:2, 2], [31.5, 23.5])
        self.assertAlmostEqual(CAMERA.fov, np.degrees(np.arctan(21.75 / 66) + np.arctan(26.25 / 66)))
        self.assertIn("'c'", str(error_of(scene.camera, "c")))

    def test_pictures_narrower_than_the_aspect_keep_the_width(self):
        camera = whit.Camera({**FRONT, "fov": 40, "aspect": 1.6}, (50, 40))
        across = 1.6 * np.tan(np.radians(20))  # half the width at distance 1
        assert_allclose(camera.k[0, 0], 25 / across)
        self.assertAlmostEqual(camera.fov, 2 * np.degrees(np.arctan(across * 40 / 50)))
        positions_of_wall(camera)

    def test_a_moving_camera_is_told_where_it_is(self):
        camera = {**FRONT, "motion": {"keys": [{"time": 0}, {"time": 1, "translate": [1, 2, 0]}]}}
        scene = whit.Scene({"cameras": {"a": camera}, "scene": []}, moves=True)
        for time in (0.25, 1, 0.5, 0):
            scene.set_time(time)
            assert_allclose(scene.camera().pose[:3, 3], [time, 2 * time, 5], atol=1e-6)

    def test_stereo_pairs_have_no_matrix(self):
        pair = whit.Camera({**FRONT, "stereo": "leftRight"}, (80, 40))
        self.assertRegex(str(error_of(pair.project, [0, 0, 0])), "one eye.*leftRight")

    def test_a_camera_holds_for_one_picture(self):
        scene = scene_of()

        def picture(**options):
            return scene.render(size=SIZE, **options).rgb

        before = picture()
        assert_array_equal(picture(camera=scene.camera()), before)
        unsized = scene.render(camera=CAMERA, size=None)
        self.assertEqual((unsized.width, unsized.height), CAMERA.size)
        assert_other(picture(camera=CAMERA), before)
        assert_array_equal(picture(), before)

    def test_what_is_no_camera(self):
        for what, k, place, axes in (("K", np.eye(2), pose(), "opencv"),
                                     ("K", np.ones((3, 3)), pose(), "opencv"),
                                     ("K", K + [[0, 0, 0], [1, 0, 0], [0, 0, 0]], pose(), "opencv"),
                                     ("K", K * [[-1], [1], [1]], pose(), "opencv"),
                                     ("pose", K, 2 * np.eye(3, 4), "opencv"),
                                     ("pose", K, np.diag([1, 1, -1, 1]), "opencv"),
                                     ("axes", K, pose(), "opencl")):
            error = error_of(whit.Camera.from_k, k, place, SIZE, axes)
            self.assertRegex(str(error), f"^{what}: expected")
        panorama = whit.Camera({**FRONT, "projection": "panorama"}, SIZE)
        scene = scene_of()
        self.assertEqual(scene.render(camera=panorama).width, SIZE[0])
        error = error_of(panorama.project, [0, 0, 0])
        self.assertRegex(str(error), "^k: expected a perspective camera")
        panorama.members["aperture"] = 0.1
        self.assertIn("camera#/aperture", str(error_of(scene.render, camera=panorama)))


if __name__ == "__main__":
    unittest.main()
