"""Whitted ray tracing on CPUs: scenes from files or numpy arrays, pictures as numpy arrays.

    import whit
    scene = whit.Scene("scenes/chess.glb")
    picture = scene.render(size=(640, 480), spp=4)
    picture.rgb            # (480, 640, 3), float32, linear radiance, top row first
    picture.write("chess.png")

Errors in a scene, an option or a file raise whit.Error.
"""

from __future__ import annotations

import json
import operator
import os
import warnings
import weakref
from typing import Any, Callable, Iterator, KeysView, Mapping, Optional, Sequence, Union

import numpy as np

from . import _arrays, _options, _rays, _whit
from ._arrays import Mesh
from ._camera import Camera
from ._describe import Description
from ._error import Error, in_python
from ._rays import Hits

__all__ = ["Camera", "Error", "Hits", "Mesh", "Picture", "Scene", "View"]
__version__ = _whit.version()

Progress = Callable[[str, float], Optional[bool]]


def __dir__() -> list[str]:
    return [*__all__, "__version__"]


def _native(name: str, doc: str) -> Any:
    """A property that the extension's object has."""
    return property(operator.attrgetter(f"_object.{name}"), doc=doc)


def _shipped_scenes() -> str:
    """The folder of the shipped scenes: beside the module, or in share/whit of its prefix, which
    may be any folder above. Empty where there is none."""
    folder = os.path.dirname(os.path.abspath(__file__))
    scenes = os.path.join(folder, "scenes")
    while not os.path.isdir(scenes):
        if folder == os.path.dirname(folder):
            return ""
        folder = os.path.dirname(folder)
        scenes = os.path.join(folder, "share", "whit", "scenes")
    return scenes


class Picture:
    """A rendered picture, or a crop of one. Its arrays are C-contiguous, except `srgb`; torch and
    others take them by DLPack or the buffer protocol without a copy. They are views of the
    picture's memory, and what is written to them gets into files: `rgb` and `channels` into .exr
    files, a channel also into files of its own, and `rgba` into .png and .jpg files and png().
    Changes of `rgb` do not reach `rgba`, nor the other way round.

    Pickles keep all of a picture, for the same version of whit.
    """

    def __init__(self, picture: Any, statistics: Optional[dict[str, Any]] = None) -> None:
        self._object = picture
        self._statistics = picture.statistics if statistics is None else statistics
        self._components: dict[str, np.ndarray] = {}

    def __reduce__(self) -> tuple:
        return _picture, (self._object.bytes(), self._statistics)

    rgb: np.ndarray = _native("rgb", (
        "Linear radiance, Rec. 709 primaries: (height, width, 3), float32, top row first."))

    rgba: np.ndarray = _native("rgba", (
        "sRGB codes after exposure and tone curve, and alpha: (height, width, 4), uint8, top row "
        "first. Alpha is 255 unless background='transparent'."))

    @property
    def srgb(self) -> np.ndarray:
        """The colors of `rgba`: (height, width, 3), uint8 sRGB codes."""
        return self.rgba[:, :, :3]

    @property
    def channels(self) -> dict[str, np.ndarray]:
        """The extra channels (render(channels=...)) by name: (height, width) or (height, width,
        components), float32, or uint32 for counts and numbers of things.

        share/doc/whit/scenes/README.md has the meaning and unit of each channel, and its value
        where the ray hits nothing. "object" and "material" are indices into Scene.objects and
        Scene.materials.
        """
        return {name: self[name] for name in self._object.channels}

    def __getitem__(self, name: str) -> np.ndarray:
        """A channel, "position" (height, width, 3), or one component by its name in files,
        "depth.Z" (height, width), which is a copy where the channel has several: what is written to
        it is in no file."""
        channel, _, component = name.partition(".")
        kept = self._object.channels
        if channel not in kept:
            raise KeyError(f"{name}: the picture has {', '.join(kept) or 'no channels'}")
        components, values = kept[channel]
        if component and component not in components:
            raise KeyError(f"{name}: the channel has {', '.join(components)}")
        if len(components) == 1:
            return values[:, :, 0]
        if not component:
            return values
        if name not in self._components:
            one = values[:, :, components.index(component)]
            self._components[name] = np.ascontiguousarray(one)
        return self._components[name]

    def __contains__(self, name: object) -> bool:
        try:
            return self[str(name)] is not None
        except KeyError:
            return False

    def __iter__(self) -> Iterator[str]:
        return iter(self.keys())

    def __len__(self) -> int:
        return len(self.keys())

    def __bool__(self) -> bool:
        return True

    def keys(self) -> KeysView[str]:
        return self._object.channels.keys()

    width: int = _native("width", "Width in pixels, of a crop its own width.")
    height: int = _native("height", "Height in pixels, of a crop its own height.")
    left: int = _native("left", "Column of the left edge in the whole picture.")
    top: int = _native("top", "Row of the top edge in the whole picture.")
    statistics: dict[str, Any] = property(operator.attrgetter("_statistics"), doc=(
        "Times and counts of the frame: 'frame_ms', 'embree_ms' and 'stages_ms' (by stage) in "
        "milliseconds of wall-clock time, 'rays' (by kind), 'non_finite_pixels' and "
        "'limited_pixels' (whose rays max_rays has bounded) as numbers."))

    @property
    def receipt(self) -> Optional[dict[str, Any]]:
        """What render(budget=...) has chosen: 'chosen' (options), 'choose_ms', 'expected_ms' and
        'picture_ms', 'error' with 'error_low' and 'error_high' (infinite where the error is not
        known), 'note' and 'text'."""
        return self._statistics.get("receipt")

    def write(self, path: Union[str, os.PathLike]) -> None:
        """Writes .exr (linear, float), .png or .jpg (8-bit sRGB), with the render's options except
        in .jpg. "x.depth.exr" and "x.depth.png" hold that channel alone."""
        self._object.write(os.fspath(path))

    def png(self) -> bytes:
        """The bytes of a PNG."""
        return self._object.png()

    def _repr_png_(self) -> bytes:
        return self.png()

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        array = self.rgb if dtype is None else self.rgb.astype(dtype)
        return array.copy() if copy else array

    def __repr__(self) -> str:
        return f"<whit.Picture: {self.width} x {self.height}>"


