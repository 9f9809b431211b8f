"""Files from arrays, by acdf::builder. The same input, options and version give the same bytes, for any number of threads."""

from __future__ import annotations

import re
from typing import Any, Callable, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import _acdf
from .files import Brdf, Environment, IndexedEnvironment, LocalEnvironment, Table, open

Size = Union[int, str]
Progress = Callable[[float, str], Optional[bool]]

_UNITS = {
    "": 1, "b": 1, "byte": 1, "bytes": 1, "k": 10**3, "kb": 10**3, "m": 10**6, "mb": 10**6, "g": 10**9, "gb": 10**9,
    "ki": 2**10, "kib": 2**10, "mi": 2**20, "mib": 2**20, "gi": 2**30, "gib": 2**30,
}  # fmt: skip


def parse_size(size: Size) -> int:
    """Bytes: a number, or text as the command line takes it.

    >>> parse_size("64KiB"), parse_size("1.5 MB"), parse_size(1000)
    (65536, 1500000, 1000)
    """
    if isinstance(size, str):
        found = re.fullmatch(r"(\d+\.?\d*|\.\d+) *([A-Za-z]*)", size)
        if not found or found[2].lower() not in _UNITS:
            raise ValueError(f"budget: {size!r} is no size; give for example '64KiB'")
        return int(float(found[1]) * _UNITS[found[2].lower()])
    return int(size)


def _options(given: dict) -> dict:
    if given.get("budget") is not None:
        given["budget"] = parse_size(given["budget"])
    return given


