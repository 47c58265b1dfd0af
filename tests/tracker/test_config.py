"""The configuration against the specification's own words, and what it says about mistakes."""

import os
import re

import pytest

from tracker.config import Config, allowed_values, parameter_extra
from tracker.errors import ConfigError

SPECIFICATION_TABLE_1 = {
    "processing_rate": 10.0,
    "downscale_factor": 2,
    "hand_raised_threshold": 0.25,
    "detection_confidence": 0.6,
    "tracking_confidence": 0.5,
    "model_complexity": 0,
    "camera_fx": 460.0,
    "camera_fy": 460.0,
    "camera_cx": 320.0,
    "camera_cy": 240.0,
}


@pytest.fixture
def write(tmp_path):
    def write(text):
        path = tmp_path / "parameters.yaml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_table_1_of_the_specification_has_its_names_defaults_and_types():
    config = Config()
    for name, default in SPECIFICATION_TABLE_1.items():
        value = getattr(config, name)
        assert value == default, name
        assert type(value) is type(default), name


def test_table_1_of_the_specification_is_a_group_of_its_own():
    group = [n for n in Config.model_fields if parameter_extra(n)["group"] == "specification"]
    assert group == list(SPECIFICATION_TABLE_1)


def test_the_streaks_and_the_window_default_to_the_specifications_algorithms():
    config = Config()
    assert (config.raise_streak, config.lower_streak) == (2, 3)  # algorithm 1
    assert config.hand_span_threshold == 0.15  # algorithm 3
    assert config.scan_window_beams == 3  # algorithm 5


def test_the_example_of_section_12_loads_unchanged(section_12):
    config = Config.from_yaml(section_12)
    assert config == Config(
        processing_rate=8.0,
        downscale_factor=3,
        hand_raised_threshold=0.3,
        detection_confidence=0.7,
        tracking_confidence=0.6,
        model_complexity=1,
        camera_fx=500.0,
        camera_fy=500.0,
    )


OLD_FILE = """
hand_detector:
  ros__parameters:
    camera_fx: 500.0
    appearance_weight: {weight}
    measurement_model: {model}
"""


@pytest.mark.parametrize(
    ("weight", "model"), [("0.5", "polar"), ("nonsense", "[1, 2]"), ("null", "{of: {what: 1}}")]
)
def test_a_file_of_an_earlier_version_counts_without_what_is_retired(write, weight, model):
    path = write(OLD_FILE.format(weight=weight, model=model))
    remarks = []
    assert Config.from_yaml(path, remark=remarks.append) == Config(camera_fx=500.0)
    [remark] = remarks
    assert remark.startswith(f"{path}: parameters of an earlier version are ignored")
    for words in ("`appearance_weight` (comparing", "`measurement_model` (meas", "deleted"):
        assert words in remark


def test_a_file_of_an_earlier_version_warns_a_program_at_its_own_line(write):
    with pytest.warns(UserWarning, match="`appearance_weight`") as warned:
        Config.from_yaml(write(OLD_FILE.format(weight=0.0, model="polar")))
    assert [item.filename for item in warned] == [__file__]


def test_other_mistakes_of_a_file_of_an_earlier_version_are_reported(write):
    text = OLD_FILE.format(weight=0.0, model="polar").replace("500.0", "-1.0")
    with pytest.raises(ConfigError, match="`camera_fx` is -1"):
        Config.from_yaml(write(text), remark=str)


@pytest.mark.parametrize("make", [Config.from_mapping, lambda values: Config(**values)])
@pytest.mark.parametrize(
    ("name", "value"), [("appearance_weight", 0.0), ("measurement_model", "polar")]
)
def test_a_program_that_names_a_retired_parameter_is_told_to_delete_it(make, name, value):
    with pytest.raises(ValueError, match=f"`{name}` is no longer there: .* Delete it"):
        make({name: value})


def test_a_parameter_that_decides_nothing_any_more_is_accepted_with_a_warning():
    with pytest.warns(FutureWarning, match="owner_hand_px has no effect any more"):
        assert Config.from_mapping({"owner_hand_px": 96.0, "max_hands": 3}) == Config(max_hands=3)


@pytest.mark.parametrize("opinion", ["veto", "full"])
def test_a_former_pose_opinion_is_taken_for_evidence_with_a_warning(opinion):
    with pytest.warns(FutureWarning, match=f"pose_opinion: {opinion} is now called evidence"):
        assert Config.from_mapping({"pose_opinion": opinion}) == Config()


def test_an_unknown_parameter_is_named_with_its_neighbor():
    with pytest.raises(ConfigError, match="`procesing_rate`; did you mean `processing_rate`"):
        Config.from_mapping({"procesing_rate": 5.0})


