"""Whitted ray tracing on CPUs: scenes from files or numpy arrays, pictures as numpy arrays.

    import whit
    scene = whit.Scene("helmet.glb")
    picture = scene.render(size=(640, 480), spp=4)
    picture.rgb            # (480, 640, 3), float32, linear radiance, top row first
    picture.write("helmet.png")

Everything that goes wrong with a scene, an option or a file is a whit.Error.
"""

from __future__ import annotations

import os
from typing import Any, Callable, Mapping, Optional, Sequence, Union

import numpy as np

from . import _arrays, _options, _whit
from ._arrays import Mesh
from ._describe import Description
from ._error import Error

__all__ = ["Error", "Mesh", "Picture", "Scene"]
__version__ = _whit.version()

Progress = Callable[[str, float], Optional[bool]]


def _shipped_scenes() -> str:
    """Where the scenes are that came with the module: beside it, or in share/whit of its prefix."""
    here = os.path.dirname(os.path.abspath(__file__))
    beside = os.path.join(here, "scenes")
    if os.path.isdir(beside):
        return beside
    return os.path.join(here, *[os.pardir] * 4, "share", "whit", "scenes")


class Picture:
    """A rendered picture, or a crop of one. Its arrays are views of one memory, not to be written
    to: copy() them for that."""

    def __init__(self, picture: Any) -> None:
        self._picture = picture

    @property
    def rgb(self) -> np.ndarray:
        """Linear radiance, Rec. 709 primaries: (height, width, 3), float32, top row first."""
        return self._picture.rgb

    @property
    def srgb(self) -> np.ndarray:
        """After exposure and tone curve: (height, width, 3), uint8 sRGB codes, top row first."""
        return self._picture.rgba[:, :, :3]

    @property
    def channels(self) -> dict[str, np.ndarray]:
        """What was kept beside it (render(channels=...)), by name: (height, width) or (height,
        width, components), float32 or, of what is counted or numbered, uint32.

        What each is, its unit and its value where nothing is met, says share/doc/whit/scenes/
        README.md. "object" and "material" are numbers in Scene.objects and Scene.materials.
        """
        return {name: self[name] for name in self._picture.channels}

    def __getitem__(self, name: str) -> np.ndarray:
        """A channel, "position" (height, width, 3), or a component of one as files name it,
        "depth.Z" (height, width)."""
        channel, _, component = name.partition(".")
        kept = self._picture.channels
        if channel not in kept:
            raise KeyError(f"{name}: the picture has {', '.join(kept) or 'no channels'}")
        components, values = kept[channel]
        if component and component not in components:
            raise KeyError(f"{name}: the channel has {', '.join(components)}")
        if component or len(components) == 1:
            return values[:, :, components.index(component) if component else 0]
        return values

    @property
    def width(self) -> int:
        """In pixels; of a crop its own."""
        return self._picture.rgb.shape[1]

    @property
    def height(self) -> int:
        """In pixels; of a crop its own."""
        return self._picture.rgb.shape[0]

    @property
    def left(self) -> int:
        """Where the first column lies in the whole picture."""
        return self._picture.left

    @property
    def top(self) -> int:
        """Where the first row lies in the whole picture."""
        return self._picture.top

    @property
    def statistics(self) -> dict[str, Any]:
        """What the frame cost: "frame_ms", "embree_ms" and "stages_ms" (by stage) in milliseconds
        of wall-clock time, "rays" (by kind) and "non_finite_pixels" as numbers."""
        return self._picture.statistics

    def write(self, path: Union[str, os.PathLike]) -> None:
        """Writes .exr (linear, float) or .png (8-bit sRGB) with the options that make it again."""
        self._picture.write(os.fspath(path))

    def png(self) -> bytes:
        """The bytes of a PNG."""
        return self._picture.png()

    def _repr_png_(self) -> bytes:
        return self.png()

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        array = self.rgb if dtype is None else self.rgb.astype(dtype)
        return array.copy() if copy else array

    def __repr__(self) -> str:
        return f"<whit.Picture: {self.width} x {self.height}>"


