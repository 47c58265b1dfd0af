import io
import json
from dataclasses import replace

import matplotlib.image
import numpy as np
import pytest
from rich.console import Console

from tracker.config import Config
from tracker.errors import RecordingError
from tracker.evaluation.tuning.result import Tuning
from tracker.report.studies.tuning_table import parameters_table, verdict_table, write_tuning

NAMES = ("acceleration_density", "confirm_detections", "motion")


@pytest.fixture
def tuning():
    rng = np.random.default_rng(1)
    base = Config()
    best = base.replace(acceleration_density=1.75, confirm_detections=3, motion="cv")
    before = rng.normal(1.0, 0.1, 12)
    return Tuning(
        source="people",
        figure="GOSPA (m)",
        is_cost=True,
        names=NAMES,
        base=base,
        best=best,
        best_trial=7,
        trials=12,
        number=np.arange(10),
        value=rng.uniform(0.5, 1.0, 10),
        tried={
            "acceleration_density": tuple(rng.uniform(0.1, 5.0, 10)),
            "confirm_detections": tuple(rng.integers(1, 6, 10).tolist()),
            "motion": ("imm", "cv") * 5,
        },
        importance={"motion": 0.2, "acceleration_density": 0.7, "confirm_detections": 0.1},
        unseen_base=before,
        unseen_best=before - 0.2,
    )


def printed(table):
    console = Console(width=140, file=io.StringIO())
    console.print(table)
    return console.file.getvalue()


def test_parameters_stand_in_the_order_of_their_importance(tuning):
    lines = [line for line in printed(parameters_table(tuning)).splitlines() if "%" in line]
    assert [line.split()[1] for line in lines] == [NAMES[0], NAMES[2], NAMES[1]]
    assert "1.75" in lines[0]


def test_the_verdict_tells_gain_and_interval(tuning):
    text = printed(verdict_table(tuning))
    assert "12 parts that no trial used" in text
    assert "0.200 to 0.200" in text


def test_one_part_has_no_interval(tuning):
    alone = replace(tuning, unseen_base=tuning.unseen_base[:1], unseen_best=tuning.unseen_best[:1])
    assert "inf" not in printed(verdict_table(alone))


def test_the_winner_is_written_as_a_file_that_the_node_loads(tuning, tmp_path):
    best, document, picture = write_tuning(tuning, tmp_path / "new" / "folder")
    assert Config.from_yaml(best) == tuning.best
    assert json.loads(document.read_text())["unseen"]["gain"] == pytest.approx(0.2)
    assert matplotlib.image.imread(picture).std() > 0.01


def test_scores_and_searches_without_importance_are_drawn_too(tuning, tmp_path):
    score = replace(tuning, is_cost=False, importance={})
    assert matplotlib.image.imread(write_tuning(score, tmp_path)[2]).std() > 0.01


def test_a_folder_that_cannot_be_is_named(tuning, tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(RecordingError, match="file"):
        write_tuning(tuning, tmp_path / "file")
