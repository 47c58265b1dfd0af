"""Known people: bounds from chi-square, at 99.9 %, not from the code."""

import dataclasses

import numpy as np
import pytest
from scipy.stats import binom, chi2

from tracker.evaluation.studies.monte_carlo import monte_carlo
from tracker.evaluation.trials.known_people import draw_known_people, known_people_rows
from tracker.evaluation.trials.scenario import SCENARIOS, default_config

TRIALS = 400
CROWDED = SCENARIOS["known-people"]
#: Nobody can be mistaken for them, and they do not walk through the sensor.
ALONE = dataclasses.replace(CROWDED, people=1, clutter_per_frame=0.0, area_m=(7.0, 9.0, -1.0, 1.0))


def test_the_tracker_of_one_person_is_as_wrong_as_it_says():
    # A gate of 99 % would turn every hundredth measurement away, and the covariance not know.
    config = default_config(ALONE).replace(gate_probability=0.9999)
    rows = monte_carlo(ALONE, TRIALS, 20_262, config).rows
    low, high = chi2.ppf([0.0005, 0.9995], 4 * TRIALS) / TRIALS
    assert low <= rows["final_nees"].mean() <= high
    assert not rows["wrong_share"].any()


def test_people_are_seen_as_often_as_they_should_be():
    trials = draw_known_people(CROWDED, 5, 0, 100)
    own = np.isfinite(trials.values[:, :, : CROWDED.people, 0])
    low, high = binom.ppf([0.0005, 0.9995], own.size, CROWDED.detection_probability)
    assert low <= np.count_nonzero(own) <= high


def test_what_is_drawn_is_the_same_to_the_bit_in_every_batch():
    together, alone = draw_known_people(CROWDED, 3, 0, 30), draw_known_people(CROWDED, 3, 17, 1)
    assert np.array_equal(together.truth[17], alone.truth[0])
    rows = alone.values.shape[2]
    assert np.array_equal(together.values[17, :, :rows], alone.values[0], equal_nan=True)
    assert np.isnan(together.values[17, :, rows:]).all()


@pytest.mark.parametrize("size", [1, 7])
def test_figures_do_not_depend_on_the_size_of_the_batch(size):
    config = default_config(CROWDED)
    whole = known_people_rows(CROWDED, config, 3, 0, 14)
    parts = [known_people_rows(CROWDED, config, 3, first, size) for first in range(0, 14, size)]
    for name, values in whole.items():
        pieces = np.concatenate([part[name] for part in parts])
        np.testing.assert_allclose(pieces, values, rtol=1e-12, err_msg=name)


def test_clutter_and_misses_cost_identities():
    easy = dataclasses.replace(CROWDED, detection_probability=1.0, clutter_per_frame=0.0)
    names = ("wrong_share", "swapped_share")
    hard = monte_carlo("known-people-missed", 200, seed=6).rows
    for name in names:
        assert hard[name].mean() > monte_carlo(easy, 200, seed=6).rows[name].mean()
