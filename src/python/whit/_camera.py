"""Cameras as calibrations and data sets describe them: a matrix K, a pose and the size of pictures."""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence

import numpy as np

from . import _arrays
from ._arrays import _fail

# Signs of the pose's columns: right, down and forward are x, y and z of OpenCV's cameras.
_AXES = {"opencv": (1, 1, 1), "opengl": (1, -1, -1)}


class Camera:
    """A camera, for the section "cameras" of a scene's dict or for Scene.render(camera=...).

    members: a camera of a scene file (share/doc/whit/scenes/README.md).
    size: width and height in pixels of the pictures that `k`, project() and unproject() are about.
    axes: those of `pose`: "opencv" (x right, y down, z forward) or "opengl" (x right, y up,
        z backward).

    Pixels are (x, y) from the top left, and the center of the first one is (0, 0), as in OpenCV.
    """

    def __init__(self, members: Mapping[str, Any], size: Sequence[int], *,
                 axes: str = "opencv") -> None:
        if axes not in _AXES:
            _fail("axes", '"opencv" or "opengl"', repr(axes))
        for name in ("eye", "at"):
            if name not in members:
                _fail("camera", f'a member "{name}"', str(list(members)))
        self.members = dict(members)
        self.size = (int(size[0]), int(size[1]))
        self.axes = axes

    @classmethod
    def from_k(cls, K: Any, pose: Any, size: Sequence[int], axes: str = "opencv", *,
               distortion: Sequence[float] = ()) -> Camera:
        """A pinhole camera with a matrix.

        K: (3, 3), [[fx, skew, cx], [0, fy, cy], [0, 0, 1]], in pixels.
        pose: (3, 4) or (4, 4), from the camera's `axes` to the scene: a rotation and a translation.
        size: width and height of the picture that K is for.
        distortion: coefficients in OpenCV's order: k1, k2, p1, p2, k3, k4, k5, k6.
        """
        k = _arrays._array(K, "K", "fiu", "a matrix of shape (3, 3)")
        if k.shape != (3, 3) or k[1, 0] != 0 or not np.array_equal(k[2], (0, 0, 1)):
            _fail("K", "[[fx, skew, cx], [0, fy, cy], [0, 0, 1]]", str(k.tolist()))
        place = np.reshape(_arrays.matrix(pose, "pose"), (3, 4))
        if not (k[0, 0] > 0 and k[1, 1] > 0):
            _fail("K", "focal lengths above 0", str(k.tolist()))
        turn = place[:, :3] * _AXES.get(axes, (1, 1, 1))  # cls() refuses unknown axes
        if not (np.allclose(turn.T @ turn, np.eye(3), atol=1e-5) and np.linalg.det(turn) > 0):
            _fail("pose", "a rotation and a translation", str(place.tolist()))
        eye = place[:, 3]
        # Far enough that rounding `at` to a float does not turn the camera.
        at = eye + turn[:, 2] * max(1.0, float(np.linalg.norm(eye)))
        members = {"eye": eye.tolist(), "at": at.tolist(), "up": (-turn[:, 1]).tolist(),
                   "k": [float(k[i]) for i in ((0, 0), (1, 1), (0, 2), (1, 2), (0, 1))],
                   "kSize": [int(size[0]), int(size[1])]}
        if len(distortion) > 0:
            members["distortion"] = [float(c) for c in distortion]
        return cls(members, size, axes=axes)

    @property
    def pose(self) -> np.ndarray:
        """(4, 4), from the camera's `axes` to the scene."""
        eye, at, up = (np.asarray(self.members.get(name, preset), float)
                       for name, preset in (("eye", 0), ("at", 0), ("up", (0, 1, 0))))
        forward = (at - eye) / np.linalg.norm(at - eye)
        right = np.cross(forward, up)
        right /= np.linalg.norm(right)
        pose = np.eye(4)
        pose[:3, :3] = np.stack([right, np.cross(forward, right), forward], 1) * _AXES[self.axes]
        pose[:3, 3] = eye
        return pose

    @property
    def k(self) -> np.ndarray:
        """(3, 3), the matrix K for pictures of `size`; only perspective cameras have one."""
        projection = self.members.get("projection", "perspective")
        if projection != "perspective" or self.members.get("orthographicHeight", 0) > 0:
            _fail("k", "a perspective camera", "another projection")
        if self.members.get("stereo", "none") != "none":
            _fail("k", "the camera of one eye", f"a stereo pair, {self.members['stereo']}")
        width, height = self.size
        k = np.eye(3)
        if self.members.get("k"):
            fx, fy, cx, cy, skew = (*self.members["k"], 0.0)[:5]
            x, y = width / self.members["kSize"][0], height / self.members["kSize"][1]
            k[0] = fx * x, skew * x, (cx + 0.5) * x - 0.5
            k[1, 1:] = fy * y, (cy + 0.5) * y - 0.5
        else:
            # Pictures that are narrower than `aspect` keep the width, and show more above and below.
            slope = np.tan(np.radians(self.members.get("fov", 45)) / 2)
            slope *= max(1.0, self.members.get("aspect", 0) * height / width)
            k[0, 0] = k[1, 1] = height / 2 / slope
            k[:2, 2] = (width - 1) / 2, (height - 1) / 2
        return k

    @property
    def fov(self) -> float:
        """Vertical field of view in degrees, of a lens without distortion."""
        above = (self.k[1, 2] + 0.5) / self.k[1, 1]
        below = self.size[1] / self.k[1, 1] - above
        return float(np.degrees(np.arctan(above) + np.arctan(below)))

    def project(self, points: Any) -> np.ndarray:
        """Pixels (..., 2) where points (..., 3) of the scene are seen; NaN where a point is not in
        front of the camera."""
        turn = self.pose[:3, :3] * _AXES[self.axes]
        with np.errstate(invalid="ignore"):  # points at infinity, where rays hit nothing
            x, y, z = np.moveaxis((np.asarray(points, float) - self.pose[:3, 3]) @ turn, -1, 0)
        z = np.where(z > 0, z, np.nan)
        x, y = x / z, y / z
        k1, k2, p1, p2, k3, k4, k5, k6 = (*self.members.get("distortion", ()), *[0.0] * 8)[:8]
        r = x * x + y * y
        radial = (1 + r * (k1 + r * (k2 + r * k3))) / (1 + r * (k4 + r * (k5 + r * k6)))
        bent = np.stack([x * radial + 2 * p1 * x * y + p2 * (r + 2 * x * x),
                         y * radial + p1 * (r + 2 * y * y) + 2 * p2 * x * y], -1)
        return bent @ self.k[:2, :2].T + self.k[:2, 2]

    def unproject(self, depth: Any, pixels: Optional[Any] = None) -> np.ndarray:
        """Points (..., 3) of the scene at these depths along the camera's axis: Picture["depth.Z"],
        not "depth.distance". Lenses with distortion have the channel "position" instead.

        depth: (height, width), or of the shape of `pixels` without its last axis.
        pixels: (..., 2), or None: all pixels of a picture.
        """
        if any(self.members.get("distortion", ())):
            _fail("unproject", 'a lens without distortion (the channel "position" has points)',
                  "coefficients of distortion")
        depth = np.asarray(depth, float)
        if pixels is None:
            if depth.shape != self.size[::-1]:
                _fail("depth", f"an array of shape {self.size[::-1]}", f"shape {depth.shape}")
            pixels = np.stack(np.meshgrid(*(np.arange(n) for n in self.size)), -1)
        k = self.k
        x, y = np.moveaxis(np.asarray(pixels, float) - k[:2, 2], -1, 0)
        y = y / k[1, 1]
        rays = np.stack([(x - k[0, 1] * y) / k[0, 0], y, np.ones_like(y)], -1)
        turn = self.pose[:3, :3] * _AXES[self.axes]
        with np.errstate(invalid="ignore"):  # infinite depths
            return (rays * depth[..., None]) @ turn.T + self.pose[:3, 3]

    def __repr__(self) -> str:
        return f"<whit.Camera: {self.size[0]} x {self.size[1]}, {self.members}>"
