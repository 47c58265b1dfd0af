"""What a file gives to a node; expectations as rclpy on rcl 9.2 gave them for the same texts."""

import pytest

from tracker.errors import ConfigError
from tracker.parameters.ros_file import read_assignment, read_parameters


@pytest.fixture
def parameters(tmp_path):
    def read(text, node=None):
        path = tmp_path / "robot.yaml"
        path.write_text(text, encoding="utf-8")
        return read_parameters(path, node)

    return read


def section(*names, value=1):
    lines = [f"{'  ' * depth}'{name}':" for depth, name in enumerate((*names, "ros__parameters"))]
    return "\n".join([*lines, f"{'  ' * (len(names) + 1)}speed: {value}"]) + "\n"


@pytest.mark.parametrize(
    "names",
    [
        ["/**"],
        ["/cafe/hand_detector"],
        ["cafe/hand_detector"],
        ["cafe", "hand_detector"],
        ["/cafe", "hand_detector"],
        ["/**/hand_detector"],
        ["/*/hand_detector"],
        ["/*/*"],
        ["/cafe/*"],
        ["/cafe/**"],
        ["/**", "hand_detector"],
        ["/cafe/**/hand_detector"],
    ],
    ids="/".join,
)
def test_sections_that_fit_a_namespaced_node(parameters, names):
    assert parameters(section(*names), "/cafe/hand_detector") == {"speed": 1}
    assert parameters(section(*names)) == {"speed": 1}


@pytest.mark.parametrize(
    "names",
    [
        ["hand_detector"],
        ["/*"],
        ["/bar/hand_detector"],
        ["/cafe/*/hand_detector"],
        ["/cafe/hand_detector/**", "x"],
        ["/cafe/hand_*"],
        ["cafe"],
    ],
    ids="/".join,
)
def test_sections_that_do_not_fit_are_named(parameters, names):
    with pytest.raises(ConfigError, match=r"names the nodes /.*expected `/cafe/hand_detector:`"):
        parameters(section(*names), "/cafe/hand_detector")


def test_later_sections_win_and_one_name_applies_where_it_stands_first(parameters):
    node = "/cafe/hand_detector"
    general, own = section("/**", value=1), section("cafe", "hand_detector", value=2)
    assert parameters(general + own, node) == {"speed": 2}
    assert parameters(own + general, node) == {"speed": 1}
    again = own + general + section("/cafe/hand_detector", value=3)
    assert parameters(again, node) == {"speed": 1}


def test_without_a_namespace_the_one_node_of_the_file_is_meant(parameters):
    text = section("/**", value=1) + section("/cafe/hand_detector", value=2)
    assert parameters(text) == {"speed": 2}
    assert parameters(text + section("hand_detector", value=3)) == {"speed": 3}
    with pytest.raises(ConfigError, match="/bar/hand_detector and /cafe/hand_detector, but only"):
        parameters(text + section("/bar/hand_detector"))


def test_nested_parameters_have_dots(parameters):
    text = "hand_detector:\n  ros__parameters:\n    qos:\n      scan: {depth: 5}\n      x.y: no\n"
    assert parameters(text) == {"qos.scan.depth": 5, "qos.x.y": False}


@pytest.mark.parametrize(
    ("text", "node", "expected"),
    [
        ("speed:=2e-1", None, ("speed", 0.2)),
        ("hand_detector:speed:=on", None, ("speed", True)),
        ("/cafe/hand_detector:speed:='on'", None, ("speed", "on")),
        ("/cafe/hand_detector:speed:=3", "/cafe/hand_detector", ("speed", 3)),
        ("/**:speed:=a:=b", "/cafe/hand_detector", ("speed", "a:=b")),
        ("qos.scan.depth:=4", "/hand_detector", ("qos.scan.depth", 4)),
    ],
)
def test_assignments_as_ros_writes_them(text, node, expected):
    assert read_assignment(text, node) == expected


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("speed", "expected NAME:=VALUE"),
        ("speed:=", "expected NAME:=VALUE"),
        (":=3", "expected NAME:=VALUE"),
        (":speed:=3", "expected NAME:=VALUE"),
        ("amcl:speed:=3", "for the node /amcl; this one is /cafe/hand_detector"),
        ("hand_detector:speed:=3", "for the node /hand_detector; this one is"),
        ("speed:=[", "is not YAML"),
        ("speed:=*b", "is not defined"),
    ],
)
def test_an_assignment_that_is_none_is_one_line(text, words):
    with pytest.raises(ConfigError) as caught:
        read_assignment(text, "/cafe/hand_detector")
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
