import importlib.util

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from tracker.config import Config
from tracker.containers import Measurements
from tracker.evaluation.trials.batched_tracker import BatchedTracker, assign_trials
from tracker.evaluation.trials.known_people import draw_known_people
from tracker.evaluation.trials.scenario import SCENARIOS, default_config
from tracker.tracking import PersonTracker

needs_numba = pytest.mark.skipif(
    importlib.util.find_spec("numba") is None, reason="numba (the extra fast) is not installed"
)
CROWDED = SCENARIOS["known-people-missed"]
NOISE = (float(np.deg2rad(CROWDED.bearing_std_deg)), CROWDED.range_std_m)


def follow(trials, config, *, compiled):
    """Everybody's means and covariances after every frame, and who got which measurement."""
    tracker = BatchedTracker(
        trials.prior_mean, trials.prior_covariance, config, *NOISE, compiled=compiled
    )
    means, covariances, chosen = [], [], []
    for bearing, range_m in zip(trials.bearing_rad, trials.range_m, strict=True):
        chosen.append(tracker.step(0.1, bearing, range_m))
        means.append(tracker.mean.copy())
        covariances.append(tracker.covariance.copy())
    return np.array(means), np.array(covariances), np.array(chosen)


def test_it_follows_people_as_the_tracker_itself_does():
    config = default_config(CROWDED)
    config = config.replace(
        motion="cv", association="hungarian", outlier_dof=0.0,
        bystander_density=config.newcomer_density,  # of the lowered hands below
        confirm_detections=1, mature_detections=1,
        delete_after_s=60.0, forget_after_s=600.0, same_person_distance_m=0.0,
    )  # fmt: skip
    trials = draw_known_people(CROWDED, 4, 0, 20)
    compared = 0
    for trial in range(20):
        one = PersonTracker(config)
        x, y = trials.prior_mean[:2, :, trial]
        # Raised hands begin the tracks; later measurements only sustain them.
        tracks = one.step(0, Measurements.polar(np.arctan2(y, x), np.hypot(x, y), *NOISE))
        many = BatchedTracker(
            tracks.mean.T[..., None], np.moveaxis(tracks.covariance, 0, -1)[..., None],
            config, *NOISE, compiled=False,
        )  # fmt: skip
        for frame in range(CROWDED.frames):
            bearing = trials.bearing_rad[frame, :, trial]
            range_m = trials.range_m[frame, :, trial]
            there = np.isfinite(bearing)
            measured = Measurements.polar(
                bearing[there], range_m[there], *NOISE,
                raised=False, hand=np.flatnonzero(there),  # lowered hands: they begin no track
            )  # fmt: skip
            tracks = one.step((frame + 1) * 100_000_000, measured)
            many.step(0.1, bearing[:, None], range_m[:, None])
            assert len(tracks) == CROWDED.people
            np.testing.assert_allclose(many.mean[..., 0].T, tracks.mean, rtol=0, atol=1e-9)
            np.testing.assert_allclose(
                np.moveaxis(many.covariance[..., 0], -1, 0), tracks.covariance, rtol=0, atol=1e-9
            )
            compared += 1
    assert compared == 20 * CROWDED.frames


@pytest.mark.parametrize("compiled", [False, pytest.param(True, marks=needs_numba)])
def test_a_trial_is_the_same_to_the_bit_in_every_batch(compiled):
    config = default_config(CROWDED)
    together = follow(draw_known_people(CROWDED, 3, 0, 37), config, compiled=compiled)
    alone = follow(draw_known_people(CROWDED, 3, 17, 1), config, compiled=compiled)
    for many, one in zip(together[:2], alone[:2], strict=True):
        assert np.array_equal(many[..., 17], one[..., 0])


@needs_numba
def test_the_compiled_loop_gives_what_numpy_gives():
    config, trials = default_config(CROWDED), draw_known_people(CROWDED, 8, 0, 200)
    arrays, loop = (follow(trials, config, compiled=compiled) for compiled in (False, True))
    assert np.array_equal(arrays[2], loop[2])
    np.testing.assert_allclose(loop[0], arrays[0], rtol=0, atol=1e-10)
    np.testing.assert_allclose(loop[1], arrays[1], rtol=0, atol=1e-10)


def random_gains(rng, rows, columns, trials=300):
    """Every second pair is not worth taking, and many columns want the same row."""
    gain = rng.normal(0.0, 1.0, (rows, columns, trials)) + rng.normal(0.0, 1.0, (rows, 1, trials))
    return np.maximum(gain, 0.0)


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (3, 5), (5, 5), (8, 4)])
def test_assignments_are_one_to_one_and_the_best_there_are(rows, columns):
    gain = random_gains(np.random.default_rng(rows), rows, columns)
    chosen = np.empty(gain.shape, dtype=bool)
    assign_trials(gain, chosen)
    assert chosen.sum(axis=0).max() == chosen.sum(axis=1).max() == 1
    for trial in range(gain.shape[-1]):
        row, column = linear_sum_assignment(gain[..., trial], maximize=True)
        best = gain[row, column, trial].sum()
        assert gain[chosen[..., trial], trial].sum() == pytest.approx(best, abs=1e-12)


@needs_numba
@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (3, 5), (5, 5), (8, 4)])
def test_compiled_assignments_are_the_best_there_are(rows, columns):
    from numba import njit

    from tracker.tracking.compiled import association

    @njit
    def assign(gain, row_of, is_taken):  # loops are called by compiled functions alone
        association.assign(gain, row_of, is_taken)

    gains = random_gains(np.random.default_rng(rows), rows, columns)
    for gain in np.moveaxis(gains, -1, 0):
        row_of, is_taken = np.empty(columns, dtype=np.int64), np.empty(rows, dtype=bool)
        assign(np.ascontiguousarray(gain.T), row_of, is_taken)
        people = np.flatnonzero(row_of >= 0)
        assert len(set(row_of[people])) == len(people)
        row, column = linear_sum_assignment(gain, maximize=True)
        best = gain[row, column].sum()
        assert gain[row_of[people], people].sum() == pytest.approx(best, abs=1e-12)


def test_whoever_nobody_saw_stays_as_predicted():
    mean = np.array([3.0, 1.0, 0.5, -0.5])[:, None, None]
    covariance = np.diag([0.1, 0.1, 0.2, 0.2])[..., None, None]
    tracker = BatchedTracker(mean, covariance, Config(), *NOISE, compiled=False)
    chosen = tracker.step(1.0, np.full((2, 1), np.nan), np.full((2, 1), np.nan))
    assert not chosen.any()
    np.testing.assert_allclose(tracker.mean[:, 0, 0], [3.5, 0.5, 0.5, -0.5])
    assert tracker.covariance[0, 0, 0, 0] > 0.1 + 0.2
