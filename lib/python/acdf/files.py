"""Open files: pdfs to sample from and to evaluate, for arrays.

Random numbers `u` are float64 in [0, 1] of shape (..., 2); directions, normals and views are float32 of shape (..., 3). Such
arrays are used as they lie if they are contiguous, others are converted. Results have the leading shape of what was asked.
`out` takes arrays of such results, of the right type and contiguous, to be written to: large new ones cost time.
Loops run without the interpreter's lock, so several threads may sample at once.
"""

from __future__ import annotations

import os
from typing import Any, Dict, NamedTuple, Optional, Tuple, Union

import numpy as np

from . import _acdf
from ._output import write_file

_NEW = (None, None)
Path = Union[str, "os.PathLike[str]"]


class Samples(NamedTuple):
    """What was sampled: directions (of tables points), and the pdf of each.

    Where nothing can be sampled the pdf is 0; the direction is 0 then, a point NaN.
    """

    direction: np.ndarray
    pdf: np.ndarray


class File:
    """An open file of any kind. It never changes: any number of threads may use it."""

    def __init__(self, handle: _acdf.OpenFile):
        self._handle = handle
        self._description = handle.describe()

    @property
    def kind(self) -> str:
        """"environment", "local", "brdf", "table" or "indexed"."""
        return self._description["kind"]

    @property
    def size(self) -> int:
        """Bytes of the whole file."""
        return self._description["bytes"]

    @property
    def total(self) -> float:
        """The integral of what is sampled: of light over the sphere (luminance times sr), of a table over its sampled axes,
        of a BRDF the sum of the albedos of its stored views."""
        return self._description["total"]

    def info(self) -> Dict[str, Any]:
        """What is inside: axes, size, fit, and what the builder measured; named as in `acdf info --json`.

        >>> import acdf, numpy as np
        >>> acdf.build_environment(np.ones((8, 16)), cells=64).info()["axes"][0]["name"]
        'phi'
        """
        out = {key: value for key, value in self._description.items() if key not in ("metadata", "partner")}
        if self._description["partner"] is not None:
            out["partner"] = self._description["partner"]
        groups: Dict[str, Dict[str, Any]] = {"source": {}, "accuracy": {}, "metadata": {}}
        for key, value in self._description["metadata"].items():
            group, _, name = key.partition(".")
            if key == "tool":
                out["tool"] = value
            elif key == "fit.options":
                out["options"] = value
            elif group in ("source", "accuracy") and name:
                groups[group][name] = _number(value) if group == "accuracy" else value
            else:
                groups["metadata"][key] = value
        out.update({name: group for name, group in groups.items() if group})
        return out

    @property
    def requires_mis(self) -> bool:
        """Whether it is to be combined with another sampler, by multiple importance sampling: used alone it is biased."""
        return self._description["partner"] is not None

    def to_bytes(self) -> bytes:
        """The whole file."""
        return self._handle.to_bytes()

    def save(self, path: Path) -> None:
        """Writes the file to `path`: whole or, raising OSError, not at all. Symbolic links are followed, and a file that is
        replaced hands on its mode."""
        write_file(os.fsdecode(path), self.to_bytes())

    def __repr__(self) -> str:
        return f"<acdf.{type(self).__name__}, {self.size} bytes>"

    def __reduce__(self):
        return open, (self.to_bytes(),)