def _picture(data: bytes, statistics: dict[str, Any]) -> Picture:
    """A picture from its pickle."""
    return Picture(_whit.picture(data), statistics)


class View:
    """The viewer of a scene in a browser (Scene.view()), served by this process until close(), the
    end of the object or that of the process.

    Notebooks show the page in a frame, and its picture where they cannot show a page.
    """

    url: str = _native("url", "Address of the page, for a browser on the same machine.")

    def __init__(self, view: Any, width: Union[int, str], height: int) -> None:
        self._object = view
        self._end = weakref.finalize(self, view.close)
        self._frame = (f'<iframe src="{self.url}" width="{width}" height="{height}" frameborder="0"'
                       ' allow="clipboard-write; fullscreen"></iframe>')

    def close(self) -> None:
        """Ends the server; the page stays with its last picture."""
        self._end()

    def png(self) -> bytes:
        """The bytes of a PNG of what the page shows, at full resolution."""
        return self._object.png()

    def _repr_html_(self) -> Optional[str]:
        return self._frame if self._end.alive else None

    def _repr_png_(self) -> Optional[bytes]:
        return self.png() if self._end.alive else None

    def __repr__(self) -> str:
        return f"<whit.View: {self.url if self._end.alive else 'closed'}>"


class Scene:
    """A scene that is ready to be rendered: a scene file or model, a shipped scene, or a
    description in Python's own values.

    source: the path of a scene file (.json) or model (.gltf, .glb, .vrm, .obj, .ply; .stl, .fbx,
        .dae, .3ds and .off where the module was built with assimp), the name of a shipped scene
        ("atrium", "landscape?triangles=20000000", "chess.glb"), or a dict with the content of a
        scene file (share/doc/whit/scenes/README.md). An item of the dict may be
        {"mesh": whit.Mesh(...)}, and a texture an array (height, width, 1 to 4 channels) of uint8
        codes or linear floats, or {"array": array, "wrap": "clamp"}. A Mesh that several items use
        is stored once. Lengths, positions and transforms are in the scene's own units, y up.
    settings: values by their JSON pointers, as in set(), and {"/variant": "red"} of a glTF file.
    sky: replaces the scene's sky: "none", "studio" or an image file.
    moves: loads animations, so that set_time() works.
    movable: JSON pointers to the things that set_transform() will move: items, cameras and lights
        of scene files and dicts ("/scene/3", "/cameras/front", "/lights/0"), nodes of models
        ("/nodes/7").
    animation: name of the model's animation that is played; empty: the first.
    sphere_segments: triangles around each sphere in place of exact spheres; 0: exact spheres.
    strict: raises an error instead of a repair (`warnings`).
    allow_outside: a scene may name files outside its own folder and $WHIT_DATA.
    max_memory_gb: memory limit for geometry and images in 10^9 bytes; 0: what the machine and its
        control group have left, at most 16.
    threads: number of worker threads; 0: as many as CPU affinity and cgroup quota allow.
    progress: called now and then with the current phase and the fraction done, 0 to 1; returning
        False ends the work.
    name: name of a dict's scene in errors.

    Threads may use one scene; they take turns. Several scenes render at the same time. Forked child
    processes may use the scenes that no thread was using.

    Pickles and copies keep the arguments, with the arrays of a dict and the path of a file, and
    what set(), update_mesh(), set_time() and set_transform() have changed. They read the scene
    again.

    warnings.warn() tells of repairs and of scenes without light, which `warnings` lists.
    """

    def __init__(self, source: Union[str, os.PathLike, Mapping[str, Any]], *,
                 settings: Optional[Mapping[str, Any]] = None, sky: Union[str, os.PathLike] = "",
                 moves: bool = False, movable: Sequence[str] = (), animation: str = "",
                 sphere_segments: int = 0, strict: bool = False, allow_outside: bool = False,
                 max_memory_gb: float = 0.0, threads: int = 0,
                 progress: Optional[Progress] = None, name: str = "scene") -> None:
        if not max_memory_gb >= 0:
            _arrays._fail("max_memory_gb", "a number from 0", str(max_memory_gb))
        if threads < 0:
            _arrays._fail("threads", "a whole number from 0", str(threads))
        if isinstance(movable, str):
            _arrays._fail("movable", "a list of JSON pointers", f"one text, {movable!r}")
        description = Description(name)
        texts = [f"{pointer}={description.text(value, pointer)}"
                 for pointer, value in (settings or {}).items()]
        load = dict(settings=texts, sky=os.fspath(sky), moves=moves, movable=list(movable),
                    animation=animation, sphere_segments=sphere_segments, strict=strict,
                    allow_outside=allow_outside, max_memory_gb=max_memory_gb, threads=threads)
        self._load = load
        self._time: Optional[float] = None
        self._transforms: dict[str, list[float]] = {}
        if isinstance(source, Mapping):
            text = description.text(dict(source))
            self._source = (name, text, description.meshes, description.images)
        else:
            self._source = (os.fspath(source),)
        self._read(progress)
        if len(self._source) == 1 and os.path.exists(source):
            # Copies may be read elsewhere. A plain word is a shipped scene, even where a file or
            # folder has its name.
            if os.path.dirname(source) or os.path.splitext(source)[1]:
                self._source = (os.path.abspath(source),)
        for text in self.warnings:
            warnings.warn(text, stacklevel=2)

    def _read(self, progress: Optional[Progress]) -> None:
        if len(self._source) > 1:
            self._object = _whit.build(*self._source, self._load, progress)
        else:
            self._object = _whit.load(*self._source, self._load, _shipped_scenes(), progress)

    def __getstate__(self) -> dict[str, Any]:
        # copy.copy() would share a dict that is changed later.
        state = {**self.__dict__, "_load": {**self._load, "settings": self._object.settings},
                 "_transforms": dict(self._transforms)}
        del state["_object"]
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._read(None)
        if self._time is not None:
            self._object.set_time(self._time)
        for pointer, matrix in self._transforms.items():
            self._object.set_transform(pointer, matrix)

    name: str = _native("name", "Name of the scene's file without folder and extension.")

    @property
    def size(self) -> tuple[int, int]:
        """Default width and height of pictures in pixels."""
        return self._object.width, self._object.height

    cameras: list[str] = _native("cameras", "Names of the cameras; the first one is the default.")
    objects: list[str] = _native("objects", (
        "Names of the first 65,536 objects; the channel 'object' holds indices into this "
        "list."))
    materials: list[str] = _native("materials", (
        "Names of the materials; the channel 'material' holds indices into this list."))
    triangles: int = _native("triangles", "Number of triangles, counted once for each instance.")
    animations: dict[str, float] = _native("animations", (
        "Duration of each animation in seconds, by name."))
    path_seconds: float = _native("path_seconds", (
        "End of the camera path in seconds; 0 without a path."))

    @property
    def warnings(self) -> list[str]:
        """Repairs that were made while the scene was read, and whether nothing gives light."""
        return [in_python(text) for text in self._object.warnings]

    def set(self, pointer: str, value: Any, *, progress: Optional[Progress] = None) -> None:
        """Sets a member of the scene's description for the following pictures:
        set("/lights/0/intensity", 40). They equal those of a scene that was read with this value.

        pointer: a JSON pointer (RFC 6901) to the member; "-" stands for a new element of a list.
        value: as in the description, but for meshes and images in arrays: these are given when the
            scene is made, and update_mesh() replaces those of a mesh.

        Changes of lights, colors of the sky, ambient light, numbers of a scene file's or dict's own
        materials, and cameras where nothing is instanced, need no rebuild; for others the scene is
        read again. After an error the scene is unchanged.
        """
        description = Description(self.name)
        text = description.text(value, pointer)
        if description.meshes or description.images:
            raise Error(f"{self.name}#{pointer}: meshes and images are given when the scene is made;"
                        " update_mesh() replaces the arrays of a mesh", file=self.name, place=pointer)
        self._object.set_member(pointer, text, progress)

    def update_mesh(self, name: str, positions: Any, *, normals: Optional[Any] = None,
                    progress: Optional[Progress] = None) -> None:
        """Moves the vertices of a whit.Mesh for the following pictures, as in a simulation. They
        equal those of a scene that was made with these arrays.

        name: the `name` of the mesh.
        positions: (n, 3), as many as before, in the mesh's own space; they are copied. Or a Mesh,
            which replaces all arrays of the old one: then the number of vertices may change.
        normals: (n, 3) of unit length; None: those of before.

        This takes as long as making the scene: it is read again, with its textures, and its
        acceleration structure is built anew. set_transform() moves rigid things in far less time.
        After an error the scene is unchanged. In the next picture the channel "motion" is 0 where
        the mesh alone has moved, because the new scene does not know the old vertices.
        """
        meshes = self._source[2] if len(self._source) > 1 else {}
        if name not in meshes:
            if not meshes:
                _arrays._fail("update_mesh", 'a scene made of a dict with {"mesh": whit.Mesh(...)}',
                              "a scene without such meshes")
            _arrays._fail("name", ", ".join(map(repr, meshes)), repr(name))
        if isinstance(positions, Mesh):
            arrays = positions._arrays()
        else:
            arrays = _arrays.moved(meshes[name], positions, normals)
        self._object.update_mesh(name, arrays, progress)
        # Another thread may have updated other meshes meanwhile.
        made, text, meshes, images = self._source
        self._source = (made, text, {**meshes, name: arrays}, images)

    def set_time(self, seconds: float) -> None:
        """Moves animated items, cameras and lights to a time in seconds. The scene must have been
        made with moves=True."""
        self._object.set_time(seconds)
        self._time = seconds

    def set_transform(self, pointer: str, matrix: Any) -> None:
        """Sets the transform of one of `movable`, which replaces its own motion.

        matrix: (3, 4) or (4, 4), the last column the translation, in the scene's units. It is
            applied after the own `transform` of a scene's item, and replaces that of a glTF node.
        """
        rows = _arrays.matrix(matrix, "matrix")
        self._object.set_transform(pointer, rows)
        self._transforms[pointer] = rows

    def camera(self, name: str = "", *, axes: str = "opencv") -> Camera:
        """One of `cameras` as it is now, for pictures of the scene's `size`; empty: the first."""
        return Camera(json.loads(self._object.camera(name)), self.size, axes=axes)

    def render(self, *, path_time: Optional[float] = None, budget: str = "", target: str = "",
               progress: Optional[Progress] = None, **options: Any) -> Picture:
        self._object  # noqa: B018 (the attribute is there only if __init__ came to its end)
        camera = options.get("camera")
        for keyword, value in {"budget": budget, "target": target, "camera": camera}.items():
            if path_time is not None and value:
                raise Error(f"{keyword} cannot be used with path_time: leave one of them out", 2)
        if isinstance(camera, Mapping):
            raise TypeError("camera: expected a name or a whit.Camera(members, size), found a dict")
        if not isinstance(camera, Camera):
            texts = _options.texts(options, self._object)
            return Picture(self._object.render(texts, path_time, progress, "", (budget, target)))
        size = options.get("size")
        chosen = {**options, "camera": None, "size": camera.size if size is None else size}
        texts = _options.texts(chosen, self._object)
        text = Description("camera").text(camera.members)
        return Picture(self._object.render(texts, path_time, progress, text, (budget, target)))

    def view(self, *, width: Union[int, str] = "100%", height: int = 600, port: int = 0,
             **options: Any) -> Union[View, Picture]:
        """Shows the scene, as it is now, in the viewer of `whit serve`: in a notebook in a frame,
        elsewhere at the `url` of the result. Without cpp-httplib the module has no server: then
        this is render().

        width, height: of the frame, in pixels of CSS or as a text with a unit.
        port: 0: 8765, or any free one if that is taken. Where the browser runs on another machine
            than the notebook, it must be forwarded as well: ssh -L 8765:127.0.0.1:8765.

        The options are those of render(), without Camera, crop and mode="reference". Later changes
        of the scene do not show. The scene is copied, and has an acceleration structure of its own.
        """
        if isinstance(options.get("camera"), Camera):
            raise TypeError("camera: view() takes the name of one of the scene's cameras")
        texts = _options.texts(options, self._object, "view")
        if not hasattr(self._object, "view"):
            return self.render(**options)
        return View(self._object.view(texts, port), width, height)

    def closest(self, origins: Any, directions: Any, *, t_near: Any = 0.0, t_far: Any = np.inf,
                progress: Optional[Progress] = None) -> Hits:
        """The nearest hit of each ray with the scene as it is at its present time.

        origins, directions: (..., 3), float32 or float64, in the world; shapes are broadcast, and
            (3,) is one ray. A direction has a length from 1e-100 to 1e100.
        t_near, t_far: hits count from t_near to t_far, both included, in lengths of the direction;
            a number, or one for each ray.

        Surfaces count as the eye sees them: alpha masks cut them, single-sided ones are passed from
        behind, and of coplanar ones that overlap one is hit, as in pictures. An answer depends on
        its ray alone. C-contiguous arrays are read in place, on all threads and without the GIL.
        The first query builds a structure of its own for the scene.
        """
        rays, shape = self._rays(origins, directions, t_near, t_far)
        return _rays.hits(self._object.closest(rays, progress), shape)

    def all_hits(self, origins: Any, directions: Any, *, t_near: Any = 0.0, t_far: Any = np.inf,
                 limit: Optional[int] = None, progress: Optional[Progress] = None) -> Hits:
        """All hits of each ray, by their distance: at most `limit`; None: all. Coplanar surfaces
        that overlap count once, as do triangles whose common edge is hit. Arguments as in
        closest(); results have one row a hit whatever the shape of the rays."""
        rays, _ = self._rays(origins, directions, t_near, t_far)
        most = 2**64 - 1 if limit is None else operator.index(limit)
        if most < 0:
            raise ValueError(f"limit: expected None or at least 0, found {limit}")
        columns = self._object.all_hits(rays, most, progress)
        return _rays.hits(columns, columns["t"].shape)

    def occluded(self, origins: Any, directions: Any, *, t_near: Any = 0.0, t_far: Any = np.inf,
                 return_certain: bool = False, progress: Optional[Progress] = None) -> Any:
        """Whether each ray hits anything: (...), bool; with return_certain, also whether rounding
        leaves no doubt. Arguments as in closest(), which takes longer."""
        rays, shape = self._rays(origins, directions, t_near, t_far)
        return self._answers(self._object.occluded(rays, progress), shape, return_certain)

    def visible(self, points_a: Any, points_b: Any, *, normals_a: Optional[Any] = None,
                normals_b: Optional[Any] = None, return_certain: bool = False,
                progress: Optional[Progress] = None) -> Any:
        """Whether nothing lies between points, which may be points of surfaces: (...), bool.

        points_a, points_b: (..., 3); shapes are broadcast.
        normals_a, normals_b: of the surfaces at the points, unit vectors on either side: the way
            then starts off the surface by the bound on the point's rounding, as rays of pictures
            do. None: what is within four times that bound of the end does not count.
        """
        ends = _rays.alike({"points_a": points_a, "points_b": points_b},
                           {"normals_a": normals_a, "normals_b": normals_b})
        return self._answers(self._object.visible(ends, progress), ends[0].shape[:-1],
                             return_certain)

    def ambient_occlusion(self, points: Any, normals: Any, radius: float, samples: int = 64, *,
                          progress: Optional[Progress] = None) -> np.ndarray:
        """How open the surroundings of points of surfaces are: (...), float32, the share of the
        directions about the normal, weighted by their cosine, in which nothing is nearer than
        `radius`; 1 is open, 0 is closed.

        points, normals: (..., 3), the normals on the side that is asked about; shapes are broadcast.
        samples: directions for each point; they follow from the point alone.
        """
        arrays = _rays.alike({"points": points, "normals": normals}, {})
        open_ = self._object.ambient_occlusion(arrays, radius, samples, progress)
        return open_.reshape(arrays[0].shape[:-1])

    def _rays(self, origins: Any, directions: Any, t_near: Any, t_far: Any) -> tuple[list, tuple]:
        starts, ways = _rays.alike({"origins": origins, "directions": directions}, {})
        shape = starts.shape[:-1]
        return [starts, ways, _rays.limits(t_near, "t_near", shape),
                _rays.limits(t_far, "t_far", shape)], shape

    @staticmethod
    def _answers(found: tuple, shape: tuple, return_certain: bool) -> Any:
        yes, certain = (array.view(np.bool_).reshape(shape) for array in found)
        return (yes, certain) if return_certain else yes

    def __repr__(self) -> str:
        return f"<whit.Scene {self.name!r}: {self.triangles} triangles>"


Scene.render.__doc__ = f"""Renders the picture of `whit render` with these options, bit for bit.

        The camera that a model gets fits the scene's `size`: for a `size` of another aspect ratio
        state a camera here, or make the scene with its size, as
        {{"view": "model", "size": [600, 800], "scene": [{{"model": "shoe.glb"}}]}}.

        camera: a name, or a whit.Camera, whose `size` is then the picture's where none is given.
        path_time: time in seconds at which the camera path places the camera; not with `camera`,
            `budget` or `target`.
        budget: a time, as "50ms" or "10s": the options that are not given are chosen for the least
            visible error within it, and `receipt` tells which.
        target: an error, as "0.5codes" or "flip=0.01": they are chosen for the least time within it.
        progress: called now and then, by the thread that renders, with the current phase and the
            fraction done, 0 to 1; returning False raises an Error of exit status 130.

        The other arguments are the options of the command line and hold for this picture only.
        Angles are in degrees and lengths in the scene's units; defaults are in brackets:

{_options.documentation()}
        """