def build_environment(
    image: Any,
    *,
    budget: Optional[Size] = None,
    cells: Optional[int] = None,
    variance: Optional[float] = None,
    projection: str = "latlong",
    for_renderer: Optional[str] = None,
    domain: Optional[str] = None,
    filter: Optional[str] = None,
    wrap: Optional[str] = None,
    channel: Optional[str] = None,
    bad_texels: str = "zero",
    uniform_if_black: bool = False,
    fit: str = "variance",
    max_weight: float = 0.0,
    mis: Optional[str] = None,
    heuristic: Optional[str] = None,
    shares: Tuple[float, float] = (1.0, 1.0),
    normals: Optional[Any] = None,
    normal_weights: Optional[Any] = None,
    compress: str = "none",
    source_name: str = "",
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Environment:
    """An environment map from pixels.

    image: linear radiance of shape (height, width), or (height, width, channels) with 1, 3 or 4 channels (the fourth is
        ignored), rows from the top. float16, float32 and float64 are read in place, whatever their strides.
    budget, cells, variance: one goal: at most so many bytes ("64KiB", the default), about so many cells, or at most this
        relative variance.
    projection: "latlong", "angular", "mirrorball", "vertical-cross", "horizontal-cross", "stacked-cube", "octahedral".
    for_renderer: a name of `acdf.renderers`: sets domain, filter, wrap and channel, and the partner and heuristic of its path
        integrator, but for those that are given. Swap axes by `acdf.renderers[name].to_light` and `from_light`.
    domain: the grid of the fit: "source" (the default), "latlong" or "octahedral".
    filter: how the renderer looks the map up: "bilinear" (the default), which serves nearest lookups, too, or "nearest", which
        is biased under bilinear lookups.
    wrap: what a bilinear lookup finds beyond the first and the last row: "clamp" (that row, the default) or "repeat" (the row at
        the other end).
    channel: whose noise counts: "luminance" (the default), "rgb", "max", "red", "green", "blue", "average".
    bad_texels: what NaN, infinite and negative values become: "zero"; "clamp": +infinity is 65504 in arrays of half floats, else
        the largest value of its channel, and the others are 0; or "error".
    fit: "variance", "cdf", "pdf" or "uniform".
    max_weight: the largest weight of a sample over the mean, at least 1; 0: no bound.
    mis, heuristic, shares, normals, normal_weights: the sampler that it is to be combined with, "none" (the default),
        "cosine", "brdf" or "mean"; "balance" (the default) or "power"; samples of the file and of the partner, in proportion;
        the normals of the scene.
    compress: "none", "zlib" or "planes".
    threads: at most so many; 0: all cores.
    progress: called with the share that is done and what is being done; returning False cancels.

    Raises ValueError for options, BuildError for sources that no file can be made of.

    >>> import acdf, numpy as np
    >>> image = np.full((32, 64, 3), 0.1)
    >>> image[8, 20] = 500.0
    >>> sky = acdf.build_environment(image, budget="2KiB", channel="rgb")
    >>> sky.size <= 2048, sky.info()["filter"]
    (True, 'bilinear')
    """
    return open(_acdf.build_environment(image, _options({k: v for k, v in locals().items() if k != "image"})))


class EnvironmentRebuilder:
    """Environments of a map that changes: made once for a size, rebuilt for each frame.

    width, height: of the map, which is lat-long or octahedral.
    quality: "fast" rebuilds in memory that is taken once; "best" makes the files of build_environment, in its time.
    Other options are those of build_environment. An object serves one call at a time.

    >>> import acdf, numpy as np
    >>> sky = acdf.EnvironmentRebuilder(64, 32, budget="2KiB", filter="nearest")
    >>> image = np.ones((32, 64, 3), np.float32)
    >>> frame = sky.rebuild(image)
    >>> image[8, 20] = 500
    >>> frame = sky.update(image, (20, 8, 1, 1))
    >>> frame.size <= 2048, sky.relative_variance < 0.01
    (True, True)
    """

    def __init__(
        self,
        width: int,
        height: int,
        *,
        quality: str = "fast",
        budget: Optional[Size] = None,
        cells: Optional[int] = None,
        projection: str = "latlong",
        filter: Optional[str] = None,
        wrap: Optional[str] = None,
        channel: Optional[str] = None,
        bad_texels: str = "zero",
        uniform_if_black: bool = False,
        source_name: str = "",
    ) -> None:
        given = {k: v for k, v in locals().items() if k not in ("self", "width", "height")}
        self._made = _acdf.Rebuilder(width, height, _options(given))

    def rebuild(self, image: Any, *, threads: int = 0) -> Environment:
        """The environment of a frame. image: as build_environment takes it, of the size that this was made for."""
        return open(self._made.rebuild(image, None, threads))

    def update(self, image: Any, region: Sequence[int], *, threads: int = 0) -> Environment:
        """The same where only the pixels of a region (x, y, width, height) have changed since the last call."""
        return open(self._made.rebuild(image, tuple(region), threads))

    @property
    def relative_variance(self) -> float:
        """Of one sample of the last frame."""
        return float(self._made.relative_variance())


def build_indexed(
    maps: Any,
    axes: Mapping[str, Sequence[float]],
    *,
    budget: Optional[Size] = None,
    sun: Union[bool, Any] = True,
    projection: str = "latlong",
    for_renderer: Optional[str] = None,
    filter: Optional[str] = None,
    wrap: Optional[str] = None,
    channel: Optional[str] = None,
    bad_texels: str = "zero",
    uniform_if_black: bool = False,
    compress: str = "none",
    source_name: str = "",
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> IndexedEnvironment:
    """One file of several maps of one size, such as the hours of a day. The default budget is 64 KiB.

    maps: as many images as there are coordinates, each as build_environment takes it, lat-long or octahedral. With several axes
        the last one changes fastest. Or one array of them all, whose leading shape is the lengths of the axes.
    axes: names, and the coordinates of maps along each, which rise: {"time": [6, 9, 12], "turbidity": [2, 6]}. Up to three.
    sun: True: a small region that is much brighter than all else is looked for, and a cone that moves between maps stands for
        it. False: it is stored as any other light, and between maps there are two of it. Or an array of shape (maps, 3):
        where it is in each map, zeros where it is not up.
    Other options are those of build_environment.

    >>> import acdf, numpy as np
    >>> maps = [np.full((32, 64, 3), brightness) for brightness in (1, 2, 3)]
    >>> day = acdf.build_indexed(maps, {"time": [6, 9, 12]}, budget="4KiB")
    >>> day.axes, day.size <= 4096
    (('time',), True)
    >>> round(day.at(time=7.5).total / day.at(6).total, 4)
    1.5
    """
    given = {k: v for k, v in locals().items() if k not in ("maps", "sun")}
    given["axes"] = [(name, [float(x) for x in along]) for name, along in axes.items()]
    counts = tuple(len(along) for _, along in given["axes"])
    if isinstance(maps, np.ndarray) and maps.shape[: len(counts)] == counts:
        maps = [maps[i] for i in np.ndindex(*counts)]
    if isinstance(sun, (bool, np.bool_)):
        given["sun"] = bool(sun)
    else:
        given["suns"] = np.asarray(sun, np.float64).reshape(-1, 3).tolist()
    return open(_acdf.build_indexed(list(maps), _options(given)))


def build_local(
    image: Any,
    *,
    budget: Optional[Size] = None,
    cells: Optional[int] = None,
    variance: Optional[float] = None,
    projection: str = "latlong",
    for_renderer: Optional[str] = None,
    domain: Optional[str] = None,
    filter: Optional[str] = None,
    wrap: Optional[str] = None,
    channel: Optional[str] = None,
    bad_texels: str = "zero",
    uniform_if_black: bool = False,
    subdivisions: Optional[int] = None,
    tiles: Optional[int] = None,
    normals: Optional[Any] = None,
    normal_weights: Optional[Any] = None,
    max_weight: float = 0.0,
    cosine_share: float = 0.0,
    sharing: bool = True,
    mis: Optional[str] = None,
    heuristic: Optional[str] = None,
    shares: Tuple[float, float] = (1.0, 1.0),
    compress: str = "none",
    source_name: str = "",
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> LocalEnvironment:
    """A local environment map from pixels: a pdf for every normal. The default budget is 1 MiB.

    Options are those of build_environment, and:
    subdivisions, tiles: how many bins of normals (4 n^2 + 2) and shared tiles; None: as suits the size.
    normals, normal_weights: only what a scene has, of shape (n, 3), and how often each occurs; None: all normals.
    max_weight: of the samples of all normals that accuracy is measured for.
    cosine_share: of samples that are taken around the normal instead, in [0, 0.99].
    sharing: bins share tiles; else each has a tree of its own, of the fits "cdf", "pdf" or "uniform".
    mis: "none" or "cosine".
    """
    return open(_acdf.build_local(image, _options({k: v for k, v in locals().items() if k != "image"})))


def build_brdf(
    source: Any,
    *,
    budget: Optional[Size] = None,
    cells: Optional[int] = None,
    variance: Optional[float] = None,
    channel: str = "luminance",
    isotropic: bool = True,
    mirrored: bool = True,
    theta_views: Optional[int] = None,
    phi_views: Optional[int] = None,
    max_weight: float = 0.0,
    diffuse_share: float = 0.0,
    compress: str = "none",
    source_name: str = "",
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Brdf:
    """A BRDF from a table or a function. The default budget is 128 KiB.

    source: rho in sr^-1, without the cosine. Either an array over (theta_o, phi_o, theta_h, phi_h), h the half-vector, whose
        values stand at the centres of cells that divide theta in [0, pi/2] and phi in [0, 2 pi) equally; with a single
        phi_o it is isotropic. Or a function of wo and wi, tuples of three numbers, that returns one number or three. A
        function is called millions of times, under the interpreter's lock: a table is much faster.
    isotropic, mirrored: of a function: whether it depends on the difference of azimuths alone, and not on its sign. False is
        always right.
    theta_views, phi_views: stored views; None: as suits the size.
    max_weight: the largest weight of a sample over the mean, at least 1, of all views that accuracy is measured for; 0: about
        20 where that costs next to nothing.
    diffuse_share: of samples that follow the cosine, in [0, 0.99].
    """
    return open(_acdf.build_brdf(source, _options({k: v for k, v in locals().items() if k != "source"})))


def build_table(
    array: Any,
    *,
    budget: Optional[Size] = None,
    cells: Optional[int] = None,
    variance: Optional[float] = None,
    indexed: int = 0,
    names: Optional[Sequence[str]] = None,
    ranges: Optional[Sequence[Tuple[float, float]]] = None,
    max_weight: float = 0.0,
    bad_as_zero: bool = False,
    compress: str = "none",
    source_name: str = "",
    threads: int = 0,
    progress: Optional[Progress] = None,
) -> Table:
    """A pdf over any table of numbers >= 0, in one to six axes; each number is constant on its box of the grid.
    The default budget is 64 KiB, of more than 256 bins 256 bytes a bin.

    indexed: so many leading axes are chosen by who samples: each index is a bin with a pdf of its own.
    names, ranges: of each axis; by default x0, x1, ..., and from 0 to its length.
    cells: a bin, on average.
    bad_as_zero: NaN, infinite and negative numbers count as 0; else they are a BuildError.
    """
    return open(_acdf.build_table(array, _options({k: v for k, v in locals().items() if k != "array"})))
