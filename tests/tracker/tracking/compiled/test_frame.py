"""The compiled frame is held to what NumPy gives: same people, same numbers."""

from dataclasses import replace

import numpy as np
import pytest

from tracker import Config, Measurements, PersonTracker
from tracker.tracking import View

pytest.importorskip("numba", reason="numba (the extra fast) is not installed")

CONFIGS = {
    "default": Config(),
    "plain": Config(motion="cv", association="hungarian", outlier_dof=0.0),
    "m of n": Config(confirmation="m_of_n", association="hungarian"),
    "hand bias": Config(hand_bias_duration_s=1.0, confirmation="existence"),
    "one mode, jointly": Config(motion="cv", association="jpda"),
}
PEOPLE = 6


def room(seed, frames=60):
    """Six walkers, a robot that turns, missing ranges, outliers, clutter and odd intervals."""
    rng = np.random.default_rng(seed)
    at, velocity = rng.uniform(-4, 4, (PEOPLE, 2)), rng.normal(0, 0.6, (PEOPLE, 2))
    stamp_ns = 0
    for number in range(frames):
        stamp_ns += int(rng.integers(1, 3)) * 10**8
        at = at + 0.1 * velocity
        pose = np.array([0.01 * number, 0.0, 0.02 * number])
        offset = at - pose[:2]
        bearing = np.arctan2(offset[:, 1], offset[:, 0]) - pose[2] + rng.normal(0, 0.03, PEOPLE)
        range_m = np.hypot(*offset.T) + rng.normal(0, 0.1, PEOPLE)
        range_m += np.where(rng.random(PEOPLE) < 0.1, 3.0, 0.0)
        range_m[rng.random(PEOPLE) < 0.2] = np.nan
        seen = rng.random(PEOPLE) < 0.7
        claims = Measurements.polar(
            bearing,
            range_m,
            0.03,
            0.1,
            pose,
            raised=rng.random(PEOPLE) < 0.6,
            hand=np.where(rng.random(PEOPLE) < 0.8, np.arange(PEOPLE), -1),
            person=np.where(rng.random(PEOPLE) < 0.5, np.arange(PEOPLE) // 2, -1),
        )[seen]
        clutter = rng.uniform(-5, 5, (rng.integers(0, 3), 2))
        raised = rng.random(len(clutter)) < 0.3
        noise = 0.1**2 * np.eye(2)
        claims = Measurements.concatenate(
            claims, Measurements.cartesian(clutter, noise, raised=raised)
        )
        if number % 7 == 0:
            doubt = np.tile(np.diag([0.01, 0.01, 0.001]), (len(claims), 1, 1))
            claims = replace(claims, sensor_pose_covariance=doubt)
        views = {
            "view": View(pose, 1.5, 8.0) if number % 3 else None,
            "scan_view": View(pose, 4.0) if number % 2 else None,
        }
        yield stamp_ns, claims, pose[:2], views


@pytest.mark.parametrize("config", CONFIGS.values(), ids=CONFIGS)
@pytest.mark.parametrize("seed", range(3))
def test_a_room_full_of_people_is_tracked_to_the_same_numbers(config, seed):
    loops, arrays = PersonTracker(config), PersonTracker(config, compiled=False)
    for stamp_ns, claims, robot_xy_m, views in room(seed):
        mine = loops.step(stamp_ns, claims, robot_xy_m, **views)
        theirs = arrays.step(stamp_ns, claims, robot_xy_m, **views)
        assert_same(mine, theirs)
        np.testing.assert_allclose(loops.positions_m, arrays.positions_m, atol=1e-9)


def assert_same(mine, theirs):
    for name in ("id", "confirmed", "raised", "raised_since_ns", "hand"):
        np.testing.assert_array_equal(getattr(mine, name), getattr(theirs, name), name)
    for name in ("mean", "covariance", "existence", "age_s", "unseen_s"):
        one, other = getattr(mine, name), getattr(theirs, name)
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-9, err_msg=name)
    assert mine.selected_id == theirs.selected_id


def test_people_changed_between_two_frames_are_those_the_next_frame_starts_from():
    loops, arrays = PersonTracker(), PersonTracker(compiled=False)
    changes = {
        15: lambda tracker: setattr(tracker, "config", Config(motion="cv", confirm_window=9)),
        30: PersonTracker.reset,
        40: lambda tracker: setattr(tracker, "config", Config(delete_after_s=0.5)),
    }
    for number, (stamp_ns, claims, robot_xy_m, views) in enumerate(room(3)):
        for tracker in (loops, arrays):
            changes.get(number, lambda tracker: None)(tracker)
        assert_same(
            loops.step(stamp_ns, claims, robot_xy_m, **views),
            arrays.step(stamp_ns, claims, robot_xy_m, **views),
        )


def test_however_arrays_are_laid_out_nothing_is_compiled_again():
    from tracker.tracking.compiled.kernel import track_frame

    tracker = PersonTracker()
    for number, (order, count) in enumerate([("C", 1), ("F", 6), ("F", 0), ("C", 6)]):
        values = np.asarray(np.arange(2.0 * count).reshape(count, 2), order=order)
        noise = np.asarray(np.tile(0.01 * np.eye(2), (count, 1, 1)), order=order)
        tracker.step(number * 10**8, Measurements.cartesian(values, noise))
    assert len(track_frame.signatures) == 1
