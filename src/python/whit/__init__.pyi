# By make_stubs.py, of __init__.py and the library's table of options.
import json
import os
import warnings
import weakref
from typing import Any, Callable, Iterator, KeysView, Literal, Mapping, Optional, Sequence, Union
import numpy as np
from ._arrays import Mesh as Mesh
from ._camera import Camera as Camera
from ._error import Error as Error, in_python
from ._rays import Hits as Hits
__all__ = ['Camera', 'Error', 'Hits', 'Mesh', 'Picture', 'Scene', 'View']
__version__: str
Progress = Callable[[str, float], Optional[bool]]
class Picture:

    def __init__(self, picture: Any, statistics: Optional[dict[str, Any]]=None) -> None:
        ...

    def __reduce__(self) -> tuple:
        ...

    @property
    def rgb(self) -> np.ndarray:
        ...

    @property
    def rgba(self) -> np.ndarray:
        ...

    @property
    def srgb(self) -> np.ndarray:
        ...

    @property
    def channels(self) -> dict[str, np.ndarray]:
        ...

    def __getitem__(self, name: str) -> np.ndarray:
        ...

    def __contains__(self, name: object) -> bool:
        ...

    def __iter__(self) -> Iterator[str]:
        ...

    def __len__(self) -> int:
        ...

    def __bool__(self) -> bool:
        ...

    def keys(self) -> KeysView[str]:
        ...

    @property
    def width(self) -> int:
        ...

    @property
    def height(self) -> int:
        ...

    @property
    def left(self) -> int:
        ...

    @property
    def top(self) -> int:
        ...

    @property
    def statistics(self) -> dict[str, Any]:
        ...

    @property
    def receipt(self) -> Optional[dict[str, Any]]:
        ...

    def write(self, path: Union[str, os.PathLike]) -> None:
        ...

    def png(self) -> bytes:
        ...

    def _repr_png_(self) -> bytes:
        ...

    def __array__(self, dtype: Any=None, copy: Any=None) -> np.ndarray:
        ...

    def __repr__(self) -> str:
        ...
class View:

    @property
    def url(self) -> str:
        ...

    def __init__(self, view: Any, width: Union[int, str], height: int) -> None:
        ...

    def close(self) -> None:
        ...

    def png(self) -> bytes:
        ...

    def _repr_html_(self) -> Optional[str]:
        ...

    def _repr_png_(self) -> Optional[bytes]:
        ...

    def __repr__(self) -> str:
        ...
