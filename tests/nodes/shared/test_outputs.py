import numpy as np
import pytest

from nodes.shared.topics import Output
from tracker import Config

START_NS = 1_000_000_000_000
PERIOD_NS = 100_000_000


def show(wire, numbers, is_located):
    for number in numbers:
        stamp_ns = START_NS + number * PERIOD_NS
        if is_located:
            wire.base(stamp_ns - 1_000_000)
            wire.base(stamp_ns + 1_000_000)
        wire.scan(stamp_ns)
        wire.image(stamp_ns)
        wire.steady_ns += 400_000_000  # longer than an image waits
        wire.settle()


def frames(wire, output):
    """The frames that people were shown in, one for each message."""
    if output is Output.TRACKS:
        return [message.header.frame_id for message in wire.messages(output)]
    return [message.markers[0].header.frame_id for message in wire.messages(output)]


@pytest.mark.parametrize("output", [Output.TRACKS, Output.MARKERS])
@pytest.mark.parametrize(
    ("config", "frame_ids"),
    [
        (Config(), ["camera_link"] * 5),
        (Config(camera_frame="", camera_axes="body"), ["camera_link"] * 5),
        (Config(camera_frame="eye_optical_frame"), []),
    ],
    ids=["body axes", "named by the image", "optical axes"],
)
def test_without_any_transform_people_are_shown_in_the_cameras_frame_or_not_at_all(
    make_wire, config, frame_ids, output
):
    wire = make_wire(config)
    show(wire, range(5), is_located=False)
    assert frames(wire, output) == frame_ids
    assert wire.messages(Output.HAND_RAISED)[-1].data
    assert wire.messages(Output.CUSTOMER_POSE) == []


@pytest.mark.parametrize("output", [Output.TRACKS, Output.MARKERS])
def test_while_transforms_are_missing_nobody_is_shown_anywhere(wire, output):
    show(wire, range(5), is_located=True)
    show(wire, range(5, 10), is_located=False)
    assert frames(wire, output) == ["map"] * 5
    assert all(message.data for message in wire.messages(Output.HAND_RAISED)[1:])
    show(wire, range(10, 12), is_located=True)
    assert frames(wire, output) == ["map"] * 7


def test_nobody_is_taken_back_where_nobody_was_shown(make_wire):
    wire = make_wire(Config(camera_frame="eye_optical_frame"))
    show(wire, range(5), is_located=False)
    wire.core.enable(False)
    wire.settle()
    assert not wire.messages(Output.HAND_RAISED)[-1].data
    assert frames(wire, Output.TRACKS) == frames(wire, Output.MARKERS) == []


def test_tracks_say_since_when_how_fast_and_how_far_all_of_it_can_be_trusted(wire):
    show(wire, range(8), is_located=True)
    (person,) = wire.messages(Output.TRACKS)[-1].detections
    (raised,) = wire.messages(Output.RAISED_HANDS)[-1].detections
    words = {result.hypothesis.class_id.partition("/")[0]: result for result in person.results}
    assert words.keys() >= {"hand_raised", "age_s", "raised_since", "velocity"}
    stamp = raised.header.stamp
    since = f"raised_since/{stamp.sec}.{stamp.nanosec:09d}"
    assert words["raised_since"].hypothesis.class_id == since
    age_s = float(words["age_s"].hypothesis.class_id.partition("/")[2])
    assert 0.5 <= age_s <= 0.8
    assert abs(words["velocity"].pose.pose.position.x) < 1.0
    variances = person.results[0].pose.covariance[::7]
    assert all(variances > 0.0)
    assert variances[5] == pytest.approx(np.pi**2 / 3), "nobody knows where they look"
    assert words["velocity"].pose.covariance[0] > 0.0


@pytest.mark.parametrize(("x_m", "z_std_m"), [(0.0, 1.0), (2.0, 0.05)], ids=["camera", "room"])
def test_only_of_a_frame_of_the_room_the_floor_is_known(wire, x_m, z_std_m):
    stamp_ns = START_NS
    for number in range(6):
        stamp_ns = START_NS + number * PERIOD_NS
        wire.base(stamp_ns - 1_000_000, x_m)
        wire.base(stamp_ns + 1_000_000, x_m)
        wire.scan(stamp_ns)
        wire.image(stamp_ns)
        wire.settle()
    (person,) = wire.messages(Output.TRACKS)[-1].detections
    assert person.results[0].pose.covariance[14] == pytest.approx(z_std_m**2)
