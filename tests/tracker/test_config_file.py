"""The default parameter file and the documentation's table say what the model says."""

from pathlib import Path

import pytest
import yaml

from tracker.config import Config
from tracker.config_file import default_yaml, markdown_page, markdown_table

COMMITTED = Path(__file__).parents[2] / "config/hand_detector.yaml"


def test_the_committed_file_is_fresh():
    assert COMMITTED.read_text(encoding="utf-8") == default_yaml(), "stale: run `make config`"


def test_the_committed_page_is_fresh():
    page = COMMITTED.parents[1] / "docs/parameters.md"
    assert page.read_text(encoding="utf-8") == markdown_page(), "stale: run `make config`"


def test_the_committed_file_loads_as_the_defaults():
    assert Config.from_yaml(COMMITTED) == Config()


def test_every_parameter_stands_in_the_file_once_with_its_ros_type():
    parameters = yaml.safe_load(default_yaml())["hand_detector"]["ros__parameters"]
    assert list(parameters) == list(Config.model_fields)
    for name, value in Config().model_dump().items():
        assert type(parameters[name]) is type(value), name


def test_the_specifications_parameters_come_first():
    lines = default_yaml().splitlines()
    first = next(line for line in lines if line.startswith("    ") and "#" not in line)
    assert first == "    processing_rate: 10.0"


@pytest.mark.parametrize(
    "words", ["a number above 0 and at most 240 (Hz)", "one of evidence, palm, image"]
)
def test_ranges_and_choices_are_written_out(words):
    flowing = " ".join(default_yaml().replace("\n    #", "").split())
    assert words in flowing
    assert words in markdown_table()


def test_the_markdown_table_has_a_row_of_five_cells_for_every_parameter():
    rows = [line for line in markdown_table().splitlines() if line.startswith("| `")]
    assert [row.split("`")[1] for row in rows] == list(Config.model_fields)
    assert {row.count("|") for row in rows} == {6}
