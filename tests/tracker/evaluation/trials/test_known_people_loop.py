import numpy as np

from tracker.config import Config
from tracker.containers import Measurements
from tracker.evaluation.trials import known_people_loop
from tracker.evaluation.trials.known_people import draw_known_people
from tracker.evaluation.trials.known_people_loop import follow
from tracker.evaluation.trials.scenario import SCENARIOS, default_config
from tracker.tracking import PersonTracker

CROWDED = SCENARIOS["known-people-missed"]
NOISE = (float(np.deg2rad(CROWDED.bearing_std_deg)), CROWDED.range_std_m)
CONFIG = default_config(CROWDED)


def followed(trials, config=CONFIG):
    return follow(trials.prior_mean, trials.prior_covariance, trials.values, NOISE, 0.1, config)


def test_it_follows_people_as_the_tracker_itself_does():
    config = CONFIG.replace(
        motion="cv", association="hungarian", outlier_dof=0.0,
        bystander_density=CONFIG.newcomer_density,  # of the lowered hands below
        confirm_detections=1, mature_detections=1,
        delete_after_s=60.0, forget_after_s=600.0, same_person_distance_m=0.0,
    )  # fmt: skip
    trials = draw_known_people(CROWDED, 4, 0, 20)
    for trial in range(20):
        one = PersonTracker(config)
        x, y = trials.prior_mean[trial, :, :2].T
        # Raised hands begin the tracks; later measurements only sustain them.
        tracks = one.step(0, Measurements.polar(np.arctan2(y, x), np.hypot(x, y), *NOISE))
        many = follow(
            *(tracks.mean[None], tracks.covariance[None], trials.values[trial][None]),
            *(NOISE, 0.1, config),
        )
        for frame, values in enumerate(trials.values[trial]):
            there = np.isfinite(values[:, 0])
            measured = Measurements.polar(
                *values[there].T, *NOISE,
                raised=False, hand=np.flatnonzero(there),  # lowered hands: they begin no track
            )  # fmt: skip
            tracks = one.step((frame + 1) * 100_000_000, measured)
            assert len(tracks) == CROWDED.people
            np.testing.assert_allclose(many.mean[0, frame], tracks.mean, rtol=0, atol=1e-9)
        np.testing.assert_allclose(many.covariance[0], tracks.covariance, rtol=0, atol=1e-9)


def test_a_trial_is_the_same_to_the_bit_in_every_batch():
    together = followed(draw_known_people(CROWDED, 3, 0, 37))
    alone = followed(draw_known_people(CROWDED, 3, 17, 1))
    for many, one in zip(together, alone, strict=True):
        assert np.array_equal(many[17], one[0])


def test_python_gives_what_machine_code_gives(monkeypatch):
    trials = draw_known_people(CROWDED, 8, 0, 10)
    fast = followed(trials)
    monkeypatch.setattr(known_people_loop, "machine_code", lambda function: function)
    slow = followed(trials)
    assert np.array_equal(fast.row, slow.row)
    np.testing.assert_allclose(fast.mean, slow.mean, rtol=0, atol=1e-10)
    np.testing.assert_allclose(fast.covariance, slow.covariance, rtol=0, atol=1e-10)


def test_whoever_nobody_saw_stays_as_predicted():
    mean = np.array([3.0, 1.0, 0.5, -0.5])[None, None]
    covariance = np.diag([0.1, 0.1, 0.2, 0.2])[None, None]
    found = follow(mean, covariance, np.full((1, 1, 2, 2), np.nan), NOISE, 1.0, Config())
    assert found.row[0, 0, 0] == -1
    np.testing.assert_allclose(found.mean[0, 0, 0], [3.5, 0.5, 0.5, -0.5])
    assert found.covariance[0, 0, 0, 0] > 0.1 + 0.2
