"""What rays hit, in arrays: the results of Scene.closest() and Scene.all_hits()."""

from __future__ import annotations

import dataclasses
from typing import Any, Optional, Union

import numpy as np

from ._arrays import _array, _fail


@dataclasses.dataclass(repr=False)
class Hits:
    """What rays hit. Arrays of closest() have the shape of the rays, (...) or (..., 2 or 3); those
    of all_hits() have one row a hit, and the hits of ray i are rows offsets[i] to offsets[i + 1].

    Where nothing is hit t is infinite, triangle, object and material are 0xffffffff, all else 0.
    One thing is beyond `certain`: a border of a surface that is seen at less than a sixteenth of its
    area may be passed where the ray meets it within the rounding of single precision.
    """

    t: np.ndarray  # float64: the distance, in lengths of the ray's direction
    t_error: np.ndarray  # float64: bound on the error of t
    point: np.ndarray  # (..., 3), float64, in the world
    geometric_normal: np.ndarray  # (..., 3), float32, unit, on the front
    shading_normal: np.ndarray  # (..., 3), float32: interpolated between the vertices' normals
    weights: np.ndarray  # (..., 2), float32: u and v, of corners 1 and 2 of the triangle
    uv: np.ndarray  # (..., 2), float32: texture coordinates
    triangle: np.ndarray  # uint32: number among the triangles of its object
    object: np.ndarray  # uint32: index into Scene.objects
    material: np.ndarray  # uint32: index into Scene.materials
    instance: np.ndarray  # uint32: number of the instance, 0xffffffff for what is used once
    side: np.ndarray  # int8: 1 front (corners counter-clockwise), -1 back, 0 nothing
    certain: np.ndarray  # bool: False where rounding leaves open which surface is hit, or if any
    offsets: Optional[np.ndarray] = None  # uint64, of all_hits() alone: one more than rays

    @property
    def hit(self) -> np.ndarray:
        """bool: whether anything is hit."""
        return self.side != 0

    def __repr__(self) -> str:
        return f"<whit.Hits: {np.count_nonzero(self.hit)} of shape {self.t.shape}>"


def _floats(values: Any, what: str) -> np.ndarray:
    array = _array(values, what, "fiu", "numbers")
    return np.ascontiguousarray(array, np.float32 if array.dtype == np.float32 else np.float64)


def points(values: Any, what: str) -> np.ndarray:
    """Converts to (..., 3), float32 or float64, without a copy where they have this form."""
    array = _floats(values, what)
    if array.ndim == 0 or array.shape[-1] != 3:
        _fail(what, "numbers of shape (..., 3)", f"an array of shape {array.shape}")
    return array


def alike(needed: dict[str, Any], optional: dict[str, Optional[Any]]) -> list[np.ndarray]:
    """Converts to points of one shape; where an optional one is None to an empty array."""
    named = {**needed, **{what: values for what, values in optional.items() if values is not None}}
    arrays = {what: points(values, what) for what, values in named.items()}
    try:
        shape = np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        _fail(" and ".join(arrays), "shapes that go together",
              " and ".join(str(array.shape) for array in arrays.values()))
    return [np.ascontiguousarray(np.broadcast_to(arrays[what], shape)) if what in arrays
            else np.empty(0, np.float32) for what in {**needed, **optional}]


def limits(value: Union[float, Any], what: str, shape: tuple[int, ...]) -> np.ndarray:
    """Converts to one number for all rays, or one for each."""
    array = _floats(value, what)
    if array.size == 1:
        return array.reshape(1)
    if array.shape != shape:
        _fail(what, f"a number or an array of shape {shape}", f"an array of shape {array.shape}")
    return array


def hits(columns: dict[str, np.ndarray], shape: tuple[int, ...]) -> Hits:
    """Gives the columns of a query their shapes."""
    components = {"point": (3,), "geometric_normal": (3,), "shading_normal": (3,),
                  "weights": (2,), "uv": (2,)}
    found = {name: column.reshape(shape + components.get(name, ()))
             for name, column in columns.items() if name != "offsets"}
    found["offsets"] = columns.get("offsets")
    found["certain"] = found["certain"].view(np.bool_)
    return Hits(**found)
