import numpy as np
import pytest

from nodes.shared.diagnostics import OK, WARN
from nodes.shared.image_silence import patience_s
from nodes.shared.topics import Input, Output
from tracker import CameraImage, Config
from tracker.messages import encode

START_NS = 1_000_000_000_000
PERIOD_NS = 100_000_000


def show(wire, first, count):
    """Images of a raised hand, ten a second, on both clocks."""
    for number in range(first, first + count):
        stamp_ns = START_NS + number * PERIOD_NS
        wire.base(stamp_ns - 1_000_000)
        wire.scan(stamp_ns - 2_000_000)
        wire.base(stamp_ns + 1_000_000)
        wire.image(stamp_ns)
        wire.settle()
        wire.steady_ns += PERIOD_NS


def pass_time(wire, seconds):
    """Nothing but the node's own reports, two a second."""
    for _ in range(round(2 * seconds)):
        wire.steady_ns += 500_000_000
        wire.core.diagnose()
        wire.settle()


def raised(wire):
    return [message.data for message in wire.messages(Output.HAND_RAISED)]


def identities(wire):
    return [item.id for item in wire.messages(Output.TRACKS)[-1].detections]


def test_nobody_is_reported_two_seconds_after_the_last_image(wire):
    show(wire, 0, 10)
    assert raised(wire)[-1]
    assert identities(wire) == ["1"]
    pass_time(wire, 2.0)
    assert not raised(wire)[-1]
    assert identities(wire) == []
    assert len(wire.messages(Output.MARKERS)[-1].markers) == 1, "who was shown is deleted"
    assert wire.core.release() == (False, "nobody is selected")


def test_silence_is_said_once_on_the_topics_and_always_in_the_diagnostics(wire):
    show(wire, 0, 10)
    pass_time(wire, 10.0)
    assert raised(wire).count(False) - raised(wire).index(True) == 1
    customers = wire.diagnose()["customers"]
    assert customers.level == WARN
    assert customers.message == "nobody is reported: no image was processed for 10.1 s"


def test_a_short_pause_changes_nothing(wire):
    show(wire, 0, 10)
    pass_time(wire, 1.0)
    assert raised(wire)[-1]


def test_the_same_person_is_known_again_once_images_are_back(wire):
    show(wire, 0, 10)
    pass_time(wire, 2.0)
    show(wire, 30, 1)
    assert not raised(wire)[-1], "one image is no streak"
    show(wire, 31, 2)
    assert raised(wire)[-1]
    assert identities(wire) == ["1"]
    assert wire.diagnose()["customers"].level == OK


def broken(wire, stamp_ns):
    picture = encode(CameraImage(stamp_ns, "camera_link", np.zeros((48, 64, 3), np.uint8)))
    wire.core.receive(Input.IMAGES, picture._replace(cdr=picture.cdr[:-100]))


def repeated(wire, stamp_ns):
    wire.image(START_NS + 9 * PERIOD_NS)


@pytest.mark.parametrize("image", [broken, repeated])
def test_images_that_cannot_be_used_are_silence(wire, image):
    show(wire, 0, 10)
    wire.base(START_NS + 40 * PERIOD_NS)
    for number in range(10, 30):
        image(wire, START_NS + number * PERIOD_NS)
        wire.settle()
        wire.steady_ns += PERIOD_NS
        wire.core.diagnose()
    wire.settle()
    assert not raised(wire)[-1]


def test_an_image_that_waits_for_its_transform_is_no_silence(make_wire):
    wire = make_wire(Config(transform_wait_s=5.0))
    wire.mounting()
    show(wire, 0, 10)
    for _ in range(4):  # they come, yet none is as late as the image
        wire.base(START_NS + 9 * PERIOD_NS + 2_000_000)
        wire.image(START_NS + 10 * PERIOD_NS)
        wire.steady_ns += 500_000_000
        wire.core.diagnose()
    assert raised(wire)[-1]


def test_a_worker_that_is_busy_is_no_silent_camera(wire):
    show(wire, 0, 10)
    wire.base(START_NS + 11 * PERIOD_NS)
    wire.detector.may_run.clear()
    wire.image(START_NS + 10 * PERIOD_NS)
    wire.until(lambda: len(wire.core._images) == 0)
    wire.steady_ns += 5_000_000_000
    wire.core.diagnose()
    wire.detector.may_run.set()
    wire.settle()
    assert all(raised(wire)[2:])


def test_a_low_processing_rate_has_patience_for_two_of_its_periods():
    assert patience_s(Config()) == Config().image_silence_s
    assert patience_s(Config(processing_rate=0.5)) == 4.0
    assert patience_s(Config(image_silence_s=5.0)) == 5.0


def test_a_disabled_node_waits_for_no_camera(wire):
    show(wire, 0, 10)
    wire.core.enable(False)
    wire.settle()
    count = len(raised(wire))
    pass_time(wire, 5.0)
    assert len(raised(wire)) == count
    customers = wire.diagnose()["customers"]
    assert (customers.level, customers.message) == (OK, "nobody is reported: disabled")
