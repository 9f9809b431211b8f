"""Renderers of which it is known how they look an environment map up, and the axes of their lights."""

from __future__ import annotations

from typing import Any, Dict, NamedTuple, Optional, Tuple

import numpy as np

from . import _acdf

Axes = Tuple[int, int, int]


def _text(axes: Axes) -> str:
    return "(" + ", ".join(("-" if axis < 0 else "") + "xyz"[abs(axis) - 1] for axis in axes) + ")"


def _signed(values: np.ndarray, axis: int) -> np.ndarray:
    return -values if axis < 0 else values


class Renderer(NamedTuple):
    """What `for_renderer` sets, and the axes of the renderer's light by ours.

    axes: each of X, Y and Z is our x, y or z (1, 2, 3), or its opposite (-1, -2, -3); for lat-long and octahedral maps.
    mirrorball_axes: the same for a mirror ball; None where the renderer reads none, or nobody says how.
    """

    name: str
    domain: str
    filter: str
    wrap: str
    channel: str
    axes: Axes
    mirrorball_axes: Optional[Axes]

    def to_light(self, directions: Any) -> np.ndarray:
        """Our directions, of shape (..., 3), in the frame of the light.

        >>> import acdf
        >>> acdf.renderers["pbrt-v4"].to_light([0.6, 0.0, 0.8]).tolist()
        [-0.6, 0.0, 0.8]
        """
        given = np.asarray(directions)
        return np.stack([_signed(given[..., abs(axis) - 1], axis) for axis in self.axes], -1)

    def from_light(self, directions: Any) -> np.ndarray:
        """Directions in the frame of the light, of shape (..., 3), in ours.

        >>> import acdf
        >>> acdf.renderers["mitsuba3"].from_light([0.0, 0.8, 0.6]).tolist()
        [0.6, 0.0, 0.8]
        """
        given = np.asarray(directions)
        at = [[abs(axis) - 1 for axis in self.axes].index(k) for k in range(3)]
        return np.stack([_signed(given[..., k], self.axes[k]) for k in at], -1)

    def __str__(self) -> str:
        return f"{self.name}: {self.domain}, {self.filter}, {self.wrap}, {self.channel}; our (x, y, z) is {_text(self.axes)}"


renderers: Dict[str, Renderer] = {one["name"]: Renderer(**one) for one in _acdf.renderers()}
