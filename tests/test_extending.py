"""What docs/extending.md shows and says, as machine code and as Python."""

import contextlib
import importlib
import io
import re
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import tracker
from tracker import Config, Measurements, PersonTracker
from tracker.containers.sensor_kind import ABSENT, SensorKind
from tracker.tracking.machine_frame import compile_tracker
from tracker.tracking.sensing import sensor_kinds

PROJECT = Path(__file__).parents[1]
PAGE = (PROJECT / "docs" / "extending.md").read_text(encoding="utf-8")
SECTIONS = dict(
    re.findall(r"^## (.+?)\n(.*?)(?=^## |\Z)", PAGE, re.DOTALL | re.MULTILINE),
)
CODE = {
    title: code
    for title, text in SECTIONS.items()
    for code in re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
}
PERIOD_NS = 100_000_000
NOISE = 0.01 * np.eye(2)


@pytest.fixture(params=["machine code", "Python"])
def run(request, monkeypatch):
    """Runs the code of a section by itself; gives its names, and what it printed as `printed`."""
    is_compiled = request.param == "machine code"
    if is_compiled:
        compile_tracker(lambda sentence: None)
    monkeypatch.setattr(tracker, "PersonTracker", partial(PersonTracker, compiled=is_compiled))

    def names(title, old="", new=""):
        assert old in CODE[title]
        found, printed = {}, io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(CODE[title].replace(old, new), title, "exec"), found)
        return {**found, "printed": printed.getvalue()}

    return names


def at(x_m, y_m, **details):
    return Measurements.cartesian([x_m, y_m], NOISE, **details)


def std_m(tracks, row=0):
    return float(np.sqrt(np.trace(tracks.covariance[row, :2, :2])))


@pytest.mark.parametrize("title", CODE)
def test_each_piece_of_code_is_short_and_ends_in_what_it_shows(title):
    lines = CODE[title].rstrip().splitlines()
    assert len(lines) <= 20
    assert lines[-1].startswith(("assert ", "print("))


def test_every_section_but_the_table_s_has_one_piece_of_code():
    pieces = len(re.findall(r"^```python", PAGE, re.MULTILINE))
    assert pieces == len(CODE) == len(SECTIONS) - 1 == 8


def test_a_hand_is_up_in_as_many_frames_beside_a_depth_camera_and_better_known(run):
    found = run("A depth camera")
    assert found["frames_alone"] == 39  # three times up for 12 frames: one late, two longer
    alone, both = found["alone"].people, found["both"].people
    assert len(alone) == len(both) == 1
    assert std_m(both) < 0.2 * std_m(alone)
    assert both.mean[0, :2] == pytest.approx([3.0, 0.0], abs=0.05)


def test_a_depth_camera_that_counts_as_a_look_for_hands_would_keep_them_down(run):
    with pytest.raises(AssertionError):
        run("A depth camera", ", camera_looked=False")


@pytest.mark.parametrize("seed", range(5))
def test_three_ranges_at_once_are_a_position_within_15_cm(run, seed):
    found = run("A UWB tag", "default_rng(1)", f"default_rng({seed})")
    assert found["tracker"].people.customer.tolist() == [False]
    assert found["tracker"].people.id.tolist() == [-1]  # the same bystander from the first step on
    assert found["error_m"] < 0.15


def test_the_anchors_yaw_means_nothing(run):
    turned = run("A UWB tag", "[6.0, 0.0, 0.0]", "[6.0, 0.0, 2.0]")
    assert turned["error_m"] == pytest.approx(run("A UWB tag")["error_m"])