class Environment(File):
    """An environment map: one pdf over the sphere."""

    def sample(self, u: Any, *, out: Optional[Samples] = None) -> Samples:
        """Samples a direction for each pair of numbers. u[..., 0] moves along phi, u[..., 1] along theta.

        >>> import acdf, numpy as np
        >>> sky = acdf.build_environment(np.ones((8, 16)), cells=64)
        >>> sky.sample([0.5, 0.25]).direction.shape
        (3,)
        """
        return Samples(*self._handle.sample(None, u, tuple(out or _NEW)))

    def pdf(self, directions: Any, *, out: Optional[np.ndarray] = None) -> np.ndarray:
        """The pdf in sr^-1 with which `sample` samples each direction, float32; 0 where none falls, and for vectors that
        are NaN or not of unit length.

        >>> import acdf, numpy as np
        >>> sky = acdf.build_environment(np.ones((8, 16)), cells=64)
        >>> np.round(sky.pdf([[0, 0, 1], [0, 0, 2]]), 3).tolist()
        [0.07999999821186066, 0.0]
        """
        return self._handle.pdf(None, directions, out)

    def invert(self, directions: Any) -> np.ndarray:
        """The numbers u that sample each direction; NaN where the pdf is 0."""
        return self._handle.invert(None, directions)


class LocalEnvironment(File):
    """A pdf for every normal: of light above its horizon, times the cosine.

    Normals have any length > 0. Their leading shape begins that of `u` or of the directions: one normal (3,) serves all,
    (n, 3) serve n samples (n, 2), or n groups of m (n, m, 2). Visibility cells are not read: the normal alone counts.
    """

    def sample(self, normals: Any, u: Any, *, out: Optional[Samples] = None) -> Samples:
        """Samples directions. The pdf is 0 where the normal is zero or NaN, or no light reaches it; a direction below the
        horizon counts as 0.

        >>> import acdf, numpy as np
        >>> light = acdf.build_local(np.ones((16, 32)), budget="64KiB")
        >>> light.sample([0, 0, 1], np.random.default_rng(1).random((5, 2))).pdf.shape
        (5,)
        """
        return Samples(*self._handle.sample(normals, u, tuple(out or _NEW)))

    def pdf(self, normals: Any, directions: Any, *, out: Optional[np.ndarray] = None) -> np.ndarray:
        """Pdfs in sr^-1, float32: exactly those of `sample` for what it returned."""
        return self._handle.pdf(normals, directions, out)

    def irradiance(self, normals: Any) -> np.ndarray:
        """The integral of light times cosine for each normal, about (luminance times sr): to choose between lights."""
        return self._handle.total_of(normals)


class Brdf(File):
    """A pdf of wi for every wo, both unit vectors in the surface's frame, z its normal. It follows what the surface
    reflects, times the cosine.

    The leading shape of `wo` begins that of `u` or `wi`, as for normals. Where the package is built with Google Highway,
    arrays are sampled by vector instructions, bit for bit the same.
    """

    def sample(self, wo: Any, u: Any, *, out: Optional[Samples] = None) -> Samples:
        """Samples wi. The pdf is 0 where wo is not a unit vector above the surface; wi below it counts as 0."""
        return Samples(*self._handle.sample(wo, u, tuple(out or _NEW)))

    def pdf(self, wo: Any, wi: Any, *, out: Optional[np.ndarray] = None) -> np.ndarray:
        """Pdfs of wi in sr^-1, float32."""
        return self._handle.pdf(wo, wi, out)

    def invert(self, wo: Any, wi: Any) -> np.ndarray:
        """The numbers u that sample wi; NaN where the table's pdf is 0."""
        return self._handle.invert(wo, wi)

    def albedo(self, wo: Any) -> np.ndarray:
        """The share of light that is reflected to each wo, about."""
        return self._handle.total_of(wo)


