import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment

from tracker.containers import Measurements
from tracker.evaluation.trials.batched_tracker import BatchedTracker, assign_trials
from tracker.evaluation.trials.known_people import draw_known_people
from tracker.evaluation.trials.scenario import SCENARIOS, default_config
from tracker.tracking import PersonTracker

CROWDED = SCENARIOS["known-people-missed"]
NOISE = (float(np.deg2rad(CROWDED.bearing_std_deg)), CROWDED.range_std_m)


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
            config, *NOISE,
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