class Scene:
    """A scene that is ready to be rendered: a scene file or model, a shipped scene, or a
    description in Python's own values.

    source: the path of a scene file (.json) or model (.gltf, .glb, .obj, .ply), the name of a
        shipped scene ("atrium", "landscape?triangles=20000000"), or a dict of what a scene file
        says (share/doc/whit/scenes/README.md). In a dict an item {"mesh": whit.Mesh(...)} is one of
        arrays, and a texture may be an array (height, width, 1 to 4 channels) of uint8 codes or
        linear floats, or {"array": array, "wrap": "clamp"}. One Mesh in several items is kept once.
        Lengths, positions and transforms are in the scene's own units, y up.
    settings: members of the description by their JSON pointers, as set() takes them.
    sky: in place of the scene's own: "none", "studio" or the file of an image.
    moves: it will be brought to other times (set_time).
    movable: JSON pointers to what set_transform() will move: items, cameras and lights of scene
        files and dicts ("/scene/3", "/cameras/front", "/lights/0"), nodes of models ("/nodes/7").
    animation: which of a model's animations moves it, by name; empty: the first.
    sphere_segments: triangles in place of exact spheres, so many around each; 0: none.
    strict: what would be repaired (`warnings`) is an error.
    allow_outside: a scene may name files outside its own folder and $WHIT_DATA.
    max_memory_gb: 10^9 bytes that geometry and images may take.
    threads: 0: what affinity and cgroup quota allow.
    progress: called now and then with what is going on and how far it is, 0 to 1; False ends it.
    name: of a dict, in errors.

    Threads may use one scene; they take turns. Several scenes render at the same time.
    """

    def __init__(self, source: Union[str, os.PathLike, Mapping[str, Any]], *,
                 settings: Optional[Mapping[str, Any]] = None, sky: Union[str, os.PathLike] = "",
                 moves: bool = False, movable: Sequence[str] = (), animation: str = "",
                 sphere_segments: int = 0, strict: bool = False, allow_outside: bool = False,
                 max_memory_gb: float = 16.0, threads: int = 0,
                 progress: Optional[Progress] = None, name: str = "scene") -> None:
        description = Description(name)
        texts = [f"{pointer}={description.text(value, pointer)}"
                 for pointer, value in (settings or {}).items()]
        load = dict(settings=texts, sky=os.fspath(sky), moves=moves, movable=list(movable),
                    animation=animation, sphere_segments=sphere_segments, strict=strict,
                    allow_outside=allow_outside, max_memory_gb=max_memory_gb, threads=threads)
        if isinstance(source, Mapping):
            text = description.text(dict(source))
            self._session = _whit.build(name, text, description.meshes, description.images, load,
                                        progress)
        else:
            self._session = _whit.load(os.fspath(source), load, _shipped_scenes(), progress)

    @property
    def name(self) -> str:
        """Of its file, without folder and extension."""
        return self._session.name

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of its pictures in pixels, where no size is given."""
        return self._session.width, self._session.height

    @property
    def cameras(self) -> list[str]:
        """Their names; the first is seen from where no camera is given."""
        return self._session.cameras

    @property
    def objects(self) -> list[str]:
        """Names by the numbers in the channel "object", of the first 65,536."""
        return self._session.objects

    @property
    def materials(self) -> list[str]:
        """Names by the numbers in the channel "material"."""
        return self._session.materials

    @property
    def triangles(self) -> int:
        """As seen, instances multiplied out."""
        return self._session.triangles

    @property
    def animations(self) -> dict[str, float]:
        """Those to choose from, and how many seconds each lasts."""
        return self._session.animations

    @property
    def path_seconds(self) -> float:
        """When its camera path ends; 0 without a path."""
        return self._session.path_seconds

    @property
    def warnings(self) -> list[str]:
        """What was repaired while it was read."""
        return self._session.warnings

    def set(self, pointer: str, value: Any, *, progress: Optional[Progress] = None) -> None:
        """Sets a member of the scene's description, for pictures to come:
        set("/lights/0/intensity", 40). The picture is that of a scene which was read so.

        pointer: a JSON pointer (RFC 6901) to it; "-" stands for a new element of a list.
        value: as in the description.

        Nothing is built anew for lights, colors of the sky, ambient light, numbers of a scene
        file's or dict's own materials, and cameras where nothing is instanced; for all else the
        scene is read again. After an error the scene is what it was.
        """
        self._session.set_member(pointer, Description(self.name).text(value, pointer), progress)

    def set_time(self, seconds: float) -> None:
        """Brings a scene that was made with moves=True to a time in seconds: what moves, its
        cameras and lights."""
        self._session.set_time(seconds)

    def set_transform(self, pointer: str, matrix: Any) -> None:
        """Moves what is among `movable`, in place of its own motion.

        matrix: (3, 4) or (4, 4), the last column the translation, in the scene's units.
        """
        self._session.set_transform(pointer, _arrays.matrix(matrix, "matrix"))

    def render(self, *, path_time: Optional[float] = None, progress: Optional[Progress] = None,
               **options: Any) -> Picture:
        self._session  # noqa: B018 (the attribute is there only if __init__ came to its end)
        texts = _options.texts(options)
        return Picture(self._session.render(texts, path_time, progress))

    def __repr__(self) -> str:
        return f"<whit.Scene {self.name!r}: {self.triangles} triangles>"


Scene.render.__doc__ = f"""A picture, by the bits that `whit render` makes with the same options.

        path_time: seen from the scene's camera path, so many seconds after its begin.
        progress: called now and then with what is going on and how far it is, 0 to 1; False ends
            it with an Error of exit status 130. It is called by the thread that renders.

        The options of the command line, for this picture alone; angles are in degrees, lengths in
        the scene's units, and what they are where they are not given is in brackets:

{_options.documentation()}
        """
