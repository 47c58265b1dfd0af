import numpy as np
import pytest

from tracker import Config, Measurements
from tracker.errors import ConfigError
from tracker.evaluation.recordings.tracker_steps import Step
from tracker.evaluation.trials.scenario import PeopleScenario
from tracker.evaluation.tuning.innovation_log import (
    InnovationLog,
    innovations_of_scenario,
    innovations_of_steps,
    nis_by_dimensions,
)

MATCHED = Config(motion="cv", association="hungarian", outlier_dof=0.0, innovation_floor_m=0.0)
PERIOD_NS = 100_000_000


def matched_steps(seed, frames=400, range_std_m=0.08, bearing_std_rad=0.02):
    """Somebody who moves exactly as the filter believes, far off, whose hand stays up."""
    rng = np.random.default_rng(seed)
    dt, q = 0.1, MATCHED.acceleration_density
    block = np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]])
    root = np.linalg.cholesky(q * np.kron(block, np.eye(2)))
    state = np.array([20.0, 0.0, *rng.normal(0.0, 0.3, 2)])
    steps = []
    for number in range(frames):
        noise = rng.standard_normal(2) * [bearing_std_rad, range_std_m]
        polar = np.array([np.arctan2(state[1], state[0]), np.hypot(*state[:2])]) + noise
        claims = Measurements.polar(polar[:1], polar[1:], bearing_std_rad, range_std_m)
        steps.append(Step(number * PERIOD_NS, claims, (0.0, 0.0), None, None))
        state[:2] += dt * state[2:]
        state += root @ rng.standard_normal(4)
    return steps


def settled(innovations):
    """Without the first second, in which the filter's supposed speed is not the true one."""
    return innovations[innovations.stamp_ns > 10 * PERIOD_NS]


def test_the_nis_of_a_filter_that_is_right_keeps_to_its_bounds():
    found = settled(innovations_of_steps(matched_steps(1), MATCHED))
    (nis,) = nis_by_dimensions(found, probability=0.999)
    assert nis.dimensions == 2
    assert nis.samples == len(found) > 350
    assert nis.bounds[0] <= nis.mean <= nis.bounds[1]


@pytest.mark.parametrize("density", [0.01, 20.0], ids=["too sure", "too unsure"])
def test_the_nis_of_a_filter_that_is_wrong_does_not(density):
    config = MATCHED.replace(acceleration_density=density)
    (nis,) = nis_by_dimensions(settled(innovations_of_steps(matched_steps(1), config)), 0.999)
    low, high = nis.bounds
    assert nis.mean > high if density < MATCHED.acceleration_density else nis.mean < low


def test_a_scenario_s_trials_follow_one_another():
    scenario = PeopleScenario(
        title="Some without a range.", duration_s=3.0, people=(2, 2), range_missing_share=0.3
    )
    found = innovations_of_scenario(scenario, 2)
    assert np.count_nonzero(np.diff(found.stamp_ns) < 0) == 1
    assert [nis.dimensions for nis in nis_by_dimensions(found)] == [2, 1]


def test_a_log_of_nothing_says_what_is_needed():
    with pytest.raises(ConfigError, match="No measurement was assigned"):
        _ = InnovationLog().innovations
