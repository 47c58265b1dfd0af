import dataclasses
import io
import json

import matplotlib.image
import pytest
from rich.console import Console

from tracker.errors import RecordingError
from tracker.evaluation.studies.monte_carlo import monte_carlo
from tracker.evaluation.trials.scenario import SCENARIOS
from tracker.report.studies.study_table import study_table, write_parquet, write_study


@pytest.fixture(scope="module")
def study():
    return monte_carlo("model-matched", 20, seed=4)


def test_every_figure_is_a_line_and_the_expected_bounds_stand_beside(study):
    console = Console(width=140, file=io.StringIO())
    console.print(study_table(study))
    text = console.file.getvalue()
    assert "model-matched: 20 trials of seed 4" in text
    for figure in study.figures:
        assert figure.name in text
        assert figure.good in text
    assert {figure.name for figure in study.figures if not figure.good} == {
        "bound along the paths (m)",
        "bound of expected information (m)",
    }
    assert "{:.3f} to {:.3f}".format(*study.figures[4].expected) in text


def test_no_number_is_cut_off_in_a_narrow_terminal(study):
    console = Console(width=80, file=io.StringIO())
    console.print(study_table(study))
    assert "\N{HORIZONTAL ELLIPSIS}" not in console.file.getvalue()


def test_a_study_is_written_as_numbers_and_a_picture(study, tmp_path):
    document, picture = write_study(study, tmp_path / "new" / "folder")
    assert json.loads(document.read_text())["scenario"] == "model-matched"
    assert matplotlib.image.imread(picture).std() > 0.01


def test_trials_are_written_as_parquet_to_the_last_bit(study, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed")
    table = parquet.read_table(write_parquet(study, tmp_path / "new"))
    assert table["trial"].to_pylist() == list(range(20))
    assert table["final_nees"].to_pylist() == study.rows["final_nees"].tolist()


def test_people_are_drawn_too(tmp_path):
    short = dataclasses.replace(SCENARIOS["people"], duration_s=2.0)
    picture = write_study(monte_carlo(short, 3), tmp_path)[1]
    assert matplotlib.image.imread(picture).std() > 0.01


def test_a_folder_that_cannot_be_is_named(study, tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(RecordingError, match="file"):
        write_study(study, tmp_path / "file")
