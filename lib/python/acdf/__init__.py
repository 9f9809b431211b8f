"""Importance sampling of measured light and reflectance from small .acdf files.

    >>> import acdf, numpy as np
    >>> sky = acdf.build_environment(np.ones((32, 64, 3), np.float32), budget="4KiB")
    >>> u = np.random.default_rng(1).random((1000, 2))
    >>> directions, pdf = sky.sample(u)
    >>> directions.shape, pdf.shape
    ((1000, 3), (1000,))
    >>> bool(np.allclose(pdf, 1 / (4 * np.pi), rtol=1e-3))
    True

`open` reads a file, the `build_...` functions make one from arrays. Both return an `Environment`, an `IndexedEnvironment`, a
`LocalEnvironment`, a `Brdf` or a `Table`. Directions are unit vectors in a right-handed frame with z up, pdfs are per steradian.
"""

from ._acdf import __version__, format_version
from ._errors import BuildError, FileError
from ._renderers import Renderer, renderers
from .build import EnvironmentRebuilder, build_brdf, build_environment, build_indexed, build_local, build_table
from .files import Brdf, Environment, File, IndexedEnvironment, LocalEnvironment, MixedEnvironment, Samples, Table, open

__all__ = [
    "Brdf",
    "BuildError",
    "Environment",
    "EnvironmentRebuilder",
    "File",
    "FileError",
    "IndexedEnvironment",
    "LocalEnvironment",
    "MixedEnvironment",
    "Renderer",
    "Samples",
    "Table",
    "__version__",
    "build_brdf",
    "build_environment",
    "build_indexed",
    "build_local",
    "build_table",
    "format_version",
    "open",
    "plot",
    "renderers",
]


def __getattr__(name):  # matplotlib is asked for with the first picture
    if name == "plot":
        import importlib

        return importlib.import_module(".plot", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
