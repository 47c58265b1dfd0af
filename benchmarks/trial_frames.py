"""How many trial-frames of Monte Carlo in a second? The product's arrays beside loops of filters.

    python benchmarks/trial_frames.py [--people 5 20] [--trials 250] [--seconds 15]

A trial-frame is one frame of one trial with so many people. Three kinds of work:

  filter       predict and update of everybody, whose measurement is whose being known
  association  predict, gate, optimal assignment and update of people who are known
  tracker      the whole of it: association, and a life cycle that finds out who is there

The product's filter and its association take all trials at once, as studies do. Its whole tracker,
filterpy (linear, positions) and Stone Soup (extended, bearing and range) run one trial, as they
would run each of many. Contenders take turns, so that other work slows all alike; medians.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from datetime import timedelta

import numpy as np
from _stone_soup import START, StoneSoup
from rich.console import Console
from rich.table import Table
from scipy.optimize import linear_sum_assignment
from stonesoup.types.detection import Detection
from stonesoup.types.hypothesis import SingleHypothesis
from stonesoup.types.state import GaussianState
from stonesoup.types.track import Track

from tracker import Config, Measurements, PersonTracker
from tracker.containers.arrays import frozen
from tracker.evaluation.trials.filter_loop import filter_trials
from tracker.evaluation.trials.known_people_loop import follow
from tracker.evaluation.trials.machine_code import machine_code
from tracker.tracking.prediction.motion import walk
from tracker.tracking.sensing.claims import claims_of

PERIOD_S, BEARING_STD_RAD, RANGE_STD_M, DENSITY = 0.1, 0.01, 0.05, 0.3
START_COVARIANCE = np.diag([0.01, 0.01, 0.25, 0.25])
FRAMES = 30  # of a turn, as many as a trial of `known-people` has
#: Number of the frame and positions, (B, N, 2); of the product's batches that of the first of
#: FRAMES, and their bearings and ranges, (FRAMES, B, N, 2).
Step = Callable[[int, np.ndarray], None]


def polar(xy: np.ndarray, sensor_pose: np.ndarray) -> Measurements:
    """Exact measurements of positions (K, 2) from sensors (K, 3) without turn."""
    offset = xy - sensor_pose[:, :2]
    bearing, range_m = np.arctan2(offset[:, 1], offset[:, 0]), np.hypot(*offset.T)
    return Measurements.polar(bearing, range_m, BEARING_STD_RAD, RANGE_STD_M, sensor_pose)


def places(people: int) -> np.ndarray:
    """Where they stand, shape (N, 2): in a square, 2 m apart."""
    side = int(np.ceil(np.sqrt(people)))
    return 3.0 + 2.0 * np.stack(np.divmod(np.arange(people), side), axis=-1)


def product_filter(trials: int, people: int) -> Step:
    count = trials * people
    state = {"mean": np.zeros((count, 4)), "covariance": np.tile(np.eye(4), (count, 1, 1))}
    state["mean"][:, :2] = np.tile(places(people), (trials, 1))
    motion, filtered = walk(PERIOD_S, DENSITY), machine_code(filter_trials)
    claims = claims_of(polar(np.ones((count, 2)), np.zeros((count, 3))))

    def step(frame: int, values: np.ndarray) -> None:
        flat = values.reshape(len(values), -1, 2)
        given = map(frozen, (state["mean"], state["covariance"], flat))
        means, covariances = filtered(*given, claims, motion, 0.0)
        state["mean"], state["covariance"] = means[-1], covariances[-1]

    return step


def product_association(trials: int, people: int) -> Step:
    config = Config().replace(acceleration_density=DENSITY)
    state = {
        "mean": np.tile(np.hstack([places(people), np.zeros((people, 2))]), (trials, 1, 1)),
        "covariance": np.tile(START_COVARIANCE, (trials, people, 1, 1)),
    }

    def step(frame: int, values: np.ndarray) -> None:
        given = state["mean"], state["covariance"], values.swapaxes(0, 1)
        followed = follow(*given, (BEARING_STD_RAD, RANGE_STD_M), PERIOD_S, config)
        state["mean"], state["covariance"] = followed.mean[:, -1], followed.covariance
        # The gate turns one true measurement in a hundred away.
        assert np.count_nonzero(followed.row >= 0) > 0.9 * followed.row.size

    return step


def product_tracker(trials: int, people: int) -> Step:
    tracker = PersonTracker(Config().replace(motion="cv", outlier_dof=0.0))
    sensors = np.zeros((people, 3))

    def step(frame: int, xy: np.ndarray) -> None:
        tracker.step(round(frame * PERIOD_S * 1e9), polar(xy[0], sensors))

    return step


def filterpy_filters(people: int) -> list:
    from filterpy.common import Q_continuous_white_noise
    from filterpy.kalman import KalmanFilter

    filters = []
    for _ in range(people):
        item = KalmanFilter(4, 2)
        item.F = np.eye(4) + PERIOD_S * np.eye(4, k=2)
        item.H, item.R = np.eye(2, 4), RANGE_STD_M**2 * np.eye(2)
        item.Q = Q_continuous_white_noise(2, PERIOD_S, DENSITY, 2, order_by_dim=False)
        filters.append(item)
    return filters


def filterpy_filter(trials: int, people: int) -> Step:
    filters = filterpy_filters(people)

    def step(frame: int, xy: np.ndarray) -> None:
        for item, z in zip(filters, xy[0], strict=True):
            item.predict()
            item.update(z)

    return step


def filterpy_association(trials: int, people: int) -> Step:
    filters = filterpy_filters(people)

    def step(frame: int, xy: np.ndarray) -> None:
        if frame == 0:
            for item, z in zip(filters, xy[0], strict=True):
                item.x[:2, 0] = z
        for item in filters:
            item.predict()
        expected = np.array([item.x[:2, 0] for item in filters])
        distance = np.linalg.norm(expected[:, None] - xy[0][None], axis=-1)
        for row, column in zip(*linear_sum_assignment(distance), strict=True):
            filters[row].update(xy[0][column])

    return step


def stone_soup_filter(trials: int, people: int) -> Step:
    peer = StoneSoup((BEARING_STD_RAD, RANGE_STD_M), acceleration_density=DENSITY)
    states: list[GaussianState] = []

    def step(frame: int, xy: np.ndarray) -> None:
        now = START + timedelta(seconds=frame * PERIOD_S)
        if frame == 0:
            for x, y in xy[0]:
                states.append(GaussianState([[x], [0], [y], [0]], np.eye(4), now))
        for row, (x, y) in enumerate(xy[0]):
            z = np.array([[np.arctan2(y, x)], [np.hypot(x, y)]])
            prediction = peer.predictor.predict(states[row], timestamp=now)
            hypothesis = SingleHypothesis(prediction, Detection(z, now, peer.sensor))
            states[row] = peer.updater.update(hypothesis)

    return step


def stone_soup_association(trials: int, people: int) -> Step:
    peer = StoneSoup((BEARING_STD_RAD, RANGE_STD_M), "gnn", acceleration_density=DENSITY)
    order = [0, 2, 1, 3]  # x, y, vx, vy as x, vx, y, vy
    tracks: list[Track] = []

    def step(frame: int, xy: np.ndarray) -> None:
        now = START + timedelta(seconds=frame * PERIOD_S)
        if frame == 0:
            covariance = START_COVARIANCE[np.ix_(order, order)]
            tracks.extend(
                Track([GaussianState([[x], [0], [y], [0]], covariance, now)]) for x, y in xy[0]
            )
        detections = {
            Detection(np.array([[np.arctan2(y, x)], [np.hypot(x, y)]]), now, peer.sensor)
            for x, y in xy[0]
        }
        for track, hypothesis in peer.associator.associate(tracks, detections, now).items():
            track.append(peer.updater.update(hypothesis) if hypothesis else hypothesis.prediction)

    return step


def stone_soup_tracker(trials: int, people: int) -> Step:
    peer = StoneSoup((BEARING_STD_RAD, RANGE_STD_M), "gnn", acceleration_density=DENSITY)

    def step(frame: int, xy: np.ndarray) -> None:
        peer.step(round(frame * PERIOD_S * 1e9), polar(xy[0], np.zeros((len(xy[0]), 3))))

    return step


WORK: dict[str, dict[str, Callable[[int, int], Step]]] = {
    "filter": {
        "product": product_filter,
        "filterpy": filterpy_filter,
        "Stone Soup": stone_soup_filter,
    },
    "association": {
        "product": product_association,
        "filterpy": filterpy_association,
        "Stone Soup": stone_soup_association,
    },
    "tracker": {"product": product_tracker, "Stone Soup": stone_soup_tracker},
}
CONTENDERS = ("product", "filterpy", "Stone Soup")


def rates(work: str, people: int, trials: int, seconds: float) -> dict[str, float]:
    """Trial-frames a second of each contender."""
    rng = np.random.default_rng(people)
    at = np.broadcast_to(places(people), (trials, people, 2))
    steps = {name: make(trials, people) for name, make in WORK[work].items()}
    spent: dict[str, list[float]] = {name: [] for name in steps}
    begin_s, frame = time.perf_counter(), 0
    while frame < 3 * FRAMES or (time.perf_counter() - begin_s < seconds and frame < 20 * FRAMES):
        measured = at + rng.normal(0.0, 0.03, (FRAMES, *at.shape))
        x, y = np.moveaxis(measured, -1, 0)
        values = np.stack([np.arctan2(y, x), np.hypot(x, y)], axis=-1)
        for name, step in steps.items():
            is_batch = name == "product" and work != "tracker"
            start = time.perf_counter()
            if is_batch:
                step(frame, values)
            else:
                for number, xy in enumerate(measured):
                    step(frame + number, xy)
            taken_s = (time.perf_counter() - start) / FRAMES
            spent[name].append(taken_s / (trials if is_batch else 1))
        frame += FRAMES
    return {name: 1.0 / float(np.median(times[1:])) for name, times in spent.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--people", type=int, nargs="+", default=[5, 20])
    parser.add_argument("--trials", type=int, default=250)
    parser.add_argument("--seconds", type=float, default=15.0, help="for each line")
    words = parser.parse_args()
    table = Table(title=f"trial-frames a second, {words.trials} trials", title_justify="left")
    for column in ("work", "people", *CONTENDERS, "product / S. S."):
        table.add_column(column, justify="right")
    for work in WORK:
        for people in words.people:
            found = rates(work, people, words.trials, words.seconds)
            numbers = [found.get(name, np.nan) for name in CONTENDERS]
            numbers.append(found["product"] / found["Stone Soup"])
            told = ["-" if np.isnan(number) else f"{number:,.0f}" for number in numbers]
            table.add_row(work, str(people), *told)
    Console().print(table)


if __name__ == "__main__":
    main()
