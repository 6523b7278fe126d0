"""Converts arrays to what the extension takes: C-contiguous 32-bit floats, 32-bit indices or 8-bit
codes. Arrays that have this form already are not copied."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from ._error import Error

_NO_FLOATS = np.empty((0,), np.float32)
_NO_INDICES = np.empty((0,), np.uint32)


def _fail(what: str, expected: str, found: str) -> None:
    raise Error(f"{what}: expected {expected}, found {found}", place=what, expected=expected)


def _array(values: Any, what: str, kinds: str, expected: str) -> np.ndarray:
    try:
        array = np.asarray(values)
    except (ValueError, TypeError) as error:  # lists of lists of several lengths
        _fail(what, expected, str(error))
    if array.size == 0 and not isinstance(values, np.ndarray):
        array = array.astype(np.float32 if "f" in kinds else np.uint32)
    if array.dtype.kind not in kinds:
        _fail(what, expected, f"an array of {array.dtype}")
    return array


def _rows(values: Any, columns: int, what: str, kinds: str, noun: str) -> np.ndarray:
    expected = f"{noun} of shape (n, {columns})"
    array = _array(values, what, kinds, expected)
    if array.shape == (0,):
        array = array.reshape(0, columns)
    if array.ndim != 2 or array.shape[1] != columns:
        _fail(what, expected, f"an array of shape {array.shape}")
    return array


def floats(values: Any, columns: int, what: str) -> np.ndarray:
    """Converts to (n, columns), float32."""
    array = _rows(values, columns, what, "fiu", "numbers")
    with np.errstate(over="ignore"):  # numbers beyond float32 become infinite and are refused later
        return np.ascontiguousarray(array, np.float32)


def indices(values: Any, what: str) -> np.ndarray:
    """Converts to (n, 3), uint32."""
    array = _rows(values, 3, what, "iu", "whole numbers")
    if array.dtype == np.uint32 or array.size == 0:
        return np.ascontiguousarray(array, np.uint32)
    low, high = array.min(), array.max()
    if low < 0 or high > 0xFFFFFFFE:
        _fail(what, "numbers of vertices, from 0 on", str(low if low < 0 else high))
    if array.dtype == np.int32:
        return np.ascontiguousarray(array).view(np.uint32)
    return np.ascontiguousarray(array, np.uint32)


def image(values: Any, what: str) -> np.ndarray:
    """Converts to (height, width, channels), uint8 or float32."""
    expected = "an image of shape (height, width) or (height, width, 1 to 4), uint8 or float"
    array = _array(values, what, "fu", expected)
    if array.ndim == 2:
        array = array[:, :, None]
    if array.ndim != 3 or not 1 <= array.shape[2] <= 4 or 0 in array.shape:
        _fail(what, expected, f"an array of shape {np.shape(values)}")
    if array.dtype.kind == "u" and array.dtype != np.uint8:
        _fail(what, expected, f"an array of {array.dtype}")
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(array, np.uint8 if array.dtype == np.uint8 else np.float32)


def matrix(values: Any, what: str) -> list[float]:
    """The 12 numbers of three rows and four columns, row by row."""
    expected = "a matrix of shape (3, 4) or (4, 4)"
    array = _array(values, what, "fiu", expected)
    if array.shape not in ((3, 4), (4, 4)):
        _fail(what, expected, f"an array of shape {array.shape}")
    if array.shape == (4, 4) and not np.array_equal(array[3], (0, 0, 0, 1)):
        _fail(what, "a matrix whose last row is 0, 0, 0, 1", str(array[3].tolist()))
    return [float(x) for x in array[:3].ravel()]


def moved(arrays: tuple, positions: Any, normals: Optional[Any]) -> tuple:
    """The arrays of a mesh (Mesh._arrays()) with copies of other positions and normals."""
    changed = list(arrays)
    for at, what, values in ((0, "positions", positions), (2, "normals", normals)):
        if at == 0 or values is not None:
            changed[at] = floats(values, 3, what).copy()
    if changed[0].shape != arrays[0].shape:
        _fail("positions", f"an array of shape {arrays[0].shape}", f"shape {changed[0].shape}")
    return tuple(changed)


class Mesh:
    """Triangles in arrays. {"mesh": Mesh(...)} is an item of a scene described by a dict.

    positions: (n, 3), float32; x, y, z of each vertex.
    triangles: (m, 3), integers; the vertices of each triangle, counter-clockwise seen from outside.
        None: the vertices come in threes.
    normals: (n, 3) of unit length, or None: flat shading.
    uvs: (n, 2), v pointing up, or None.
    colors: (n, 3), linear, from 0 to 1, which multiply the material's; None: white.

    name: for Scene.update_mesh(); empty: a name is made up.

    C-contiguous arrays of float32, and of uint32 or int32, are used without a copy; others are
    converted. Do not change the arrays while a scene uses them: Scene.update_mesh() moves vertices.
    """

    def __init__(self, positions: Any, triangles: Optional[Any] = None, *,
                 normals: Optional[Any] = None, uvs: Optional[Any] = None,
                 colors: Optional[Any] = None, name: str = "") -> None:
        if positions is None:
            _fail("positions", "numbers of shape (n, 3)", "None")
        self.positions = floats(positions, 3, "positions")
        self.triangles = None if triangles is None else indices(triangles, "triangles")
        self.normals = None if normals is None else floats(normals, 3, "normals")
        self.uvs = None if uvs is None else floats(uvs, 2, "uvs")
        self.colors = None if colors is None else floats(colors, 3, "colors")
        self.name = name

    def __repr__(self) -> str:
        count = len(self.positions) // 3 if self.triangles is None else len(self.triangles)
        return f"<whit.Mesh: {len(self.positions)} vertices, {count} triangles>"

    def _arrays(self) -> tuple:
        # The extension reads these arrays in place, and a program may have put others into the mesh.
        mesh = Mesh(self.positions, self.triangles, normals=self.normals, uvs=self.uvs,
                    colors=self.colors)
        triangles = _NO_INDICES if mesh.triangles is None else mesh.triangles
        return (mesh.positions, triangles, *(_NO_FLOATS if array is None else array
                                             for array in (mesh.normals, mesh.uvs, mesh.colors)))
