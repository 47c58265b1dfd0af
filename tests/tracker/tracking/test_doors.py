"""Functions of the user's own take the place of a step."""

import numpy as np
import pytest

from tracker import Config, Measurements, PersonTracker
from tracker.errors import ShapeError
from tracker.tracking import View

NOISE = 0.08**2 * np.eye(2)


def at(*points, raised=True, **claimed):
    return Measurements.cartesian(np.reshape(points, (-1, 2)), NOISE, raised=raised, **claimed)


def run(tracker, frames, start=0, **given):
    for number, measured in enumerate(frames, start):
        tracks = tracker.step(number * 10**8, measured, **given)
    return tracks


def stands_still(mean, covariance, dt_s):
    still = mean.copy()
    still[:, 2:] = 0.0
    return still, covariance + dt_s * np.diag([0.01, 0.01, 0.0, 0.0])


def nearest(log_odds):
    """Each track's likeliest measurement, for certain."""
    told = np.zeros(log_odds.shape)
    for track in range(len(log_odds)):
        if log_odds.shape[1] and np.isfinite(log_odds[track]).any():
            told[track, np.argmax(log_odds[track])] = 1.0
    return told


def test_a_motion_of_one_s_own_moves_everybody():
    tracker = PersonTracker(motion=stands_still)
    run(tracker, [at((2.0 + 0.05 * step, 1.0)) for step in range(10)])
    before = tracker.people
    after = tracker.step(14 * 10**8, Measurements.none())
    np.testing.assert_array_equal(after.mean[:, :2], before.mean[:, :2])
    assert (after.mean[:, 2:] == 0.0).all()
    grown = after.covariance - before.covariance
    np.testing.assert_allclose(grown[0], 0.5 * np.diag([0.01, 0.01, 0.0, 0.0]), atol=1e-12)


def test_a_motion_is_told_means_covariances_and_seconds():
    told = []

    def motion(mean, covariance, dt_s):
        told.append((mean.shape, covariance.shape, dt_s))
        return mean, covariance

    tracker = PersonTracker(motion=motion)
    tracker.step(0, at((2.0, 1.0), (4.0, 1.0)))
    tracker.step(250_000_000, Measurements.none())
    assert told == [((0, 4), (0, 4, 4), 0.0), ((2, 4), (2, 4, 4), 0.25)]


def test_a_motion_that_writes_to_what_it_was_given_changes_nothing_else():
    def motion(mean, covariance, dt_s):
        mean += 100.0
        return mean - 100.0, covariance

    tracks = run(PersonTracker(motion=motion), [at((2.0, 1.0))] * 5)
    assert tracks.id.tolist() == [1]
    assert tracks.mean[0, :2] == pytest.approx([2.0, 1.0])


def test_with_a_motion_of_one_s_own_people_have_one_mode():
    tracker = PersonTracker(Config(motion="imm"), motion=stands_still)
    assert tracker.config.motion == "cv"
    run(tracker, [at((2.0, 1.0))] * 3)
    tracker.config = Config(motion="imm", delete_after_s=1.0)
    assert (tracker.config.motion, tracker.config.delete_after_s) == ("cv", 1.0)
    assert len(run(tracker, [at((2.0, 1.0))], start=3)) == 1


def test_an_association_of_one_s_own_decides():
    def refuses(log_odds):
        return np.zeros(log_odds.shape)

    frames = [at((2.0, 1.0))] * 5
    tracks = run(PersonTracker(associate=nearest), frames)
    assert tracks.id.tolist() == [1]
    assert tracks.raised.tolist() == [True]
    tracks = run(PersonTracker(associate=refuses), frames)
    assert len(tracks) > 1
    assert not tracks.raised.any()


def test_an_association_is_told_the_log_odds_of_all_with_minus_infinity_outside_the_gate():
    told = []

    def associate(log_odds):
        told.append(log_odds.copy())
        return nearest(log_odds)

    tracker = PersonTracker(associate=associate)
    run(tracker, [at((2.0, 1.0), (6.0, 1.0))] * 3)
    (odds,) = told[-1:]
    assert np.isfinite(odds).tolist() == [[True, False], [False, True]]
    assert (odds[[0, 1], [0, 1]] > 0.0).all()
    assert (odds[[0, 1], [1, 0]] == -np.inf).all()


def test_hungarian_by_the_door_is_the_hungarian_of_the_tracker():
    from scipy.optimize import linear_sum_assignment

    def hungarian(log_odds):
        gain = np.maximum(log_odds, 0.0)
        row, column = linear_sum_assignment(gain, maximize=True)
        told = np.zeros(gain.shape)
        told[row, column] = gain[row, column] > 0.0
        return told

    config, rng = Config(association="hungarian"), np.random.default_rng(3)
    own = PersonTracker(config, compiled=False)
    mine = PersonTracker(config, associate=hungarian)
    at_m = rng.uniform(-2, 2, (5, 2))
    for number in range(40):
        at_m += 0.05 * rng.normal(size=(5, 2))
        measured = at(at_m + 0.08 * rng.normal(size=(5, 2)), raised=rng.random(5) < 0.7)
        expected, found = (each.step(number * 10**8, measured) for each in (own, mine))
        assert found.id.tolist() == expected.id.tolist()
        np.testing.assert_allclose(found.mean, expected.mean, atol=1e-9)


def test_probabilities_count_as_shares():
    config = Config(association="hungarian", motion="cv", outlier_dof=0.0)
    tracks = {}
    for share in (0.5, 1.0):
        tracker = PersonTracker(config, associate=lambda odds, share=share: share * nearest(odds))
        tracker.step(0, at((2.0, 1.0)))
        tracks[share] = tracker.step(0, at((2.1, 1.0)))
    moved = {share: each.mean[0, 0] - 2.0 for share, each in tracks.items()}
    assert moved[0.5] == pytest.approx(moved[1.0] / 2.0)


