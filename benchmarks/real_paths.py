"""Who follows real people better? Recorded paths of people, simulated sensors, several trackers.

    python benchmarks/real_paths.py [--windows 20] [--seed 7] [--jobs 2] [NAME ...]

Simulated rooms keep everybody in; here people come, cross one another's way and leave for good.
From each recording (a CSV with t_s, id, x_m, y_m) windows are drawn at random, with the robot
where many people pass. People raise their hands now and then; the sensors reach 8 m, miss people,
show some who are not there, and nothing behind somebody nearer. Customers within 7 m are scored.
All trackers get the same measurements; differences from the first are paired by window, their
intervals bootstrapped over the windows. A name is an association of the product, or `reference`,
the textbook's tracker, which takes bearings with ranges as points; without names all take part,
the default first. `gone` is how long those who left stay tracked in view of the sensors, `beyond`
how long the tracks that have gone beyond their reach.
"""

from __future__ import annotations

import argparse
import sys
import zlib
from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from itertools import takewhile
from pathlib import Path

import numpy as np
from _contestants import begin, contestants
from _paired import Rows, comparison, mean
from rich.console import Console
from rich.progress import track
from scipy.stats import chi2

from tracker import Config, Tracks
from tracker.containers import FloatArray, IntArray, Truth
from tracker.errors import SceneError
from tracker.evaluation.metrics.consistency import normalized_squared
from tracker.evaluation.metrics.gospa import gospa
from tracker.evaluation.metrics.identity import identity_switches
from tracker.evaluation.metrics.matching import distances, match_best
from tracker.evaluation.studies.workers import Processes, run_in_order
from tracker.evaluation.trials.people_scene import PeopleScene, draw_scene
from tracker.evaluation.trials.people_sensing import Sensed, sense
from tracker.evaluation.trials.scenario import PeopleScenario
from tracker.geometry import normalize_angle

RECORDINGS = Path(__file__).parents[1] / "../shared/data/trajectories"
REACH_M = 8.0  # of camera and laser
SCORED_M = 7.0  # people about to leave the sensors' reach do not count
CUTOFF_M = 1.0  # of GOSPA
COVERED = float(chi2.ppf(0.95, 2))
SENSORS = PeopleScenario(
    title="Real paths, simulated sensors.",
    area_m=(-REACH_M, REACH_M, -REACH_M, REACH_M),
    hand_up_s=(2.0, 6.0),
    hand_down_s=(3.0, 15.0),
    hand_offset_m=0.2,
    bearing_std_deg=2.0,
    range_missing_share=0.05,
    detection_probability=0.9,
    clutter_per_frame=0.05,
    scan_detection_probability=0.9,
    scan_clutter_per_frame=1.0,
)
PEOPLE_MIN = 3
TRIES = 100  # windows drawn before a recording counts as too empty
PLACES = 60  # of the robot that are looked at in each window
NEAR_M = (1.0, 6.0)  # so far off, as many people as possible pass
WALKED_THROUGH_M = 0.6  # nobody should come closer to the robot
LEFT_BEFORE_END_S = 10.0  # who leaves later is not watched for long enough

FIGURES = {
    "gospa_m": "GOSPA, m",
    "switches_per_min": "identity switches/min",
    "nees": "NEES (ideal: 2)",
    "covered_share": "inside the 95 % ellipse",
    "missed_share": "missed share",
    "false_tracks": "false tracks/frame",
    "gone_s": "gone: tracked, s",
    "beyond_s": "beyond: tracked, s",
}


def draw_window(scenario: PeopleScenario, rng: np.random.Generator) -> list[tuple[Truth, Sensed]]:
    """What is true and what is measured in a piece of a recording, frame by frame.

    Raises:
        SceneError: The recording cannot be used, or there are hardly any people in it.
    """
    for _ in range(TRIES):
        scene = place_robot(draw_scene(scenario, rng), scenario.field_of_view_deg, rng)
        if scene.truth.xy_m.shape[1] >= PEOPLE_MIN:
            frames = zip(scene.truth, sense(scenario, scene, rng), strict=True)
            return [(truth, in_reach(sensed)) for truth, sensed in frames]
    raise SceneError(f"{scenario.recording}: no piece with {PEOPLE_MIN} people near one place.")