def test_the_number_of_a_tag_tells_who_is_who_after_a_silence(run):
    anchors = run("A UWB tag")["ANCHORS"]
    places_m = np.array([[2.0, 3.4], [2.0, 2.6]])
    range_m = np.linalg.norm(places_m[:, None] - anchors[:, :2], axis=2)

    def tags(*numbers):
        measured = [
            Measurements.ranges(each, 0.05, anchors, raised=False, identity=number)
            for each, number in zip(range_m, numbers, strict=True)
        ]
        return Measurements.concatenate(*measured)

    def first_one_s_y_m(*numbers):
        follower = tracker.PersonTracker()
        for frame in range(20):
            follower.step(frame * PERIOD_NS, tags(7, 8), camera_looked=False)
        follower.step(33 * PERIOD_NS, tags(*numbers), camera_looked=False)
        assert follower.people.id.tolist() == [-1, -2]
        return follower.people.mean[0, 1]

    assert first_one_s_y_m(7, 8) == pytest.approx(3.4, abs=0.1)
    assert first_one_s_y_m(8, 7) == pytest.approx(2.6, abs=0.1)


def test_a_range_refines_who_is_tracked_and_shows_nobody_new(run):
    (anchor, *_) = run("A UWB tag")["ANCHORS"]
    lone = Measurements.ranges([2.0], 0.05, anchor, raised=False)
    empty, known = tracker.PersonTracker(), tracker.PersonTracker()
    assert empty.step(0, lone, camera_looked=False).refused == 1
    assert len(empty.people) == 0
    for frame in range(3):
        before = known.step(frame * PERIOD_NS, Measurements.bearings(0.3, 0.02))
    after = known.step(2 * PERIOD_NS, lone, camera_looked=False)
    assert after.refused == 0
    assert std_m(after) < 0.5 * std_m(before)


def test_ranges_of_a_step_with_likeness_are_not_joined(run):
    tag = run("A UWB tag")["tag"]
    step = tracker.PersonTracker().step(0, tag, camera_looked=False, likeness=np.zeros((0, 3)))
    assert step.refused == 3


def test_a_button_that_is_not_pressed_is_a_hand_that_is_down(run):
    anchors, follower, raised = run("A UWB tag")["ANCHORS"], tracker.PersonTracker(), []
    range_m = np.linalg.norm([2.0, 3.0] - anchors[:, :2], axis=1)
    for is_pressed in [True] * 3 + [False] * 3:
        tag = Measurements.ranges(range_m, 0.05, anchors, raised=is_pressed, identity=7)
        tracks = follower.step(len(raised) * PERIOD_NS, tag)
        raised.append(tracks.raised.tolist())
    assert raised == [[False], [True], [True], [True], [True], [False]]


def test_each_measurement_of_one_body_counts(run):
    title = "Several measurements of one body"
    found = run(title)
    without_torso = run(
        title, "[0.00, 0.02], [3.0, 3.05], 0.05, 0.1, person=[0, 0]", "[0.0], [3.0], 0.05, 0.1"
    )
    without_laser = run(title, "concatenate(head_and_torso, laser)", "concatenate(head_and_torso)")
    assert std_m(found["tracks"]) < 0.95 * std_m(without_torso["tracks"])
    assert std_m(found["tracks"]) < 0.95 * std_m(without_laser["tracks"])


def test_the_doubt_about_the_sensor_s_pose_widens_what_is_believed():
    doubt = np.diag([0.04, 0.04, 0.01])
    sure, unsure = (
        PersonTracker().step(0, Measurements.polar(0.0, 3.0, 0.02, 0.1, **details))
        for details in ({}, {"sensor_pose_covariance": doubt})
    )
    assert std_m(unsure) > 2.0 * std_m(sure)


def test_a_measurement_is_a_raised_hand_unless_it_says_otherwise():
    assert all(
        measured.raised.all()
        for measured in (
            Measurements.polar(0.0, 3.0, 0.02, 0.1),
            Measurements.bearings(0.0, 0.02),
            Measurements.ranges(3.0, 0.1),
            at(3.0, 0.0),
        )
    )


def test_bystanders_are_among_the_people_and_customers_above_0(run):
    found = run("Customers and bystanders")
    assert found["bystanders"].mean[0, :2] == pytest.approx([2.0, 1.0], abs=0.1)
    assert found["customers"].mean[0, :2] == pytest.approx([4.0, -1.0], abs=0.1)


def test_what_cannot_be_used_is_said(run):
    found = run("Invalid measurements")
    assert "neither bearing nor range" in found["message"]
    assert found["tracks"].mean[0, 0] > 1.9


