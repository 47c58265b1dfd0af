"""The default parameter file and the documentation's table say what the model says."""

from pathlib import Path

import pytest
import yaml

from tracker.config import Config, parameter_extra
from tracker.config_file import (
    GROUP_TITLES,
    default_yaml,
    grouped_parameters,
    markdown_page,
    markdown_tables,
)

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
    assert sorted(parameters) == sorted(Config.model_fields)
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
    assert words in markdown_tables("basic")


def test_every_parameter_has_one_row_of_five_cells_in_the_documentation():
    rows = [line for line in markdown_page().splitlines() if line.startswith("| `")]
    assert sorted(row.split("`")[1] for row in rows) == sorted(Config.model_fields)
    assert {row.count("|") for row in rows} == {6}


def test_basic_parameters_come_first_in_file_and_page():
    names = [name for _, _, members in grouped_parameters() for name in members]
    levels = [parameter_extra(name)["level"] for name in names]
    assert levels == sorted(levels)  # "basic" before "expert"
    assert list(yaml.safe_load(default_yaml())["hand_detector"]["ros__parameters"]) == names
    page = [line.split("`")[1] for line in markdown_page().splitlines() if line.startswith("| `")]
    assert page == names


def test_less_than_half_of_the_parameters_are_basic():
    basic = sum(parameter_extra(name)["level"] == "basic" for name in Config.model_fields)
    assert 20 <= basic < len(Config.model_fields) / 2


def test_every_group_stands_once_in_a_level_and_has_a_title():
    sections = [(level, group) for level, group, _ in grouped_parameters()]
    assert len(sections) == len(set(sections))
    assert {group for _, group in sections} == set(GROUP_TITLES)
