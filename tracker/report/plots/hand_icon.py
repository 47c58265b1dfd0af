"""A raised hand as a marker: a palm and five fingers, drawn with round strokes."""

from __future__ import annotations

import numpy as np
from matplotlib.path import Path as Outline

from tracker.containers import FloatArray

# Start, end and half width of each stroke, in units of the icon's half height.
_STROKES = (
    ((-0.33, 0.00), (-0.46, 0.58), 0.105),
    ((-0.11, 0.05), (-0.14, 0.80), 0.105),
    ((0.12, 0.05), (0.17, 0.78), 0.105),
    ((0.33, 0.00), (0.46, 0.56), 0.105),
    ((-0.20, -0.62), (-0.74, -0.04), 0.115),
    ((-0.16, -0.12), (-0.12, -0.56), 0.30),
    ((0.14, -0.12), (0.10, -0.56), 0.30),
)


def _capsule(start: tuple[float, float], end: tuple[float, float], radius: float) -> FloatArray:
    heading = np.arctan2(end[1] - start[1], end[0] - start[0])
    turns = np.linspace(-np.pi / 2, np.pi / 2, 13)
    far, near = heading + turns, heading + np.pi + turns
    circle = radius * np.stack([np.cos([*far, *near]), np.sin([*far, *near])], axis=-1)
    centers = np.repeat(np.array([end, start]), len(turns), axis=0)
    return np.asarray(circle + centers, dtype=np.float64)


HAND = Outline.make_compound_path(
    *(Outline(_capsule(*stroke), closed=False) for stroke in _STROKES)
)