def walker(follower):
    for number in range(20):
        follower.step(number * PERIOD_NS, at(0.1 * number, 2.0))
    return follower.step(3_400_000_000, Measurements.none()).mean[0, 0]


def test_a_motion_of_one_s_own_takes_the_place_of_the_parameter(run):
    slowing = run("Another motion model")["slowing"]
    configured = [Config(motion=name) for name in ("cv", "imm")]
    assert walker(PersonTracker(configured[0])) > 3.2  # goes on at 1 m/s
    slowed = [walker(tracker.PersonTracker(each, motion=slowing)) for each in configured]
    assert slowed[0] == slowed[1] < 1.9 + 0.75


def test_an_association_of_one_s_own_takes_the_place_of_the_parameter(run):
    found, asked = run("Another association"), []

    def noted(log_odds):
        asked.append(log_odds)
        return found["greedy"](log_odds)

    several = Measurements.concatenate(at(2.0, 1.0), at(4.0, 0.0, raised=False))
    tag = Measurements.polar(0.0, 4.0, 0.02, 0.1, raised=False)
    for name in ("pda", "hungarian", "jpda"):
        follower = tracker.PersonTracker(Config(association=name), associate=noted)
        follower.step(0, Measurements.concatenate(several, tag))
        asked.clear()
        tracks = follower.step(PERIOD_NS, Measurements.concatenate(several, tag))
        assert [each.shape for each in asked] == [(2, 3)] * 3
        assert all(np.isneginf(each).any() for each in asked)
        assert tracks.raised.tolist() == [True]


def test_with_a_function_of_one_s_own_a_frame_is_python(run):
    greedy, called = run("Another association")["greedy"], []
    PersonTracker(associate=lambda odds: called.append(1) or greedy(odds)).step(0, at(2.0, 1.0))
    assert called


def test_likeness_tells_who_is_who(run):
    assert run("Likeness")["printed"] == "[ 0.4 -0.4] [-0.4  0.4]\n"


@pytest.mark.parametrize("nothing", ["np.nan", "0.0"])
def test_likeness_of_nan_or_0_tells_nothing(run, nothing):
    told = run("Likeness", "likeness=likeness if", f"likeness={nothing} * likeness if")["printed"]
    assert told == "[ 0.4 -0.4] [ 0.4 -0.4]\n"


def test_the_table_of_sensor_kinds_is_as_the_page_says():
    text = SECTIONS["A sensor kind of its own"]
    functions = re.findall(r"^\| `(\w+)` \|", text, re.MULTILINE)
    assert functions == ["expect", "jacobian", "area", "begin"]
    assert all(callable(getattr(sensor_kinds, name)) for name in functions)
    assert len(ABSENT) == len(SensorKind) == sensor_kinds.KINDS
    for path in re.findall(r"`((?:tracker|tests)/[\w/]+\.py)`", text):
        assert (PROJECT / path).is_file()
    for room, name in re.findall(r"`(\w+)/(\w+)\.py`", text):
        assert hasattr(importlib.import_module(f"tracker.tracking.{room}.{name}"), "POSITION")


def test_a_disparity_is_what_the_page_says_of_it():
    """1 / range: its slope, the area of a unit, and its variance as a range."""
    place_m, step_m = np.array([2.0, 1.0]), 1e-6
    range_m = np.hypot(*place_m)

    def h(x_m, y_m):
        return np.array([np.arctan2(y_m, x_m), 1.0 / np.hypot(x_m, y_m)])

    slope = np.stack(
        [
            (h(*(place_m + each)) - h(*(place_m - each))) / (2.0 * step_m)
            for each in step_m * np.eye(2)
        ],
        axis=1,
    )
    assert slope[1] == pytest.approx(-place_m / range_m**3)  # cos is x / range
    assert 1.0 / abs(np.linalg.det(slope)) == pytest.approx(range_m**3)
    by_disparity = (1.0 / (1.0 / range_m + step_m) - range_m) / step_m
    assert by_disparity**2 == pytest.approx(range_m**4, rel=1e-4)
