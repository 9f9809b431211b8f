"""Pictures of files for notebooks, by matplotlib. Each plots into `ax`, or into axes of its own, and returns them."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from .files import Brdf, Environment, LocalEnvironment

try:
    import matplotlib.colors
    import matplotlib.pyplot
except ImportError as error:
    raise ImportError("acdf.plot needs matplotlib: install python3-matplotlib, or `pip install matplotlib`") from error


def latlong_directions(height: int) -> np.ndarray:
    """The directions of the texels of a lat-long image of (height, 2 height): shape (height, 2 height, 3).

    >>> from acdf import plot
    >>> bool(plot.latlong_directions(64)[32, 64, 0] > 0.99)  # +x is in the middle
    True
    """
    theta = (np.arange(height) + 0.5) / height * np.pi
    phi = np.pi - (np.arange(2 * height) + 0.5) / height * np.pi
    sine = np.sin(theta)[:, None]
    z = np.broadcast_to(np.cos(theta)[:, None], (height, 2 * height))
    return np.stack([sine * np.cos(phi), sine * np.sin(phi), z], axis=-1).astype(np.float32)


def pdf(file: Any, condition: Optional[Any] = None, *, height: int = 256, ax: Any = None) -> Any:
    """The pdf over the sphere in false colour, on a logarithmic scale: lat-long, +x in the middle, +z on top.

    condition: the normal of a LocalEnvironment, wo of a Brdf; (0, 0, 1) by default.
    """
    directions = latlong_directions(height)
    condition = (0.0, 0.0, 1.0) if condition is None else condition
    if isinstance(file, Environment):
        values = file.pdf(directions)
    elif isinstance(file, (LocalEnvironment, Brdf)):
        values = file.pdf(condition, directions)
    else:
        raise TypeError(f"{type(file).__name__}: only pdfs over the sphere can be plotted")
    ax = ax or matplotlib.pyplot.subplots(figsize=(8, 4))[1]
    largest = float(values.max())
    scale = matplotlib.colors.LogNorm(max(largest * 1e-6, float(values[values > 0].min())), largest)
    picture = ax.imshow(np.where(values > 0, values, np.nan), norm=scale, extent=(180, -180, -90, 90))
    ax.figure.colorbar(picture, ax=ax, label="pdf, sr$^{-1}$", shrink=0.7)
    ax.set(xlabel="azimuth, degrees", ylabel="elevation, degrees")
    return ax


def samples(directions: Any, *, ax: Any = None, **style: Any) -> Any:
    """Directions as points over a lat-long image; `style` goes to matplotlib's `scatter`."""
    x, y, z = np.moveaxis(np.asarray(directions).reshape(-1, 3), -1, 0)
    ax = ax or matplotlib.pyplot.subplots(figsize=(8, 4))[1]
    options = {"s": 2, "c": "white", "linewidths": 0, **style}
    ax.scatter(np.degrees(np.arctan2(y, x)), np.degrees(np.arcsin(np.clip(z, -1, 1))), **options)
    ax.set(xlim=(180, -180), ylim=(-90, 90))
    return ax