class Scene:

    def __init__(self, source: Union[str, os.PathLike, Mapping[str, Any]], *, settings: Optional[Mapping[str, Any]]=None, sky: Union[str, os.PathLike]='', moves: bool=False, movable: Sequence[str]=(), animation: str='', sphere_segments: int=0, strict: bool=False, allow_outside: bool=False, max_memory_gb: float=0.0, threads: int=0, progress: Optional[Progress]=None, name: str='scene') -> None:
        ...

    def _read(self, progress: Optional[Progress]) -> None:
        ...

    def __getstate__(self) -> dict[str, Any]:
        ...

    def __setstate__(self, state: dict[str, Any]) -> None:
        ...

    @property
    def name(self) -> str:
        ...

    @property
    def size(self) -> tuple[int, int]:
        ...

    @property
    def cameras(self) -> list[str]:
        ...

    @property
    def objects(self) -> list[str]:
        ...

    @property
    def materials(self) -> list[str]:
        ...

    @property
    def triangles(self) -> int:
        ...

    @property
    def animations(self) -> dict[str, float]:
        ...

    @property
    def path_seconds(self) -> float:
        ...

    @property
    def warnings(self) -> list[str]:
        ...

    def set(self, pointer: str, value: Any, *, progress: Optional[Progress]=None) -> None:
        ...

    def update_mesh(self, name: str, positions: Any, *, normals: Optional[Any]=None, progress: Optional[Progress]=None) -> None:
        ...

    def set_time(self, seconds: float) -> None:
        ...

    def set_transform(self, pointer: str, matrix: Any) -> None:
        ...

    def camera(self, name: str='', *, axes: str='opencv') -> Camera:
        ...

    def render(self, *, path_time: Optional[float]=None, budget: str='', target: str='', progress: Optional[Progress]=None, quality: Optional[Literal['good', 'standard', 'reference']]=None, size: Optional[Union[str, tuple[int, int]]]=None, camera: Optional[Union[str, Camera]]=None, eye: Optional[Sequence[float]]=None, at: Optional[Sequence[float]]=None, up: Optional[Sequence[float]]=None, fov: Optional[float]=None, ortho: Optional[float]=None, crop: Optional[Union[str, tuple[int, int, int, int]]]=None, spp: Optional[int]=None, adaptive: Optional[bool]=None, contrast: Optional[int]=None, depth: Optional[int]=None, glossy: Optional[int]=None, indirect: Optional[int]=None, cutoff: Optional[float]=None, roulette: Optional[float]=None, max_rays: Optional[int]=None, light_samples: Optional[int]=None, ambient_samples: Optional[int]=None, light_cutoff: Optional[float]=None, fresnel: Optional[Literal['exact', 'schlick']]=None, texture_filter: Optional[Literal['nearest', 'bilinear', 'trilinear']]=None, offset: Optional[Literal['bound', 'fixed', 'wachter-binder']]=None, terminator: Optional[bool]=None, bend: Optional[bool]=None, threads: Optional[int]=None, packet: Optional[Literal['auto', 1, 4, 8, 16]]=None, simd: Optional[Literal['auto', 'avx3', 'avx2', 'sse4', 'sse2', 'neon', 'scalar']]=None, mode: Optional[Literal['packets', 'reference']]=None, batch: Optional[Literal['tile', 'frame']]=None, robust: Optional[bool]=None, retry: Optional[bool]=None, bvh: Optional[Literal['low', 'medium', 'high']]=None, sphere_segments: Optional[int]=None, effects: Optional[Literal['auto', 'all']]=None, disable: Optional[Union[str, Sequence[str]]]=None, exposure: Optional[Union[float, Literal['auto']]]=None, tonemap: Optional[Literal['none', 'filmic', 'reinhard']]=None, background: Optional[Union[str, Sequence[float]]]=None, tile: Optional[int]=None, queue: Optional[int]=None, channels: Optional[Union[str, Sequence[str]]]=None, strict: Optional[bool]=None) -> Picture:
        ...

    def view(self, *, width: Union[int, str]='100%', height: int=600, port: int=0, **options: Any) -> Union[View, Picture]:
        ...

    def closest(self, origins: Any, directions: Any, *, t_near: Any=0.0, t_far: Any=np.inf, progress: Optional[Progress]=None) -> Hits:
        ...

    def all_hits(self, origins: Any, directions: Any, *, t_near: Any=0.0, t_far: Any=np.inf, limit: Optional[int]=None, progress: Optional[Progress]=None) -> Hits:
        ...

    def occluded(self, origins: Any, directions: Any, *, t_near: Any=0.0, t_far: Any=np.inf, return_certain: bool=False, progress: Optional[Progress]=None) -> Any:
        ...

    def visible(self, points_a: Any, points_b: Any, *, normals_a: Optional[Any]=None, normals_b: Optional[Any]=None, return_certain: bool=False, progress: Optional[Progress]=None) -> Any:
        ...

    def ambient_occlusion(self, points: Any, normals: Any, radius: float, samples: int=64, *, progress: Optional[Progress]=None) -> np.ndarray:
        ...

    def _rays(self, origins: Any, directions: Any, t_near: Any, t_far: Any) -> tuple[list, tuple]:
        ...

    @staticmethod
    def _answers(found: tuple, shape: tuple, return_certain: bool) -> Any:
        ...

    def __repr__(self) -> str:
        ...
