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
