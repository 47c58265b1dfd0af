"""The command of the node without ROS, where Cyclone DDS is missing."""

import subprocess
import sys

import pytest

from tracker.config import Config
from tracker.errors import ConfigError

WITHOUT = """
import sys
sys.modules["cyclonedds"] = None
from nodes.raised_hand_dds import main
main()
"""


def test_without_its_extra_the_command_names_it_in_one_line():
    ended = subprocess.run([sys.executable, "-c", WITHOUT], capture_output=True, text=True)
    assert ended.returncode == 2
    assert ended.stdout == ""
    [line] = ended.stderr.splitlines()
    assert "pip install '.[dds]'" in line


NODE = "/cafe/hand_detector"


@pytest.fixture
def given(tmp_path):
    """What files and assignments give to the node."""
    pytest.importorskip("cyclonedds", reason="the extra dds is not installed")
    from nodes.dds_hand_detector import _parameters

    def read(*texts, assignments=(), remark=pytest.fail):
        files = [tmp_path / f"{number}.yaml" for number in range(len(texts))]
        for path, text in zip(files, texts, strict=True):
            path.write_text(text)
        return _parameters(files, list(assignments), NODE, remark)

    return read


def test_later_files_win_and_assignments_win_over_all(given):
    first = "/**:\n  ros__parameters:\n    use_sim_time: on\n    newcomer_density: 2e-3\n"
    second = "cafe:\n  hand_detector:\n    ros__parameters:\n      newcomer_density: 4e-3\n"
    assert given(first, second) == (Config(newcomer_density=0.004), True)
    assignments = [f"{NODE}:newcomer_density:=5e-3", "use_sim_time:=false"]
    assert given(first, second, assignments=assignments) == (Config(newcomer_density=0.005), False)


def test_parameters_that_only_fit_together_may_be_given_in_any_order(given):
    assignments = ["confirm_detections:=5", "confirm_window:=6"]
    assert given(assignments=assignments)[0].confirm_detections == 5
    with pytest.raises(ConfigError, match=r"0\.yaml, -p: confirm_detections is 5"):
        given("/**:\n  ros__parameters: {}\n", assignments=assignments[:1])


def test_ros_s_own_parameters_are_passed_over(given):
    text = "/**:\n  ros__parameters:\n    qos_overrides: {/scan: {subscription: {depth: 3}}}\n"
    assert given(text) == (Config(), False)


def test_a_file_for_another_namespace_is_refused_with_the_remedy(given):
    with pytest.raises(ConfigError, match=f"expected `{NODE}:` or `/\\*\\*/hand_detector:`"):
        given("hand_detector:\n  ros__parameters: {}\n")


def test_files_of_an_earlier_version_count_without_what_is_retired(given):
    first = "/**:\n  ros__parameters:\n    appearance_weight: 0.5\n    newcomer_density: 2e-3\n"
    second = "/**:\n  ros__parameters:\n    appearance_weight: nonsense\n"
    remarks = []
    assert given(first, second, remark=remarks.append) == (Config(newcomer_density=0.002), False)
    [remark] = remarks
    for words in ("0.yaml, ", "1.yaml: ", "`appearance_weight` (comparing", "deleted"):
        assert words in remark


def test_what_is_retired_and_assigned_on_the_command_line_is_refused_with_the_remedy(given):
    with pytest.raises(ConfigError, match=r"-p: .*`measurement_model` is no longer there.*Delete"):
        given(assignments=["measurement_model:=polar"])
