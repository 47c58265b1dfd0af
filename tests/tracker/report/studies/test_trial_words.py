import dataclasses

import pytest

from tracker.evaluation.studies.monte_carlo import monte_carlo
from tracker.evaluation.trials.scenario import SCENARIOS
from tracker.report.studies.trial_words import trial_words


@pytest.mark.parametrize("name", ["model-matched", "known-people", "people"])
def test_every_figure_of_a_trial_has_words(name):
    scenario = SCENARIOS[name]
    if name == "people":
        scenario = dataclasses.replace(scenario, duration_s=2.0)
    words = {key: trial_words(key) for key in monte_carlo(scenario, 2).rows}
    assert [key for key, said in words.items() if said == key or "_" in said] == []
    assert len(set(words.values())) == len(words)


def test_units_of_names_stand_in_the_words():
    assert trial_words("gospa_m").endswith("(m)")
    assert trial_words("mse_m2").endswith("(m²)")
    assert trial_words("time_to_raise_s").endswith("(s)")
    assert trial_words("a_new_figure") == "a_new_figure"
