import numpy as np
import pytest
from scipy.stats import norm

from tracker import Config, Measurements
from tracker.containers import View
from tracker.evaluation.recordings.tracker_steps import Step, run_steps
from tracker.evaluation.tuning.predictive_score import PredictiveScore, score_steps

PERIOD_NS = 100_000_000
MATCHED = Config(
    motion="cv", association="hungarian", outlier_dof=0.0, innovation_floor_m=0.0,
    same_person_distance_m=0.0,
)  # fmt: skip
VIEW = View(np.zeros(3), 2.0 * np.pi)
STD_M = 0.1


def walk(seed, frames=600):
    """Places of somebody who moves exactly as `MATCHED` believes, as measured."""
    rng = np.random.default_rng(seed)
    dt, q = 0.1, MATCHED.acceleration_density
    block = np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]])
    root = np.linalg.cholesky(q * np.kron(block, np.eye(2)))
    state, places = np.zeros(4), []
    for _ in range(frames):
        places.append(state[:2] + STD_M * rng.standard_normal(2))
        state[:2] += dt * state[2:]
        state = state + root @ rng.standard_normal(4)
    return np.array(places)


def steps_of(places, std_m=STD_M):
    claims = [Measurements.cartesian(place[None], std_m**2 * np.eye(2)) for place in places]
    return [
        Step(number * PERIOD_NS, item, (0.0, 0.0), VIEW, None)
        for number, item in enumerate(claims)
    ]


WRONG = {
    "noise stated too small": (STD_M / 2, {}),
    "noise stated too large": (STD_M * 2, {}),
    "too calm": (STD_M, {"acceleration_density": MATCHED.acceleration_density / 20}),
    "too restless": (STD_M, {"acceleration_density": MATCHED.acceleration_density * 20}),
    "far too many newcomers": (STD_M, {"newcomer_density": 1.0}),
}


@pytest.mark.parametrize(("std_m", "changes"), WRONG.values(), ids=WRONG)
def test_the_truth_scores_better_than_what_is_wrong(std_m, changes):
    places = walk(1)
    true = score_steps(steps_of(places), MATCHED).log_densities
    wrong = score_steps(steps_of(places, std_m), MATCHED.replace(**changes)).log_densities
    # In blocks of 20 frames, long enough to be independent: one-sided, at 0.1 %.
    gain = (true - wrong).reshape(-1, 20).mean(axis=1)
    error = gain.std(ddof=1) / np.sqrt(len(gain))
    assert gain.mean() > norm.ppf(0.999) * error


def test_a_tracker_whose_gate_rejects_true_measurements_scores_worse():
    steps = steps_of(walk(2, 200))
    open_, narrow = (
        score_steps(steps, MATCHED.replace(gate_probability=share)).log_densities.mean()
        for share in (0.9999, 0.51)
    )
    assert narrow < open_ - 0.5


def test_who_predicts_nothing_gets_one_over_the_area():
    first = score_steps(steps_of(walk(3, 1)), MATCHED).log_densities
    area_m2 = np.pi * MATCHED.person_range_max_m**2
    assert first == pytest.approx([-np.log(area_m2)])


@pytest.mark.parametrize("polar", [False, True], ids=["positions", "heavy-tailed ranges"])
@pytest.mark.parametrize("motion", ["cv", "imm"])
def test_what_is_predicted_is_a_density(polar, motion):
    """Summed over a fine grid of possible next measurements, it comes to one."""
    config = MATCHED.replace(motion=motion, outlier_dof=1.5, gate_probability=0.999999)
    half_m, spacing_m = 2.0, 0.08
    at = np.arange(-half_m, half_m, spacing_m) + spacing_m / 2
    grid = np.stack(np.meshgrid(4.0 + at, at), axis=-1).reshape(-1, 2)

    def claims(xy):
        if not polar:
            return Measurements.cartesian(xy, 0.15**2 * np.eye(2))
        bearing, range_m = np.arctan2(xy[:, 1], xy[:, 0]), np.hypot(*xy.T)
        return Measurements.polar(bearing, range_m, 0.04, 0.1)

    seen = [claims(np.array([[4.0, 0.0]]))] * 3 + [claims(grid)]
    score = PredictiveScore((2 * half_m) ** 2, 1.0)
    frames = [
        Step(number * PERIOD_NS, item, (0.0, 0.0), None, None) for number, item in enumerate(seen)
    ]
    for _ in run_steps(frames, config, score):
        pass
    density = np.exp(score.log_densities[-len(grid) :])
    assert density.sum() * spacing_m**2 == pytest.approx(1.0, abs=0.02)
    assert density.max() > 5 * density.mean()
