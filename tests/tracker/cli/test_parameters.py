import json

import pytest

from tracker import Config
from tracker.config import parameter_extra


def test_basic_parameters_are_shown_and_the_others_are_counted(run):
    status, output, error = run("parameters")
    assert status == 0
    assert '  fixed_frame: "map"\n' in output
    assert "gate_probability" not in output
    experts = sum(parameter_extra(name)["level"] == "expert" for name in Config.model_fields)
    assert f"{experts} expert parameters are not shown; add --all" in error


def test_all_parameters_are_shown_the_basic_ones_first(run):
    status, output, error = run("parameters", "--all", "--json")
    rows = json.loads(output)
    levels = [row["level"] for row in rows]
    assert (status, error) == (0, "")
    assert sorted(row["name"] for row in rows) == sorted(Config.model_fields)
    assert levels == sorted(levels)


def test_a_parameter_is_shown_with_default_range_unit_and_meaning(run):
    _, output, error = run("parameters", "transform_wait_s")
    assert output.splitlines()[2] == "  transform_wait_s: 0.3"
    assert "An image waits this long" in output
    assert "at most 5 (s); may change while the node runs" in " ".join(output.split())
    assert error == ""


@pytest.mark.parametrize(
    ("name", "said"),
    [("gate_probabilty", "did you mean `gate_probability`?"), ("x", "unknown parameter `x`")],
)
def test_an_unknown_parameter_is_one_line_and_status_2(run, name, said):
    status, _, error = run("parameters", name)
    assert status == 2
    assert said in error
