"""Machine code and Python give the same people and the same numbers, whatever comes."""

from dataclasses import replace

import numpy as np
import pytest

from tracker import Config, Measurements, PersonTracker
from tracker.tracking import View
from tracker.tracking.machine_frame import machine

#: What each parameter may be in a trial.
CHOICES = {
    "motion": ("imm", "cv"),
    "association": ("pda", "jpda", "hungarian"),
    "outlier_dof": (0.0, 4.0, 1.5),
    "gate_probability": (0.9999, 0.99),
    "innovation_floor_m": (0.05, 0.0),
    "detection_probability": (0.9, 0.6),
    "confirmation": ("m_of_n", "existence"),
    "same_person_distance_m": (0.5, 0.3),
    "newcomer_density": (0.005, 0.05),
    "acceleration_density": (0.6, 0.2, 2.0),
    "selection": ("nearest", "first", "newest"),
    "delete_after_s": (3.0, 1.0),
    "forget_after_s": (60.0, 5.0),
}
FRAMES = 40


@pytest.fixture(autouse=True)
def needs_machine_code(machine_code):
    if machine() is None:
        pytest.skip("numba is not installed, or told not to compile")


def random_config(rng):
    chosen = {name: values[rng.integers(len(values))] for name, values in CHOICES.items()}
    return Config(**chosen)


class Room:
    """Walkers whom a camera, a scan, anchors and clutter show, frame by frame."""

    def __init__(self, rng):
        self.rng, self.people = rng, int(rng.integers(1, 9))
        self.at_m = rng.uniform(-4, 4, (self.people, 2))
        self.speed_mps = rng.normal(0, 0.5, (self.people, 2))
        self.far_m = 1e5 if rng.random() < 0.1 else 0.0
        self.has_scan, self.is_doubted = rng.random(2) < (0.6, 0.5)
        self.kind = rng.choice(["camera", "camera", "positions", "anchors"])

    def step(self, number, dt_s):
        """Measurements of one frame, and where the sensors are."""
        self.at_m = self.at_m + dt_s * self.speed_mps
        turned = self.rng.normal(0, 0.6, (self.people, 2))
        sets_off = self.rng.random((self.people, 1)) < 0.03
        self.speed_mps = np.where(sets_off, turned, self.speed_mps)
        about = np.array([self.far_m, -self.far_m, 0.02 * number])
        pose = about + self.rng.normal(0, 0.02, 3)
        is_up = (np.arange(self.people) + number // 25) % 3 != 0
        parts = [self.sensed(pose, is_up & (self.rng.random(self.people) < 0.7), True)]
        if self.has_scan:
            parts.append(self.sensed(pose, self.rng.random(self.people) < 0.85, False))
        if self.rng.random() < 0.05:
            parts = [Measurements.none()]
        return Measurements.concatenate(*parts), pose

    def sensed(self, pose, seen, raised):
        clutter_m = self.rng.uniform(-5, 5, (self.rng.poisson(0.5), 2))
        off_m = np.concatenate([self.at_m[seen], clutter_m])
        count, common = len(off_m), {"raised": raised, "hand": -1}
        body = np.where(self.rng.random(count) < 0.2, 0, np.arange(count))
        tag = np.where(self.rng.random(count) < 0.1, np.arange(count), -1)
        common |= {"person": body, "identity": tag}
        if raised and self.kind == "positions":
            at_m = pose[:2] + off_m + self.rng.normal(0, 0.1, off_m.shape)
            return Measurements.cartesian(at_m, [[0.02, 0.004], [0.004, 0.03]], **common)
        bearing = np.arctan2(off_m[:, 1], off_m[:, 0]) - pose[2] + self.rng.normal(0, 0.03, count)
        range_m = np.abs(np.hypot(*off_m.T) + self.rng.normal(0, 0.08, count))
        range_m += np.where(self.rng.random(count) < 0.05, 2.0, 0.0)
        if raised:
            common["hand"] = np.arange(count)
            lost = range_m if self.kind == "anchors" else np.nan
            range_m = np.where(self.rng.random(count) < 0.3, lost, range_m)
            if self.kind == "anchors":
                bearing = np.where(self.rng.random(count) < 0.4, np.nan, bearing)
        measured = Measurements.polar(bearing, range_m, 0.04, 0.08, pose, **common)
        if self.is_doubted:
            doubt = np.broadcast_to(np.diag([1e-3, 1e-3, 1e-4]), (count, 3, 3))
            measured = replace(measured, sensor_pose_covariance=doubt)
        return measured


def assert_same(mine, theirs, atol=1e-9):
    for name in ("id", "confirmed", "raised", "raised_since_ns", "hand", "refused", "selected_id"):
        np.testing.assert_array_equal(getattr(mine, name), getattr(theirs, name), name)
    for name in ("mean", "covariance", "existence", "age_s", "unseen_s"):
        one, other = getattr(mine, name), getattr(theirs, name)
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=atol, err_msg=name)


@pytest.mark.parametrize("seed", range(25))
def test_a_room_full_of_people_is_tracked_to_the_same_numbers(seed):
    rng = np.random.default_rng(seed)
    config, room = random_config(rng), Room(rng)
    compiled, plain = PersonTracker(config), PersonTracker(config, compiled=False)
    changes = {
        15: lambda tracker: setattr(tracker, "config", random_config(np.random.default_rng(seed))),
        25: lambda tracker: tracker.doubt(np.array([0.1, 0.05, 0.02]), 0.5),
        30: PersonTracker.lower_hands,
        35: PersonTracker.reset,
    }
    happens = {number for number in changes if rng.random() < 0.3}
    stamp_ns = 10**9
    for number in range(FRAMES):
        dt_s = float(rng.choice([0.1, 0.1, 0.1, 0.05, 0.5, 0.0]))
        stamp_ns += round(dt_s * 1e9)
        measured, pose = room.step(number, dt_s)
        given = {
            "view": View(pose, np.deg2rad(120), 8.0) if rng.random() < 0.7 else None,
            "scan_view": View(pose, 2 * np.pi, 8.0) if room.has_scan else None,
            "camera_looked": bool(rng.random() < 0.9),
        }
        if rng.random() < 0.2:
            customers = compiled.people.customer
            given["likeness"] = rng.normal(size=(np.count_nonzero(customers), len(measured)))
        both = [
            tracker.step(stamp_ns, measured, pose[:2], **given) for tracker in (compiled, plain)
        ]
        rounding = 1e-9 if room.far_m == 0.0 else 1e-6  # of places, which speeds are made of
        assert_same(*both, rounding)
        assert_same(compiled.people, plain.people, rounding)
        for tracker in (compiled, plain):
            if number in happens:
                changes[number](tracker)


def test_the_rooms_are_not_empty():
    rng = np.random.default_rng(1)
    config, room = random_config(rng), Room(rng)
    tracker = PersonTracker(config)
    most = max(
        len(tracker.step(number * 10**8, room.step(number, 0.1)[0])) for number in range(FRAMES)
    )
    assert most > 1