class Table(File):
    """A pdf over the sampled axes of a table, for every bin of its indexed axes.

    `u` and points have a number a sampled axis. `index` has an integer a indexed axis, and is None where there is none; its
    leading shape begins that of `u`. Points and pdfs are float64.
    """

    def sample(self, u: Any, index: Optional[Any] = None, *, out: Optional[Samples] = None) -> Samples:
        """Samples points, in the units of the axes; the pdf is per product of those.

        >>> import acdf, numpy as np
        >>> table = acdf.build_table(np.arange(1.0, 65.0).reshape(8, 8), ranges=[(0, 1), (0, 1)])
        >>> point, pdf = table.sample(np.random.default_rng(1).random((100, 2)))
        >>> bool((point > 0).all() and (point < 1).all() and (pdf > 0).all())
        True
        """
        return Samples(*self._handle.sample(index, u, tuple(out or _NEW)))

    def pdf(self, x: Any, index: Optional[Any] = None, *, out: Optional[np.ndarray] = None) -> np.ndarray:
        """Pdfs of points; 0 outside the axes and for NaN."""
        return self._handle.pdf(index, x, out)

    def invert(self, x: Any, index: Optional[Any] = None) -> np.ndarray:
        """The numbers u that sample each point; NaN where the pdf is 0."""
        return self._handle.invert(index, x)


class MixedEnvironment:
    """An environment at some coordinates of an IndexedEnvironment: samples and pdfs as those of an Environment."""

    def __init__(self, handle: _acdf.Mixed):
        self._handle = handle

    @property
    def total(self) -> float:
        """The integral of light over the sphere, linear between maps."""
        return self._handle.total()

    @property
    def sun_share(self) -> float:
        """The share of samples in the cone of the sun; 0 where there is none."""
        return self._handle.sun_share()

    def sample(self, u: Any, *, out: Optional[Samples] = None) -> Samples:
        """Samples a direction for each pair of numbers."""
        return Samples(*self._handle.sample(u, tuple(out or _NEW)))

    def pdf(self, directions: Any, *, out: Optional[np.ndarray] = None) -> np.ndarray:
        """Pdfs in sr^-1, float32: exactly those of `sample` for what it returned."""
        return self._handle.pdf(directions, out)

    def invert(self, directions: Any) -> np.ndarray:
        """Numbers u that sample each direction; NaN where the pdf is 0."""
        return self._handle.invert(directions)


class IndexedEnvironment(File):
    """Environments along one to three axes, such as the hours of a day (`acdf env --axis`)."""

    @property
    def axes(self) -> Tuple[str, ...]:
        """The names of the axes."""
        return tuple(axis["name"] for axis in self._description["axes"] if axis["role"] == "indexed")

    def at(self, *coordinates: float, **named: float) -> MixedEnvironment:
        """The environment at coordinates, in the order of the axes or by name: `day.at(9.5)`, `day.at(time=9.5)`. Beyond the
        first and the last map of an axis these stand.
        """
        names = self.axes
        given = dict(zip(names, coordinates), **named)
        if len(coordinates) + len(named) != len(names) or set(given) != set(names):
            raise TypeError(f"at() takes a coordinate for each of the axes {', '.join(names)}")
        return MixedEnvironment(_acdf.mixed_at(self._handle, [float(given[name]) for name in names]))


_KINDS = {"environment": Environment, "local": LocalEnvironment, "brdf": Brdf, "table": Table, "indexed": IndexedEnvironment}


def open(source: Union[Path, bytes, bytearray, memoryview], *, tables: bool = True) -> Any:
    """Opens a file by its path, or the bytes of one. `bytes` are used in place, other buffers are copied.

    tables: whether tables are made in memory that answer in a fraction of the time.

    Returns an Environment, LocalEnvironment, Brdf, Table or IndexedEnvironment. Raises FileError for bytes that are no such file, OSError
    where it cannot be read, MemoryError.

    >>> import acdf
    >>> acdf.open(b"no such thing" * 9)
    Traceback (most recent call last):
        ...
    acdf._errors.FileError: this is not an .acdf file, or its first bytes are damaged (rule 2002 ...
    """
    if isinstance(source, (bytes, bytearray, memoryview)):
        handle = _acdf.open_bytes(bytes(source), tables)
    else:
        path = os.fspath(source)
        if not os.path.exists(path):
            raise FileNotFoundError(2, os.strerror(2), path)
        handle = _acdf.open_path(os.fsencode(path), tables)
    return _KINDS[handle.describe()["kind"]](handle)


def _number(text: str) -> Any:
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text
