"""The textbook's tracker and the product, in its plain configuration, are the same tracker."""

import numpy as np
import pytest

from tracker import Config, Measurements, PersonTracker
from tracker.containers.as_positions import as_positions
from tracker.errors import ClockError, MeasurementError
from tracker.tracking.reference import ReferenceTracker

PLAIN = Config().replace(
    motion="cv",
    association="hungarian",
    outlier_dof=0.0,
    innovation_floor_m=0.0,
    same_person_distance_m=0.0,
    mature_detections=1,
)
NOISE = 0.08**2 * np.eye(2)
PERIOD_NS = 100_000_000


def raised_at(*points):
    return Measurements.cartesian(np.array(points, float).reshape(-1, 2), NOISE)


def seen_at(*points):
    return Measurements.cartesian(np.array(points, float).reshape(-1, 2), NOISE, raised=False)


def draw_frames(rng, people, detection_probability, clutter, frames=80):
    """Hands of people who come, walk through one another and leave, and hands of nobody."""
    stamp_ns = 1_700_000_000_000_000_000
    first = rng.integers(-30, frames, people)
    last = first + rng.integers(5, 60, people)
    start, velocity = rng.uniform(-4, 4, (people, 2)), rng.normal(0, 0.8, (people, 2))
    for frame in range(frames):
        stamp_ns += int(rng.choice([0, 50, 100, 100, 100, 300])) * 1_000_000
        seconds = 0.1 * (frame - first)[:, None]
        there = (first <= frame) & (frame < last) & (rng.random(people) < detection_probability)
        nobody = rng.uniform(-6, 6, (rng.poisson(clutter), 2))
        xy = np.concatenate([(start + seconds * velocity)[there], nobody])
        root = rng.uniform(-0.1, 0.1, (len(xy), 2, 2))
        covariance = root @ np.swapaxes(root, 1, 2) + 0.003 * np.eye(2)
        noise = [rng.multivariate_normal((0.0, 0.0), each) for each in covariance]
        xy = xy + np.reshape(noise, (len(xy), 2))
        order = rng.permutation(len(xy))
        yield stamp_ns, Measurements.cartesian(xy[order], covariance[order])


def assert_same_tracks(config, frames):
    """Run both, and say how many customers were compared."""
    product, reference = PersonTracker(config), ReferenceTracker(config)
    compared = 0
    for stamp_ns, measurements in frames:
        those, these = product.step(stamp_ns, measurements), reference.step(stamp_ns, measurements)
        for name in ("id", "raised", "confirmed", "raised_since_ns"):
            assert getattr(these, name).tolist() == getattr(those, name).tolist(), name
        for name in ("mean", "covariance", "age_s", "unseen_s"):
            ours, theirs = getattr(these, name), getattr(those, name)
            np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-9, err_msg=name)
        compared += len(these)
    return compared


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(
    ("people", "detection_probability", "clutter"),
    [(1, 0.9, 0.0), (5, 0.95, 0.2), (5, 0.6, 1.0), (15, 0.8, 2.0)],
    ids=["alone", "few", "often missed among clutter", "crowd"],
)
def test_people_who_come_cross_and_leave_are_the_same_customers_to_both(
    seed, people, detection_probability, clutter
):
    rng = np.random.default_rng([seed, people])
    frames = draw_frames(rng, people, detection_probability, clutter)
    assert assert_same_tracks(PLAIN, frames) > 0


@pytest.mark.parametrize("seed", range(12))
def test_both_follow_the_parameters(seed):
    rng = np.random.default_rng([seed, 99])
    window = int(rng.integers(1, 7))
    config = PLAIN.replace(
        acceleration_density=rng.uniform(0.1, 5.0),
        gate_probability=rng.choice([0.9, 0.99, 0.9999]),
        detection_probability=rng.uniform(0.3, 0.98),
        newcomer_density=10 ** rng.uniform(-4, -1),
        initial_speed_std_mps=rng.uniform(0.2, 2.0),
        raise_streak=int(rng.integers(1, 5)),
        lower_streak=int(rng.integers(1, 5)),
        confirm_window=window,
        confirm_detections=int(rng.integers(1, window + 1)),
        delete_after_s=rng.choice([0.2, 1.0, 3.0]),
    )
    assert_same_tracks(config, draw_frames(rng, 6, 0.8, 0.5))


def test_customers_whose_hands_are_down_are_sustained_alike():
    rng = np.random.default_rng(5)
    places = np.array([(2.0, 2.0), (5.0, -2.0), (4.0, 3.0)])

    def frames():
        for frame in range(100):
            measured = places + 0.01 * frame + 0.08 * rng.standard_normal((3, 2))
            up = (frame // 20 + np.arange(3)) % 2 == 0 if frame > 5 else np.ones(3, dtype=bool)
            yield frame * PERIOD_NS, Measurements.cartesian(measured, NOISE, raised=up)

    assert assert_same_tracks(PLAIN, frames()) == 300


def test_a_stamp_before_the_last_one_forgets_everybody_and_no_identity():
    tracker = ReferenceTracker()
    tracker.step(5 * PERIOD_NS, raised_at((1, 2)))
    tracks = tracker.step(4 * PERIOD_NS, raised_at((1, 2)))
    assert tracks.id.tolist() == [2]
    assert tracks.age_s.tolist() == [0.0]


def test_positions_without_a_raised_hand_make_no_customer():
    assert len(ReferenceTracker().step(0, seen_at((1, 2)))) == 0


def test_bearings_are_refused_with_what_to_do():
    bearings = Measurements.polar([0.1], [np.nan], 0.02, 0.08)
    both = Measurements.concatenate(raised_at((1, 2)), bearings)
    with pytest.raises(MeasurementError, match=r"1 of 2 .* `as_positions`"):
        ReferenceTracker().step(0, both)


def test_bearings_with_ranges_become_points_with_their_noise():
    rng = np.random.default_rng(2)
    pose, bearing, range_m = np.array([1.0, -2.0, 0.7]), 0.4, 5.0
    measured = Measurements.polar([bearing, 0.1], [range_m, np.nan], 0.01, 0.03, pose)
    points = as_positions(measured)
    angles = pose[2] + bearing + 0.01 * rng.standard_normal(100_000)
    ranges = range_m + 0.03 * rng.standard_normal(100_000)
    cloud = pose[:2] + ranges[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    assert len(points) == 1
    assert points.values[0] == pytest.approx(cloud.mean(axis=0), abs=1e-3)
    np.testing.assert_allclose(points.covariance[0], np.cov(cloud.T), rtol=0.03, atol=2e-5)


def test_a_negative_stamp_is_refused():
    with pytest.raises(ClockError):
        ReferenceTracker().step(-1, raised_at((1, 2)))