@pytest.mark.parametrize(
    "given",
    [
        {"motion": lambda mean, covariance, dt_s: (mean[:, :2], covariance)},
        {"motion": lambda mean, covariance, dt_s: (mean, covariance[:, :2])},
        {"motion": lambda mean, covariance, dt_s: (mean * np.nan, covariance)},
        {"motion": lambda mean, covariance, dt_s: (mean, covariance + np.inf)},
        {"motion": lambda mean, covariance, dt_s: (mean, -covariance)},
        {"motion": lambda mean, covariance, dt_s: (mean, covariance + np.tri(4))},
        {"associate": lambda odds: np.zeros((3, 3))},
        {"associate": lambda odds: np.full(odds.shape, np.nan)},
        {"associate": lambda odds: np.full(odds.shape, -0.1)},
        {"associate": lambda odds: np.full(odds.shape, 0.9)},
        {"associate": lambda odds: 0.9 * (np.arange(odds.shape[1]) == 0) * np.ones(odds.shape)},
    ],
    ids=[
        *("mean's shape", "covariance's shape", "mean not finite", "covariance not finite"),
        *("covariance negative", "covariance not symmetric"),
        *("shape", "not finite", "negative", "rows above 1", "columns above 1"),
    ],
)
def test_what_does_not_fit_is_refused_at_once(given):
    tracker = PersonTracker(**given)
    with pytest.raises(ShapeError, match=f"`{next(iter(given))}`"):
        run(tracker, [at((2.0, 1.0), (4.0, 1.0))] * 2)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_likeness_decides_between_two_equally_near_tracks(tracker_of, sign):
    tracker = tracker_of(Config(same_person_distance_m=0.3, association="hungarian"))
    run(tracker, [at((2.0, 0.4), (2.0, -0.4))] * 5)
    between = at((2.0, 0.0), raised=False)
    likeness = sign * np.array([[3.0], [-3.0]])
    tracks = tracker.step(9 * 10**8, between, likeness=likeness)
    assert tracks.id.tolist() == [1, 2]
    seen, unseen = (0, 1) if sign > 0 else (1, 0)
    assert tracks.unseen_s[seen] == 0.0
    assert tracks.unseen_s[unseen] > 0.0


def test_likeness_is_of_customers_though_bystanders_stand_between(tracker_of):
    tracker = tracker_of()
    run(tracker, [at((9.0, 9.0), (-9.0, 9.0), raised=False)] * 5)
    run(tracker, [Measurements.concatenate(at((2.0, 1.0)), at((9.0, 9.0), raised=False))] * 5, 5)
    assert tracker.people.id.tolist() != [1]
    forbidden = tracker.step(10**9, at((2.0, 1.0)), likeness=[[-50.0]])
    assert forbidden.unseen_s[0] > 0.0


def test_likeness_of_which_nothing_is_known_changes_nothing(tracker_of):
    frames = [at((2.0, 1.0), (4.0, 0.0))] * 5
    with_, without = tracker_of(), tracker_of()
    expected = run(without, frames)
    with_.step(0, frames[0])
    found = run(with_, frames[1:], start=1, likeness=[[np.nan, 0.0], [0.0, np.nan]])
    np.testing.assert_array_equal(found.mean, expected.mean)


@pytest.mark.parametrize(
    "likeness",
    [np.zeros((2, 1)), np.zeros((1, 2)), np.zeros(1), [[np.inf]], [[-np.inf]]],
    ids=["rows", "columns", "axes", "infinite", "infinitely unlike"],
)
def test_likeness_of_another_shape_or_infinite_is_refused(likeness):
    tracker = PersonTracker()
    run(tracker, [at((2.0, 1.0))] * 3)
    with pytest.raises(ShapeError, match="likeness"):
        tracker.step(3 * 10**8, at((2.0, 1.0)), likeness=likeness)


def test_a_jump_back_of_the_clock_forgets_whom_the_likeness_is_of():
    tracker = PersonTracker()
    run(tracker, [at((2.0, 1.0))] * 3, start=10)
    tracks = tracker.step(0, at((2.0, 1.0)), likeness=[[1.0]])
    assert tracks.id.tolist() == [2]


def test_steps_of_another_sensor_leave_streaks_and_confirmations_as_with_the_camera_alone(
    tracker_of,
):
    # Two people hold up a hand now and then; only the scan shows them between two images.
    rng = np.random.default_rng(5)
    alone, both = tracker_of(), tracker_of()
    places = np.array([[2.0, 1.0], [4.0, -1.0]])
    everywhere = View(np.zeros(3), 2 * np.pi)
    for image in range(60):
        up = rng.random(2) < 0.6
        hands = at(*places[up]) if up.any() else Measurements.none()
        stamp_ns = image * 10**8
        expected = alone.step(stamp_ns, hands)
        found = both.step(stamp_ns, hands)
        for name in ("id", "raised", "confirmed", "raised_since_ns"):
            np.testing.assert_array_equal(getattr(found, name), getattr(expected, name), name)
        assert found.selected_id == expected.selected_id
        for part in (25, 50, 75):
            scan = at(*places[: len(found)], raised=False)
            between = both.step(
                stamp_ns + part * 10**6, scan, scan_view=everywhere, camera_looked=False
            )
            np.testing.assert_array_equal(between.raised, found.raised)
            np.testing.assert_array_equal(between.confirmed, found.confirmed)
    assert expected.id.tolist() == [1, 2]