def place_robot(
    scene: PeopleScene, field_of_view_deg: float, rng: np.random.Generator
) -> PeopleScene:
    """The same scene around a place that many people pass and nobody walks through.

    Whoever is beyond reach is not there.
    """
    truth = scene.truth
    seen = truth.xy_m[np.isfinite(truth.xy_m[..., 0])]
    if len(seen) == 0:
        return scene
    places = rng.uniform(*np.quantile(seen, [0.02, 0.98], axis=0), (PLACES, 2))
    distance = np.linalg.norm(seen[:, None] - places, axis=-1)
    worth = ((distance > NEAR_M[0]) & (distance < NEAR_M[1])).sum(axis=0)
    worth -= 20 * (distance < WALKED_THROUGH_M).sum(axis=0)
    xy = truth.xy_m - places[worth.argmax()]
    xy[~(np.linalg.norm(xy, axis=-1) < REACH_M)] = np.nan
    kept = np.isfinite(xy[..., 0]).any(axis=0)
    xy = xy[:, kept]
    bearing = normalize_angle(np.arctan2(xy[..., 1], xy[..., 0]) - scene.robot_yaw_rad[:, None])
    truth = replace(
        truth,
        id=truth.id[kept],
        xy_m=xy,
        hand_up=truth.hand_up[:, kept],
        in_view=np.abs(bearing) <= np.deg2rad(field_of_view_deg / 2),
    )
    return replace(scene, truth=truth, shown_xy_m=xy, hand_side=scene.hand_side[kept])


def in_reach(sensed: Sensed) -> Sensed:
    """No clutter from beyond the reach, and views that end there."""
    assert sensed.scan_view is not None
    return Sensed(
        sensed.measurements[~(sensed.measurements.values[:, 1] > REACH_M)],
        replace(sensed.view, range_max_m=REACH_M),
        replace(sensed.scan_view, range_max_m=REACH_M),
    )


class Scores:
    """One tracker's figures in one window, of customers (whose hand has been up) alone."""

    def __init__(self) -> None:
        self._pairs: dict[int, int] = {}  # of the last frame: each person's track
        self._called: set[int] = set()
        self._last_there: dict[int, tuple[int, float]] = {}  # each person's last frame, and range
        self._stamps_ns: list[int] = []
        self._sets: list[tuple[float, ...]] = []
        self._nees: list[FloatArray] = []
        self._track_of: list[dict[int, int]] = []  # in each frame, by person
        self._alone: list[dict[int, float]] = []  # ranges of tracks with nobody near, by id

    def add(self, truth: Truth, tracks: Tracks) -> None:
        """Compare one frame; tentative tracks do not count."""
        tracks = tracks[tracks.confirmed]
        self._called.update(truth.id[truth.hand_up & truth.in_view].tolist())
        called = np.isin(truth.id, list(self._called))
        person, person_xy, track_xy = truth.id[called], truth.xy_m[called], tracks.mean[:, :2]
        self._score_sets(tracks, person_xy)
        self._pairs = self._match(tracks.id, track_xy, person, person_xy)
        for one, range_m in zip(person.tolist(), np.linalg.norm(person_xy, axis=1), strict=True):
            self._last_there[one] = len(self._stamps_ns), range_m
        self._stamps_ns.append(truth.stamp_ns)
        self._track_of.append(self._pairs)
        apart = np.linalg.norm(track_xy[:, None] - truth.xy_m, axis=-1)
        alone = apart.min(axis=1, initial=np.inf) > CUTOFF_M
        range_m = np.linalg.norm(track_xy, axis=1)[alone]
        self._alone.append(dict(zip(tracks.id[alone].tolist(), range_m.tolist(), strict=True)))

    def _match(
        self, track_id: IntArray, track_xy: FloatArray, person: IntArray, person_xy: FloatArray
    ) -> dict[int, int]:
        """As the CLEAR MOT metrics: who stood for somebody near goes on, the rest by distance."""
        gain = np.maximum(CUTOFF_M - distances(track_xy[None], person_xy[None])[0], 0.0)
        last = np.array([self._pairs.get(one, 0) for one in person.tolist()], dtype=np.int64)
        kept = (track_id[:, None] == last) & (gain > 0.0)
        taken = kept.any(axis=1, keepdims=True) | kept.any(axis=0, keepdims=True)
        pairs = kept | match_best(np.where(taken, 0.0, gain)[None])[0]
        row, column = np.nonzero(pairs)
        return dict(zip(person[column].tolist(), track_id[row].tolist(), strict=True))

    def _score_sets(self, tracks: Tracks, person_xy: FloatArray) -> None:
        """The frame's best pairs; a pair counts where its person does."""
        track_xy = tracks.mean[:, :2]
        row, column = gospa(track_xy, person_xy, CUTOFF_M).pairs.T
        person_counts, track_counts = (
            np.linalg.norm(xy, axis=1) < SCORED_M for xy in (person_xy, track_xy)
        )
        missed = person_counts.sum() - person_counts[column].sum()
        false = track_counts.sum() - track_counts[row].sum()
        row, column = row[person_counts[column]], column[person_counts[column]]
        error = person_xy[column] - track_xy[row]
        alone = CUTOFF_M**2 / 2 * (missed + false)
        distance = float(np.sqrt((error**2).sum() + alone))
        self._sets.append((distance, missed, false, person_counts.sum()))
        self._nees.append(normalized_squared(error, tracks.covariance[row, :2, :2]))

    def row(self) -> dict[str, float]:
        """The window's figures; NaN where there was nothing to measure."""
        distance, missed, false, people = np.array(self._sets).T
        pairs = np.array([pair for frame in self._track_of for pair in frame.items()])
        person, track_id = pairs.reshape(-1, 2).T
        left = list(self._left())
        nees = np.concatenate(self._nees)
        minutes = (self._stamps_ns[-1] - self._stamps_ns[0]) / 60e9
        return {
            "gospa_m": float(distance.mean()),
            "switches_per_min": identity_switches(person, track_id) / minutes,
            "nees": mean(nees),
            "covered_share": mean(nees <= COVERED),
            "missed_share": float(missed.sum() / people.sum()) if people.any() else np.nan,
            "false_tracks": float(false.mean()),
            "gone_s": mean([in_reach_s for in_reach_s, _, range_m in left if range_m < SCORED_M]),
            "beyond_s": mean([beyond_s for _, beyond_s, _ in left if beyond_s > 0.0]),
        }

    def _left(self) -> Iterator[tuple[float, float, float]]:
        """Of everybody who was tracked and has left: how long the track went on, and the range.

        That is seconds within the sensors' reach, then beyond, until the track ended or came to
        stand for somebody else. Who left shortly before the window's end is passed over.
        """
        frames = len(self._stamps_ns)
        frame_s = (self._stamps_ns[-1] - self._stamps_ns[0]) / 1e9 / (frames - 1)
        for person, (frame, range_m) in self._last_there.items():
            track_id = self._track_of[frame].get(person)
            if track_id is None or (frames - frame) * frame_s < LEFT_BEFORE_END_S:
                continue
            later = (alone.get(track_id) for alone in self._alone[frame + 1 :])
            ranges = list(takewhile(lambda at_m: at_m is not None, later))
            in_reach = len(list(takewhile(lambda at_m: at_m < REACH_M, ranges)))
            yield in_reach * frame_s, (len(ranges) - in_reach) * frame_s, range_m


