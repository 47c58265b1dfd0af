import json

import pytest

from nodes.shared.topics import Input, Output
from tracker import Config, Hands
from tracker.messages.types import STRING, build, serialize

START_NS = 1_000_000_000_000
PERIOD_NS = 100_000_000


def show(wire, numbers, is_located=True):
    for number in numbers:
        stamp_ns = START_NS + number * PERIOD_NS
        if is_located:
            wire.base(stamp_ns - 1_000_000)
            wire.base(stamp_ns + 1_000_000)
        wire.scan(stamp_ns)
        wire.image(stamp_ns)
        wire.steady_ns += 400_000_000
        wire.settle()


def say(wire, text):
    wire.core.receive(Input.COMMANDS, serialize(build(STRING, data=text)))
    wire.settle()
    return wire.messages(Output.ANSWERS)[-1].data


def stamp_ns(header):
    return header.stamp.sec * 10**9 + header.stamp.nanosec


def words(detection):
    return [result.hypothesis.class_id for result in detection.results]


def test_the_list_says_number_state_since_when_pose_and_approach_pose_together(wire):
    show(wire, range(8))
    message = wire.messages(Output.WAITING_LIST)[-1]
    assert message.header.frame_id == "map"
    assert stamp_ns(message.header) == START_NS + 7 * PERIOD_NS
    (anna,) = message.detections
    assert anna.id == "1"
    assert stamp_ns(anna.header) == START_NS + PERIOD_NS  # the second image raises
    assert words(anna) == ["waiting", "selected", "hand_raised", "in_sight", "track_1", "approach"]
    pose, approach = anna.results[0].pose.pose, anna.results[-1].pose.pose
    assert pose.position.x - approach.position.x == pytest.approx(0.8, abs=0.01)
    assert abs(pose.orientation.w) < 0.1  # the customer looks at the robot,
    assert abs(approach.orientation.w) > 0.9  # and the robot at the customer
    assert anna.results[0].pose.covariance[0] > 0.0


def test_raised_hands_bear_the_stamp_of_the_image_and_of_the_raise(wire):
    show(wire, range(4))
    nobody, *_, last = wire.messages(Output.RAISED_HANDS)
    assert len(nobody.detections) == 0
    assert stamp_ns(last.header) == START_NS + 3 * PERIOD_NS
    assert stamp_ns(last.detections[0].header) == START_NS + PERIOD_NS
    said = [bool(len(item.detections)) for item in wire.messages(Output.RAISED_HANDS)]
    assert said == [item.data for item in wire.messages(Output.HAND_RAISED)]


def test_where_the_frame_is_unknown_a_raised_hand_has_no_place(make_wire):
    wire = make_wire(Config(camera_frame="eye_optical_frame"))
    show(wire, range(4), is_located=False)
    (anna,) = wire.messages(Output.RAISED_HANDS)[-1].detections
    assert (anna.id, len(anna.results)) == ("1", 0)
    assert wire.messages(Output.WAITING_LIST) == []


def test_commands_are_answered_and_show_in_the_list_at_once(wire):
    show(wire, range(8))
    assert say(wire, "serve 1") == "serve 1: done: customer 1 is being served"
    assert words(wire.messages(Output.WAITING_LIST)[-1].detections[0])[0] == "being_served"
    assert say(wire, "serve 4").startswith("serve 4: refused: no customer has the number 4")
    assert say(wire, "sing").startswith("sing: refused: 'sing' is not a command")


def test_a_node_that_is_switched_off_keeps_who_waits(wire):
    show(wire, range(8))
    wire.core.enable(False)
    wire.settle()
    (anna,) = wire.messages(Output.WAITING_LIST)[-1].detections
    assert words(anna) == ["waiting", "approach"]
    wire.core.reset("test")
    wire.core.enable(True)
    wire.detector.find = lambda image, hints: Hands.none()
    show(wire, range(20, 22))
    assert len(wire.messages(Output.WAITING_LIST)[-1].detections) == 0


def test_the_list_outlives_the_node_in_its_file(make_wire, tmp_path):
    config = Config(waiting_list_file=str(tmp_path / "kept" / "calls.json"))
    first = make_wire(config)
    first.mounting()
    show(first, range(8))
    say(first, "serve 1")
    first.core.stop()
    second = make_wire(config)
    second.mounting()
    show(second, range(20, 24))
    (anna,) = second.messages(Output.WAITING_LIST)[-1].detections
    assert (anna.id, words(anna)[0]) == ("1", "being_served")
    assert "track_2" in words(anna)


def test_a_file_that_is_no_list_is_said_and_replaced(make_wire, tmp_path):
    path = tmp_path / "calls.json"
    path.write_text("{}")
    wire = make_wire(Config(waiting_list_file=str(path)))
    assert any("not a waiting list" in text for level, text in wire.logged if level == "warning")
    wire.mounting()
    show(wire, range(8))
    assert json.loads(path.read_text())["callers"][0]["id"] == 1


def test_a_kept_list_of_a_later_time_is_left_out_and_said(make_wire, tmp_path):
    config = Config(waiting_list_file=str(tmp_path / "calls.json"))
    first = make_wire(config)
    first.mounting()
    show(first, range(1000, 1008))
    first.core.stop()
    second = make_wire(config)
    second.mounting()
    show(second, range(8))
    assert any("later than the images" in text for _, text in second.logged)
    assert [item.id for item in second.messages(Output.WAITING_LIST)[-1].detections] == ["1"]


def test_release_by_the_service_is_by_number(wire):
    show(wire, range(8))
    assert wire.core.release() == (True, "customer 1 is released")
    wire.settle()
    assert words(wire.messages(Output.WAITING_LIST)[-1].detections[0])[0] == "gone"
