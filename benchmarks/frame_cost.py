"""What does one frame cost, at 1 to 500 people? The product beside its peers, in one run.

    python benchmarks/frame_cost.py [--people 1 5 20 100 500] [--seconds 12] [--turn 1]

Everybody is tracked and measured in every frame, far enough apart that no tracker has to guess.
Contenders take turns in a new order each time, so that other work on the machine slows all alike;
medians over the turns, of the ratios too, which compare what ran side by side. With turns of one
frame everybody finds the caches cold, as on a robot whose perception works in between; with longer
turns they are warm, as in a study. The product's frames are compiled beforehand, and compared
with those that are not.

  plain       product: constant velocity, Hungarian, Gaussian ranges
  default     product: every default (stand-or-walk IMM, heavy-tailed ranges, occlusion, existence)
  no numba    the same defaults, as Python runs them
  filterpy    one KalmanFilter per person, predict + update, measurements already assigned
  norfair, motpy, Stone Soup (2-D assignment): as their documentation sets them up

norfair and motpy get positions (they know nothing else), and so does filterpy; the others get
bearings and ranges. What each makes of those numbers before it tracks (`Measurements`,
`Detection`) is timed with it. Whoever has taken a quarter of the time steps back, so that the
others get their turns. Stone Soup is left out where a frame would take seconds, and so is whoever
is not installed (`pip install -e .[bench]` brings all).
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Callable
from importlib.util import find_spec
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table

from tracker import Config, Measurements, PersonTracker
from tracker.containers import View
from tracker.tracking.machine_frame import compile_tracker

PERIOD_S = 0.1
STD_M = 0.05
STONE_SOUP_MOST = 100
FRAMES_LEAST, FRAMES_MOST = 8, 400
CONFIRMING = 4


class Seen(NamedTuple):
    """One frame: where everybody seems to be, in both forms, each of N rows."""

    xy_m: np.ndarray
    bearing_rad: np.ndarray
    range_m: np.ndarray

    @staticmethod
    def at(xy_m: np.ndarray) -> Seen:
        """Places as a sensor at the origin would give them."""
        return Seen(xy_m, np.arctan2(xy_m[:, 1], xy_m[:, 0]), np.hypot(xy_m[:, 0], xy_m[:, 1]))


Step = Callable[[int, Seen], None]


def product(compiled: bool = True, **parameters: object) -> Callable[[int], Step]:
    """The product, with some parameters."""

    def make(people: int) -> Step:
        tracker = PersonTracker(Config().replace(**parameters), compiled=compiled)
        view = View(np.zeros(3), 2 * np.pi) if not parameters else None

        def step(frame: int, seen: Seen) -> None:
            std_rad = STD_M / seen.range_m
            measured = Measurements.polar(seen.bearing_rad, seen.range_m, std_rad, STD_M)
            tracks = tracker.step(round(frame * PERIOD_S * 1e9), measured, view=view)
            # The gate turns one true measurement in a hundred away, which begins a track.
            assert people <= len(tracks) <= 1.2 * people + 3

        return step

    return make


def filterpy(people: int) -> Step:
    """A loop of filters, each with its measurement."""
    from filterpy.common import Q_continuous_white_noise
    from filterpy.kalman import KalmanFilter

    filters = []
    for _ in range(people):
        item = KalmanFilter(4, 2)
        item.F = np.eye(4) + PERIOD_S * np.eye(4, k=2)
        item.H, item.R = np.eye(2, 4), STD_M**2 * np.eye(2)
        item.Q = Q_continuous_white_noise(2, PERIOD_S, 0.3, 2, order_by_dim=False)
        filters.append(item)

    def step(frame: int, seen: Seen) -> None:
        for item, z in zip(filters, seen.xy_m, strict=True):
            item.predict()
            item.update(z)

    return step


def norfair(people: int) -> Step:
    """The tracker of norfair, for points."""
    from norfair import Detection, Tracker

    tracker = Tracker(distance_function="euclidean", distance_threshold=1.0)

    def step(frame: int, seen: Seen) -> None:
        tracker.update([Detection(points=point[None]) for point in seen.xy_m])

    return step


def motpy(people: int) -> Step:
    """The tracker of motpy, for boxes a meter wide."""
    from motpy import Detection, MultiObjectTracker

    tracker = MultiObjectTracker(dt=PERIOD_S)

    def step(frame: int, seen: Seen) -> None:
        boxes = np.concatenate([seen.xy_m - 0.5, seen.xy_m + 0.5], axis=1)
        tracker.step([Detection(box=box) for box in boxes])

    return step


def stone_soup(people: int) -> Step:
    """Stone Soup's extended Kalman filter and two-dimensional assignment."""
    from _stone_soup import StoneSoup

    tracker = StoneSoup((0.02, STD_M), "gnn", min_points=2)

    def step(frame: int, seen: Seen) -> None:
        measured = Measurements.polar(seen.bearing_rad, seen.range_m, 0.02, STD_M)
        tracker.step(round(frame * PERIOD_S * 1e9), measured)

    return step


