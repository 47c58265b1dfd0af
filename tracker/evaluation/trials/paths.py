"""Where do simulated people walk? Walks between stops, standing, or what a camera recorded."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tracker.containers import FloatArray
from tracker.errors import SceneError


def walks(
    rng: np.random.Generator,
    stamps_s: FloatArray,
    people: int,
    area_m: tuple[float, float, float, float],
    pause_s: float,
    speed_mps: float = 1.0,
) -> FloatArray:
    """People who walk from one place to the next and stop there.

    Args:
        rng: All randomness.
        stamps_s: Shape (T,), ascending.
        people: P.
        area_m: x from, x to, y from, y to.
        pause_s: Mean of the (exponentially distributed) stops; infinite for people who stand.
        speed_mps: Mean of the speed, which spreads by a fifth from walk to walk.

    Returns:
        Shape (T, P, 2).
    """
    lower, upper = np.array(area_m[0::2]), np.array(area_m[1::2])
    xy = np.empty((len(stamps_s), people, 2))
    for person in range(people):
        places, times = [rng.uniform(lower, upper)], [float(stamps_s[0])]
        while times[-1] < stamps_s[-1]:
            # Exponential stops have no memory: the first may as well have begun before.
            stop_s = rng.exponential(pause_s) if np.isfinite(pause_s) else np.inf
            next_place = rng.uniform(lower, upper)
            speed = speed_mps * np.clip(rng.normal(1.0, 0.2), 0.4, 1.6)
            walk_s = float(np.linalg.norm(next_place - places[-1])) / speed
            leave_s = min(times[-1] + stop_s, float(stamps_s[-1]) + 1.0)
            places += [places[-1], next_place]
            times += [leave_s, leave_s + walk_s]
        for axis in (0, 1):
            xy[:, person, axis] = np.interp(stamps_s, times, [place[axis] for place in places])
    return xy


def recorded(rng: np.random.Generator, stamps_s: FloatArray, file: str | Path) -> FloatArray:
    """A piece of a recording of real people, beginning at a random time, around its own middle.

    Args:
        rng: Chooses the piece.
        stamps_s: Shape (T,), ascending.
        file: CSV with the columns t_s, id, x_m, y_m, sorted by time.

    Returns:
        Shape (T, P, 2), P everybody of the piece; NaN while somebody is not there.

    Raises:
        SceneError: The file is missing, no such table, or shorter than the piece.
    """
    table = _read(file)
    length_s = float(stamps_s[-1] - stamps_s[0])
    first_s, last_s = table[:, 0].min(), table[:, 0].max()
    if last_s - first_s < length_s:
        raise SceneError(
            f"{file}: lasts {last_s - first_s:.1f} s; a piece of {length_s:.1f} s is needed."
        )
    begin_s = rng.uniform(first_s, last_s - length_s)
    middle = np.median(table[:, 2:], axis=0)
    at_s = stamps_s - stamps_s[0] + begin_s
    columns = []
    for person in np.unique(table[:, 1]):
        t_s, _, x_m, y_m = table[table[:, 1] == person].T
        path = np.stack([np.interp(at_s, t_s, axis_m) for axis_m in (x_m, y_m)], axis=-1)
        path[(at_s < t_s[0]) | (at_s > t_s[-1])] = np.nan
        if np.isfinite(path).any():
            columns.append(path - middle)
    return np.stack(columns, axis=1) if columns else np.zeros((len(stamps_s), 0, 2))


def _read(file: str | Path) -> FloatArray:
    try:
        lines = Path(file).read_text(encoding="utf-8").splitlines()[1:]
        table = np.array([line.split(",") for line in lines], dtype=np.float64)
    except (OSError, ValueError) as error:
        raise SceneError(f"{file}: is not a table of t_s, id, x_m, y_m ({error}).") from error
    if table.ndim != 2 or table.shape[1] != 4:
        raise SceneError(
            f"{file}: has the shape {table.shape}; expected rows of t_s, id, x_m, y_m."
        )
    return table
