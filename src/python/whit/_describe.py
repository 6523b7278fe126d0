"""Converts a scene's description from Python values to the JSON of scene files."""

from __future__ import annotations

import json
import math
import os
from typing import Any, Callable

import numpy as np

from . import _arrays
from ._camera import Camera
from ._error import Error

_DEEPEST = 64


def _escaped(token: str) -> str:
    return token.replace("~", "~0").replace("/", "~1")


class Description:
    """Makes the JSON text of a scene, and collects the arrays that the text names."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.meshes: dict[str, tuple] = {}
        self.images: dict[str, np.ndarray] = {}
        self._names: dict[int, str] = {}
        self._held: list[Any] = []  # keeps things alive, so that no id is used twice

    def text(self, value: Any, pointer: str = "") -> str:
        return json.dumps(self._plain(value, pointer, 0), allow_nan=False)

    def _fail(self, pointer: str, expected: str, found: str) -> None:
        raise Error(f"{self.name}#{pointer}: expected {expected}, found {found}", file=self.name,
                    place=pointer, expected=expected)

    def _named(self, thing: Any, kept: dict, make: Callable[[], Any], pointer: str) -> str:
        """The name under which `kept` has the thing; one that several items use is there once."""
        if id(thing) not in self._names:
            name = getattr(thing, "name", "") or f"array {len(self._held)}"
            if name in kept:
                self._fail(pointer, "meshes with different names", f"two that are called {name!r}")
            kept[name] = make()
            self._names[id(thing)] = name
            self._held.append(thing)
        return self._names[id(thing)]

    def _image(self, array: np.ndarray, pointer: str) -> str:
        return self._named(array, self.images,
                           lambda: _arrays.image(array, f"{self.name}#{pointer}"), pointer)

    def _plain(self, value: Any, pointer: str, depth: int) -> Any:
        if depth > _DEEPEST:
            self._fail(pointer, f"at most {_DEEPEST} levels", "more")
        if isinstance(value, _arrays.Mesh):
            return self._named(value, self.meshes, value._arrays, pointer)
        if isinstance(value, Camera):
            return self._plain(value.members, pointer, depth)
        if isinstance(value, np.ndarray):
            tokens = pointer.split("/")
            if tokens[1:2] == ["textures"] and len(tokens) == 3:
                return {"array": self._image(value, pointer)}
            if tokens[1:2] == ["textures"] and tokens[3:] == ["array"]:
                return self._image(value, pointer)
            return self._plain(value.tolist(), pointer, depth)
        if isinstance(value, np.generic):
            return self._plain(value.item(), pointer, depth)
        if isinstance(value, os.PathLike):
            return os.fspath(value)
        if value is None or isinstance(value, (bool, int, str)):
            return value
        if isinstance(value, float):
            if not math.isfinite(value):
                self._fail(pointer, "a finite number", str(value))
            return value
        if isinstance(value, dict):
            return self._members(value, pointer, depth)
        if isinstance(value, (list, tuple)):
            return [self._plain(v, f"{pointer}/{i}", depth + 1) for i, v in enumerate(value)]
        self._fail(pointer, "what JSON can say, an array or a whit.Mesh", type(value).__name__)

    def _members(self, value: dict, pointer: str, depth: int) -> dict:
        for key in value:
            if not isinstance(key, str):
                self._fail(pointer, "names as keys", repr(key))
        return {key: self._plain(member, f"{pointer}/{_escaped(key)}", depth + 1)
                for key, member in value.items()}