CONTENDERS: dict[str, Callable[[int], Step]] = {
    "plain": product(motion="cv", association="hungarian", outlier_dof=0.0),
    "default": product(),
    "no numba": product(compiled=False),
    "filterpy": filterpy,
    "norfair": norfair,
    "motpy": motpy,
    "Stone Soup": stone_soup,
}

MODULES = {
    "filterpy": "filterpy", "norfair": "norfair", "motpy": "motpy", "Stone Soup": "stonesoup",
}  # fmt: skip


def places(people: int) -> np.ndarray:
    """A grid with two meters between neighbors, beside the sensor."""
    side = int(np.ceil(np.sqrt(people)))
    grid = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)
    return 3.0 + 2.0 * grid[:people].astype(float)


def turns_us(people: int, seconds: float, turn: int) -> dict[str, np.ndarray]:
    """Microseconds of a frame of each contender, the median of each turn; NaN where it sat out."""
    rng = np.random.default_rng(people)
    at = places(people)
    steps = {
        name: make(people)
        for name, make in CONTENDERS.items()
        if find_spec(MODULES.get(name, "tracker")) is not None
        and (name != "Stone Soup" or people <= STONE_SOUP_MOST)
    }
    spent_s = dict.fromkeys(CONTENDERS, 0.0)
    turns: dict[str, list[float]] = {name: [] for name in CONTENDERS}
    begin_s, frame = time.perf_counter(), 0
    while frame < FRAMES_LEAST or (
        time.perf_counter() - begin_s < seconds and frame < FRAMES_MOST
    ):
        measured = []
        for _ in range(turn):
            at = at + rng.normal(0.0, 0.01, at.shape)
            measured.append(Seen.at(at + rng.normal(0.0, STD_M, at.shape)))
        for name in rng.permutation(list(CONTENDERS)):
            times = []
            if name in steps and (frame < FRAMES_LEAST or spent_s[name] <= seconds / 4):
                for number, seen in enumerate(measured):
                    start = time.perf_counter()
                    steps[name](frame + number, seen)
                    times.append(time.perf_counter() - start)
            spent_s[name] += sum(times)
            # The first frames confirm everybody; they cost something else.
            counted = times[max(CONFIRMING - frame, 0) :]
            turns[name].append(1e6 * float(np.median(counted)) if counted else np.nan)
        frame += turn
    return {name: np.array(medians) for name, medians in turns.items()}


def told(number: float, digits: int) -> str:
    """For a table; a dash where nothing was measured."""
    return "-" if np.isnan(number) else f"{number:,.{digits}f}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--people", type=int, nargs="+", default=[1, 5, 20, 100, 500])
    parser.add_argument("--seconds", type=float, default=12.0, help="for each number of people")
    parser.add_argument("--turn", type=int, default=1, help="frames of one contender in a row")
    words = parser.parse_args()
    compile_tracker(print)
    warnings.filterwarnings("ignore", module="norfair|motpy|filterpy|stonesoup")
    cost, ratio = (Table(title=title, title_justify="left") for title in (
        "median microseconds of a frame", "times as much as `plain`"
    ))  # fmt: skip
    for table in (cost, ratio):
        for column in ("people", *CONTENDERS):
            table.add_column(column, justify="right")
    warnings.filterwarnings("ignore", "All-NaN", RuntimeWarning)
    for people in words.people:
        turns = turns_us(people, words.seconds, words.turn)
        plain = turns["plain"]
        cost.add_row(str(people), *(told(np.nanmedian(us), 0) for us in turns.values()))
        ratio.add_row(str(people), *(told(np.nanmedian(us / plain), 1) for us in turns.values()))
    console = Console()
    console.print(cost)
    console.print(ratio)


if __name__ == "__main__":
    main()