@pytest.mark.parametrize(
    ("name", "value", "allowed"),
    [
        ("processing_rate", "fast", "a number above 0 and at most 240 (Hz)"),
        ("processing_rate", 0.0, "a number above 0 and at most 240 (Hz)"),
        ("processing_rate", float("nan"), "a number above 0"),
        ("processing_rate", True, "a number above 0"),
        ("downscale_factor", 2.0, "a whole number at least 1 and at most 16"),
        ("downscale_factor", 0, "a whole number at least 1 and at most 16"),
        ("downscale_factor", True, "a whole number"),
        ("downscale_factor", "2", "a whole number"),
        ("detection_confidence", 1.0, "a number above 0 and below 1"),
        ("model_complexity", 2, "a whole number at least 0 and at most 1"),
        ("camera_fx", -460.0, "a number above 0"),
        ("use_camera_info", 1, "true or false"),
        ("fixed_frame", None, "a text"),
        ("raise_rule", "finger", "one of evidence, palm, image"),
        ("selection", ["first"], "one of first, nearest, newest"),
    ],
)
def test_a_value_that_is_off_is_named_with_what_is_allowed(name, value, allowed):
    with pytest.raises(ConfigError) as caught:
        Config.from_mapping({name: value}, origin="robot.yaml")
    message = str(caught.value)
    assert message.startswith(f"robot.yaml: `{name}` is {value!r}; allowed is {allowed}")
    assert "\n" not in message


def test_every_mistake_of_a_file_is_reported_at_once(write):
    text = "hand_detector:\n  ros__parameters:\n    camera_fx: -1.0\n    1: 2\n    speed: 3\n"
    with pytest.raises(ConfigError) as caught:
        Config.from_yaml(write(text))
    for words in ("`camera_fx` is -1", "unknown parameter `1`", "unknown parameter `speed`"):
        assert words in str(caught.value)


def test_a_mistake_is_a_value_error_too():
    with pytest.raises(ValueError, match="camera_fx"):
        Config.from_mapping({"camera_fx": 0.0})


def test_a_whole_number_serves_where_a_number_is_needed():
    config = Config.from_mapping({"processing_rate": 8})
    assert config.processing_rate == 8.0
    assert type(config.processing_rate) is float


def test_more_confirmations_than_frames_are_refused():
    with pytest.raises(ConfigError, match=r"confirm_detections is 5.*confirm_window, which is 3"):
        Config().replace(confirm_detections=5)


def test_replacing_checks_again_and_leaves_the_original_alone():
    config = Config()
    assert config.replace(camera_fx=500).camera_fx == 500.0
    assert config.camera_fx == 460.0
    with pytest.raises(ConfigError, match="camera_fx"):
        config.replace(camera_fx=0)


def test_a_configuration_is_frozen():
    with pytest.raises(ValueError, match="frozen"):
        Config().camera_fx = 1.0


@pytest.mark.parametrize("node", ["hand_detector", "/hand_detector", "/**", "'**'"])
def test_the_node_may_be_named_in_several_ways(write, node):
    text = f"{node}:\n  ros__parameters:\n    processing_rate: 7.0\n"
    assert Config.from_yaml(write(text)).processing_rate == 7.0


def test_later_sections_of_a_file_win(write):
    text = (
        "/**:\n  ros__parameters: {processing_rate: 3.0, downscale_factor: 4, use_sim_time: yes}\n"
        "hand_detector:\n  ros__parameters: {processing_rate: 7.0}\n"
    )
    config = Config.from_yaml(write(text))
    assert (config.processing_rate, config.downscale_factor) == (7.0, 4)


def test_other_nodes_in_the_same_file_are_left_alone(write, section_12):
    text = "amcl:\n  ros__parameters: {alpha1: 0.2}\n" + section_12.read_text(encoding="utf-8")
    assert Config.from_yaml(write(text)).processing_rate == 8.0


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "contains no parameters"),
        ("- 1\n", "contains no parameters"),
        ("amcl: {}\n", "names the nodes /amcl; expected `hand_detector:`"),
        ("hand_detector: {}\n", "has no `ros__parameters:`"),
        ("hand_detector:\n  ros__parameters: 3\n", "has no `ros__parameters:`"),
        ("hand_detector:\n  ros__parameters:\n    camera_fx: [1, 2\n", "line 4"),
        ("hand_detector:\n  ros__parameters:\n\tcamera_fx: 1\n", "line 3"),
        ("hand_detector:\n  ros__parameters:\n    camera_fx: 2024-13-45\n", "allowed is a number"),
        ("hand_detector: \x07\n", "is not YAML"),
    ],
    ids=[
        "empty", "a list", "another node", "no parameters", "a number", "an open bracket", "a tab",
        "no date", "a control character",
    ],
)  # fmt: skip
def test_a_broken_file_is_one_line_that_names_the_file_and_the_place(write, text, words):
    path = write(text)
    with pytest.raises(ConfigError) as caught:
        Config.from_yaml(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(ConfigError, match=r"nowhere\.yaml: cannot be read \(No such file"):
        Config.from_yaml(tmp_path / "nowhere.yaml")


def test_a_folder_is_no_file(tmp_path):
    with pytest.raises(ConfigError, match=f"cannot be read \\({os.strerror(21)}"):
        Config.from_yaml(tmp_path)


def test_a_file_that_is_no_text_is_named(tmp_path):
    path = tmp_path / "parameters.yaml"
    path.write_bytes(b"\xff\xfe\x00camera")
    with pytest.raises(ConfigError, match="is not UTF-8 text"):
        Config.from_yaml(path)


def test_every_parameter_has_a_description_a_group_and_a_stated_range():
    for name, info in Config.model_fields.items():
        assert info.description, name
        assert re.fullmatch(r"[A-Z`].*[.]", info.description), name
        assert "..." not in info.description, f"{name}: a description stands alone"
        assert set(parameter_extra(name)) == {"unit", "group", "level", "live", "search"}, name
        assert allowed_values(name), name
