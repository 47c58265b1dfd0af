from dataclasses import replace

import numpy as np
import pytest

from tracker import Config
from tracker.evaluation.tuning.result import Tuning
from tracker.report.studies.tuning_page import tuning_page


def tuning(gain):
    """A search of one parameter, judged on six unseen scenes."""
    before = np.array([1.0, 1.2, 0.9, 1.1, 1.3, 1.0])
    return Tuning(
        source="<script>room",
        figure="GOSPA (m)",
        is_cost=True,
        names=("range_std_m",),
        base=Config(),
        best=Config(range_std_m=0.25),
        best_trial=2,
        trials=3,
        number=np.arange(3),
        value=np.array([1.0, 0.9, 0.8]),
        tried={"range_std_m": (0.08, 0.1, 0.25)},
        importance={"range_std_m": 1.0},
        unseen_base=before,
        unseen_best=before - np.asarray(gain),
    )


def test_it_shows_the_verdict_the_winner_and_the_plots_and_escapes_names():
    html = tuning_page(tuning(0.2), command="raised-hand tune room").html()
    assert "<script>" not in html
    for words in ("GOSPA (m)", "range_std_m", "0.25", "raised-hand tune room"):
        assert words in html
    assert "data:image/svg+xml" in html


@pytest.mark.parametrize(
    ("gain", "words"),
    [
        ([0.2, 0.3, 0.2, 0.1, 0.2, 0.3], "chance does not explain it"),
        ([-0.2, -0.3, -0.2, -0.1, -0.2, -0.3], "keep the parameters"),
        ([0.2, -0.2, 0.1, -0.1, 0.3, -0.3], "No clear difference"),
    ],
    ids=["better", "worse", "by chance"],
)
def test_the_verdict_in_words_goes_by_the_interval(gain, words):
    assert words in tuning_page(tuning(gain)).html()


def test_a_search_that_found_nothing_better_says_so():
    same = replace(tuning(0.0), best=Config())
    assert "No trial is better" in tuning_page(same).html()


def test_one_unseen_part_has_no_interval():
    one = tuning(0.2)
    one = replace(one, unseen_base=one.unseen_base[:1], unseen_best=one.unseen_best[:1])
    assert "inf" not in tuning_page(one).html()
