import dataclasses

import numpy as np
import pytest

from tracker.evaluation.studies.monte_carlo import monte_carlo
from tracker.evaluation.trials.scenario import SCENARIOS
from tracker.report.studies.study_page import study_page


def parts_of(page, title):
    return next(section for section in page.sections if section.title == title).parts


@pytest.mark.parametrize("name", ["model-matched", "known-people", "people"])
def test_each_kind_of_study_has_a_page(name):
    scenario = SCENARIOS[name]
    if name == "people":
        scenario = dataclasses.replace(scenario, duration_s=2.0)
    study = dataclasses.replace(monte_carlo(scenario, 4), name="<script>" + name)
    html = study_page(study, command="raised-hand monte-carlo").html()
    assert "<script>" not in html
    for figure in study.figures:
        assert figure.name.strip() in html.replace("&#39;", "'")
    assert html.count("data:image/svg+xml") == (1 if name == "known-people" else 2)
    assert len(html.encode()) < 5e6


def test_the_worst_trials_are_named_worst_first_so_that_they_can_be_repeated():
    study = monte_carlo("model-matched", 30, seed=3)
    table, words = parts_of(study_page(study), "Worst trials")
    worst = np.argsort(-study.rows["mse_m2"])[:8]
    assert [int(row[0]) for row in table.rows] == worst.tolist()
    assert f"config, 3, {worst[0]}, 1)" in words.paragraphs[0]


def test_a_study_of_people_says_where_false_raises_come_from():
    scenario = dataclasses.replace(SCENARIOS["people"], duration_s=2.0)
    page = study_page(monte_carlo(scenario, 2))
    (_, words) = parts_of(page, "Figures")
    assert "0.2 raised hands on average are nobody's" in words.paragraphs[0]
    (_, facts) = parts_of(page, "In short")
    assert not any("(m²)" in item[0] for item in facts.items), "parts of GOSPA are no headlines"


def test_columns_are_words_with_units():
    page = study_page(monte_carlo("model-matched", 3))
    (table, _) = parts_of(page, "Worst trials")
    assert table.columns[:2] == ("trial", "mean squared error of the position (m²)")
    assert "mse_m2" not in page.html()


def test_a_figure_off_its_expectation_is_marked():
    study = monte_carlo("model-matched", 50, config=None)
    wrong = dataclasses.replace(
        study, rows={**study.rows, "final_nees": 9.0 * study.rows["final_nees"]}
    )
    table, verdict = parts_of(study_page(wrong), "Figures")
    assert [table.rows[place][0] for place in table.marked] == ["NEES at the end (ideal 4)"]
    assert "NEES at the end" in verdict.paragraphs[0]
