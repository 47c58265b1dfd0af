"""People outlive a change of `motion` and of `confirm_window`."""

import numpy as np
import pytest

from tracker import Config, Measurements
from tracker.tracking.life_cycle.renewal import Frame
from tracker.tracking.reconfiguration import under


@pytest.fixture
def frame(people_of, merged):
    rng = np.random.default_rng(3)
    root = rng.normal(size=(2, 3, 4, 4))
    people = people_of(rng.normal(size=(2, 3, 4)), root @ np.swapaxes(root, -1, -2), window=5)
    people.recent[:] = rng.random((3, 5)) < 0.5
    mean, covariance = merged(people)
    return Frame(people, mean[None], covariance[None], 4, -1, 0)


def test_the_same_arrays_serve_under_other_numbers(frame):
    people = under(frame, Config(motion="imm", confirm_window=5, delete_after_s=9.0)).people
    assert all(now is then for now, then in zip(people, frame.people, strict=True))


def test_one_gaussian_with_their_moments_stands_for_two_modes(frame):
    changed = under(frame, Config(motion="cv", confirm_window=5))
    assert (changed.people.weight == 1.0).all()
    assert (changed.people.mean == frame.mean).all()
    assert (changed.people.covariance == frame.covariance).all()
    changed.people.mean[:] = 0.0
    assert (frame.mean != 0.0).all()


def test_who_had_one_mode_walks_or_stands_from_now_on(frame):
    one = under(frame, Config(motion="cv", confirm_window=5))
    people = under(one, Config(motion="imm", confirm_window=5, stand_speed_std_mps=0.1)).people
    assert (people.weight == 0.5).all()
    np.testing.assert_array_equal(people.mean, np.repeat(frame.mean, 2, axis=0))
    np.testing.assert_array_equal(people.covariance[0], frame.covariance[0])
    assert people.covariance[1, :, [2, 3], [2, 3]] == pytest.approx(0.01)
    np.testing.assert_array_equal(people.covariance[1, :, :2, :2], frame.covariance[0, :, :2, :2])


@pytest.mark.parametrize("window", [3, 8])
def test_the_newest_images_stay_in_a_shorter_or_longer_window(frame, window):
    recent = under(frame, Config(confirm_window=window, confirm_detections=2)).people.recent
    kept = min(window, 5)
    assert recent.shape == (3, window)
    assert (recent[:, :kept] == frame.people.recent[:, :kept]).all()
    assert not recent[:, kept:].any()


def test_whom_standing_is_added_to_has_a_covariance_still(frame):
    one = under(frame, Config(motion="cv", confirm_window=5))
    people = under(one, Config(motion="imm", confirm_window=5)).people
    assert (np.linalg.eigvalsh(people.covariance) > 0).all()


def test_a_walker_under_two_modes_from_now_on_is_known_as_well_as_before(tracker_of):
    tracker = tracker_of(Config(motion="cv"))
    for number in range(20):
        at = Measurements.cartesian([2.0 + 0.1 * number, 1.0], 0.08**2 * np.eye(2))
        before = tracker.step(number * 10**8, at)
    tracker.config = Config(motion="imm")
    after = tracker.step(19 * 10**8, Measurements.none())
    np.testing.assert_allclose(after.mean, before.mean)
    assert (
        np.linalg.eigvalsh(after.covariance[0, :2, :2] - before.covariance[0, :2, :2]) >= 0
    ).all()
