"""What truly happened in one trial: paths, raised hands, the robot's turns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.containers import BoolArray, FloatArray
from tracker.evaluation.metrics.frames import TruthFrames
from tracker.evaluation.trials.paths import recorded, walks
from tracker.evaluation.trials.scenario import PeopleScenario
from tracker.geometry import normalize_angle


@dataclass(frozen=True, slots=True, eq=False)
class PeopleScene:
    """Truth of one trial, frame by frame.

    Attributes:
        truth: Who is where, whose hand is up, who stands in the camera's field of view.
        shown_xy_m: Shape (T, P, 2): where, as old as the latency makes what the sensors show.
        hand_side: Shape (P,): -1 or 1, on which side of the body the hand is.
        robot_yaw_rad: Shape (T,), of the robot at the origin ...
        shown_yaw_rad: ... and when the sensors looked.
    """

    truth: TruthFrames
    shown_xy_m: FloatArray
    hand_side: FloatArray
    robot_yaw_rad: FloatArray
    shown_yaw_rad: FloatArray


def draw_scene(scenario: PeopleScenario, rng: np.random.Generator) -> PeopleScene:
    """Let people walk and raise their hands.

    Args:
        scenario: What is wanted.
        rng: All randomness.

    Raises:
        SceneError: The recording of paths cannot be used.
    """
    frames = max(1, round(scenario.duration_s * scenario.rate_hz))
    stamps_s = 1.0 + np.arange(frames) / scenario.rate_hz
    # Twice the stamps: when it counts, and when it was seen.
    both_s = np.unique(np.concatenate([stamps_s, stamps_s - scenario.latency_s]))
    if scenario.recording is None:
        people = int(rng.integers(scenario.people[0], scenario.people[1] + 1))
        paths = walks(rng, both_s, people, scenario.area_m, scenario.pause_s)
    else:
        paths = recorded(rng, both_s, scenario.recording)
    xy = paths[np.searchsorted(both_s, stamps_s)]
    shown_xy = paths[np.searchsorted(both_s, stamps_s - scenario.latency_s)]
    people = xy.shape[1]
    yaw, shown_yaw = (
        np.deg2rad(scenario.turn_amplitude_deg) * np.sin(2 * np.pi * at_s / scenario.turn_period_s)
        for at_s in (stamps_s, stamps_s - scenario.latency_s)
    )
    bearing = normalize_angle(np.arctan2(xy[..., 1], xy[..., 0]) - yaw[:, None])
    truth = TruthFrames(
        stamps_ns=np.round(stamps_s * 1e9).astype(np.int64),
        id=np.arange(people),
        xy_m=xy,
        hand_up=_hands(scenario, rng, stamps_s, people),
        in_view=np.abs(bearing) <= np.deg2rad(scenario.field_of_view_deg / 2),
    )
    hand_side = rng.choice([-1.0, 1.0], people)
    return PeopleScene(truth, shown_xy, hand_side, yaw, shown_yaw)


def _hands(
    scenario: PeopleScenario, rng: np.random.Generator, stamps_s: FloatArray, people: int
) -> BoolArray:
    """Up and down by turns, each for a time drawn evenly; shape (T, P)."""
    if np.isinf(scenario.hand_up_s[0]):
        return np.ones((len(stamps_s), people), dtype=bool)
    up = np.empty((len(stamps_s), people), dtype=bool)
    for person in range(people):
        # Down at first, for part of a pause, so that not everybody calls at once.
        changes = [float(stamps_s[0]) + rng.uniform(0.0, scenario.hand_down_s[0])]
        while changes[-1] < stamps_s[-1]:
            changes.append(changes[-1] + rng.uniform(*scenario.hand_up_s))
            changes.append(changes[-1] + rng.uniform(*scenario.hand_down_s))
        up[:, person] = np.searchsorted(changes, stamps_s, side="right") % 2 == 1
    return up