def score_window(
    scenario: PeopleScenario, names: tuple[str, ...], seed: int, window: int
) -> Rows | str:
    """Figures of each tracker, or why there are none."""
    assert scenario.recording is not None
    recording = zlib.crc32(Path(scenario.recording).name.encode())
    try:
        frames = draw_window(scenario, np.random.default_rng([seed, recording, window]))
    except SceneError as error:
        return str(error)
    rows = {}
    for name in names:
        follow, scores = begin(name, Config()), Scores()
        for truth, sensed in frames:
            scores.add(truth, follow(truth.stamp_ns, sensed))
        rows[name] = scores.row()
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(contestants()))
    parser.add_argument("--recordings", type=Path, default=RECORDINGS, help="folder of CSV files")
    parser.add_argument("--windows", type=int, default=2, help="from each recording")
    parser.add_argument("--seconds", type=float, default=45.0, help="of a window")
    parser.add_argument("--field-of-view-deg", type=float, default=360.0, help="of the camera")
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--jobs", type=int, default=1, help="processes")
    words = parser.parse_args()
    names = tuple(dict.fromkeys(words.names)) or contestants()
    if unknown := [name for name in names if name not in contestants()]:
        parser.error(f"unknown: {', '.join(unknown)}; there are {', '.join(contestants())}.")
    recordings = sorted(words.recordings.glob("*.csv"))
    if not recordings:
        print(f"{words.recordings}: no recorded paths (*.csv) there; nothing was measured.")
        return
    sensors = replace(SENSORS, duration_s=words.seconds, field_of_view_deg=words.field_of_view_deg)
    units = [
        partial(score_window, replace(sensors, recording=str(file)), names, words.seed, window)
        for file in recordings
        for window in range(words.windows)
    ]
    to_stderr = Console(stderr=True)
    with Processes(words.jobs) if words.jobs > 1 else nullcontext() as crew:
        results = list(track(run_in_order(units, crew), "windows", len(units), console=to_stderr))
    for reason in dict.fromkeys(result for result in results if isinstance(result, str)):
        print(reason, file=sys.stderr)
    rows = [result for result in results if not isinstance(result, str)]
    if rows:
        sets = ", ".join(file.stem for file in recordings)
        title = f"{len(rows)} windows of {words.seconds:g} s ({sets}), seed {words.seed}"
        Console().print(comparison(title, FIGURES, rows))


if __name__ == "__main__":
    main()
