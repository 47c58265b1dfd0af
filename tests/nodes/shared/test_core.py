import threading
from dataclasses import replace

import numpy as np
import pytest

from nodes.shared.diagnostics import WARN
from nodes.shared.topics import Input, Output
from tracker import Config
from tracker.geometry import RigidTransform
from tracker.messages import Encoded, encode
from tracker.messages.types import build, serialize
from tracker.simulation.hand_signs import draw_hands
from tracker.transforms import StampedTransform

START_NS = 1_000_000_000_000
FRAME_NS = 33_333_333
PERIOD_NS = 100_000_000
IMAGE = "sensor_msgs/msg/Image"


def play(wire, frames, start_ns=START_NS):
    """A 30 Hz camera and a base that reports before and after each image."""
    for number in range(frames):
        stamp_ns = start_ns + number * FRAME_NS
        wire.base(stamp_ns - 1_000_000)
        wire.scan(stamp_ns - 2_000_000)
        wire.base(stamp_ns + 1_000_000)
        wire.image(stamp_ns)
        wire.settle()


def test_of_thirty_images_a_second_ten_are_processed(wire):
    play(wire, 91)
    assert len(wire.detector.stamps_ns) == 31
    assert set(wire.detector.stamps_ns) == {START_NS + i * 3 * FRAME_NS for i in range(31)}


def test_the_pose_comes_before_the_bool_of_the_same_image(wire):
    play(wire, 31)
    kinds = [
        kind for kind, _ in wire.published if kind in (Output.CUSTOMER_POSE, Output.HAND_RAISED)
    ]
    assert kinds.count(Output.CUSTOMER_POSE) >= 5
    for first, second in zip(kinds, [*kinds[1:], Output.HAND_RAISED], strict=True):
        assert first is Output.HAND_RAISED or second is Output.HAND_RAISED
    pose = wire.messages(Output.CUSTOMER_POSE)[-1]
    assert pose.header.frame_id == "map"
    assert pose.pose.position.x == pytest.approx(2.0, abs=0.2)


def test_views_are_stamped_as_their_source_and_made_for_listeners_only(wire):
    play(wire, 4)
    assert wire.messages(Output.DEBUG_IMAGE)[-1].header.stamp.nanosec == 3 * FRAME_NS
    wire.listened.clear()
    before = len(wire.published)
    play(wire, 4, START_NS + 4 * FRAME_NS)
    kinds = {kind for kind, _ in wire.published[before:]}
    assert not kinds & {Output.DEBUG_IMAGE, Output.MARKERS, Output.TRACKS}


def test_an_image_waits_for_the_transform_of_its_own_stamp(wire):
    wire.base(START_NS - 1_000_000)
    wire.image(START_NS)
    wire.base(START_NS - 500_000)
    assert wire.detector.stamps_ns == []
    wire.base(START_NS + 1_000_000)
    wire.settle()
    assert wire.diagnose()["transforms"].message == "the camera's position is known"


def test_an_image_without_transform_waits_no_longer_than_told(wire):
    wire.base(START_NS - 1_000_000)
    wire.image(START_NS)
    wire.steady_ns += 299_000_000
    wire.base(START_NS - 500_000)
    assert wire.detector.stamps_ns == []
    wire.steady_ns += 2_000_000
    wire.settle()
    assert wire.messages(Output.CUSTOMER_POSE) == []


def test_images_set_free_by_one_transform_are_processed_in_order(wire):
    wire.base(START_NS - 1_000_000)
    stamps = [START_NS + i * PERIOD_NS for i in range(3)]
    for stamp_ns in stamps:
        wire.image(stamp_ns)
    wire.base(stamps[-1] + 1_000_000)
    wire.settle()
    assert wire.detector.stamps_ns == stamps


def pile_up(wire, count):
    """The worker is busy with the first of many images."""
    wire.base(START_NS - 1_000_000)
    wire.base(START_NS + 2_000_000_000)
    wire.detector.may_run.clear()
    stamps = [START_NS + i * PERIOD_NS for i in range(count)]
    wire.image(stamps[0])
    wire.until(lambda: wire.core.images_waiting == 0)
    for stamp_ns in stamps[1:]:
        wire.image(stamp_ns)
    return stamps


def test_a_worker_that_was_held_up_catches_up_with_a_few_images(wire):
    stamps = pile_up(wire, 8)
    wire.detector.may_run.set()
    wire.settle()
    assert wire.detector.stamps_ns == [stamps[0], *stamps[-3:]]
    assert wire.diagnose()["processing"].values["lost"] == "4"


def test_a_worker_that_is_too_slow_takes_the_newest_image_only(wire):
    stamps = pile_up(wire, 8)
    wire.steady_ns += 1_000_000_000  # the first image took so long
    wire.detector.may_run.set()
    wire.settle()
    assert wire.detector.stamps_ns == [stamps[0], stamps[-1]]
    assert wire.diagnose()["processing"].values["lost"] == "6"


def test_nothing_grows_while_the_worker_is_held_up(wire):
    wire.base(START_NS - 1_000_000)
    wire.base(START_NS + 1)
    wire.detector.may_run.clear()
    wire.image(START_NS)
    wire.until(lambda: wire.core.images_waiting == 0)
    for number in range(1, 5000):
        wire.image(START_NS + number * PERIOD_NS)
        wire.scan(START_NS + number)
        wire.base(START_NS + number)
    assert wire.core.images_waiting <= 16
    assert sum(len(kept) for kept in wire.core._inbox._messages.values()) <= 2541


def test_callbacks_never_wait_for_the_worker(wire):
    wire.detector.may_run.clear()
    wire.base(START_NS - 1)
    wire.base(START_NS + 1)
    wire.image(START_NS)
    wire.until(lambda: wire.core.images_waiting == 0)

    def everything():
        wire.image(START_NS + PERIOD_NS)
        wire.scan(START_NS)
        wire.core.release()
        wire.core.enable(False)
        wire.core.enable(True)
        wire.core.reset("test")
        wire.core.configure(Config(processing_rate=5.0))
        wire.core.diagnose()

    caller = threading.Thread(target=everything)
    caller.start()
    caller.join(5.0)
    assert not caller.is_alive()


def test_a_recording_that_loops_resets_everybody_once(wire):
    play(wire, 31)
    before = len(wire.detector.stamps_ns)
    wire.base(START_NS - 2_000_000)
    wire.base(START_NS - 1_500_000)
    wire.image(START_NS)  # alone it would be an error
    play(wire, 30, START_NS + FRAME_NS)
    assert len(wire.detector.stamps_ns) - before == 10
    assert [text for level, text in wire.logged if "Everybody is forgotten" in text] == [
        "Everybody is forgotten: stamps jumped back by 0.967 s: tracks were reset."
    ]
    assert wire.diagnose()["processing"].values["resets"] == "1"
    assert wire.messages(Output.TRACKS)[-1].detections[0].id != "1"


def test_one_image_with_an_absurd_stamp_changes_nothing(wire):
    play(wire, 31)
    for stamp_ns in (0, 2**31 * 10**9 - 1, START_NS - 5 * 10**9):
        wire.image(stamp_ns)
        start_ns = wire.detector.stamps_ns[-1] + 3 * FRAME_NS
        play(wire, 7, start_ns)
    assert wire.detector.resets == 0
    assert wire.diagnose()["images"].values["malformed"] == "3"
    assert {item.id for item in wire.messages(Output.TRACKS)[-1].detections} == {"1"}


def test_one_transform_with_an_absurd_stamp_changes_nothing(wire):
    play(wire, 4)
    wire.base(2**31 * 10**9 - 1)
    wire.base(0)
    play(wire, 7, START_NS + 4 * FRAME_NS)
    wire.diagnose()
    assert wire.diagnose()["transforms"].values["malformed"] == "2"
    assert wire.messages(Output.TRACKS)[-1].header.stamp.nanosec >= 7 * FRAME_NS


def test_what_a_customer_says_is_told_once_and_taken_back(wire, monkeypatch):
    see = wire.detector.find
    fist = draw_hands(
        "fist", 1, np.random.default_rng(5), turn_max_deg=3.0, size_px=(20.0, 20.1)
    )  # fmt: skip

    def shown(image, hints):
        return replace(see(image, hints), landmarks_px=fist.landmarks_px + np.array([32.0, 24.0]))

    monkeypatch.setattr(wire.detector, "find", shown)
    play(wire, 31)
    assert [message.data for message in wire.messages(Output.GESTURE)] == ["1 fist"]
    wire.core.enable(False)
    wire.settle()
    assert [message.data for message in wire.messages(Output.GESTURE)] == ["1 fist", "1 none"]


def test_two_customers_take_turns_by_release(wire):
    play(wire, 31)
    assert wire.core.release() == (True, "customer 1 is released")
    play(wire, 4, START_NS + 31 * FRAME_NS)
    assert wire.core.release() == (False, "nobody is selected")


def test_a_disabled_core_takes_its_raised_hand_back(wire):
    play(wire, 31)
    assert wire.messages(Output.HAND_RAISED)[-1].data
    assert wire.core.enable(False) == "disabled"
    wire.until(lambda: not wire.messages(Output.HAND_RAISED)[-1].data)
    before = len(wire.detector.stamps_ns)
    wire.image(START_NS + 40 * FRAME_NS)
    assert wire.diagnose()["processing"].message == "disabled"
    assert wire.core.enable(False) == "already disabled"
    assert wire.core.enable(True) == "enabled"
    play(wire, 4, START_NS + 50 * FRAME_NS)
    assert len(wire.detector.stamps_ns) == before + 2


def test_a_stopped_core_takes_its_raised_hand_back(wire):
    play(wire, 31)
    wire.core.stop()
    assert not wire.messages(Output.HAND_RAISED)[-1].data


def test_a_new_rate_holds_from_the_next_image_on(wire):
    play(wire, 4)
    wire.core.configure(wire.core.config.replace(processing_rate=30.0))
    for number in range(4, 10):
        stamp_ns = START_NS + number * FRAME_NS
        wire.base(stamp_ns + 1_000_000)
        wire.image(stamp_ns)
        wire.settle()
    assert len(wire.detector.stamps_ns) == 8


def image_message(**changes):
    fields = {
        "height": 4, "width": 4, "encoding": "bgr8", "step": 12, "data": bytes(48),
    } | changes  # fmt: skip
    header = build(
        "std_msgs/msg/Header",
        stamp=build("builtin_interfaces/msg/Time", sec=START_NS // 10**9),
        frame_id="camera_link",
    )
    fields["data"] = np.frombuffer(fields["data"], np.uint8)
    return serialize(build(IMAGE, header=header, **fields))


BROKEN_IMAGES = {
    "empty": b"",
    "cut-header": image_message().cdr[:14],
    "cut-pixels": image_message().cdr[:-8],
    "wrong-size": image_message(height=400).cdr,
    "huge-size": image_message(height=2**31, width=2**31).cdr,
    "huge-length": image_message().cdr[:-52] + b"\xff\xff\xff\xff" + bytes(48),
    "unknown-encoding": image_message(encoding="fancy8").cdr,
    "no-pixels": image_message(height=0, width=0, step=0, data=b"").cdr,
    "negative-seconds": b"\0\1\0\0" + b"\xff" * 4 + image_message().cdr[8:],
    "billion-nanoseconds": b"\0\1\0\0" + bytes(4) + b"\xff" * 4 + image_message().cdr[12:],
    "endless-frame-name": image_message().cdr[:12]
    + b"\xff\xff\xff\x7f"
    + image_message().cdr[16:],
    "frame-name-no-text": image_message().cdr[:16] + b"\xff\xfe" + image_message().cdr[18:],
    "other-encapsulation": b"\0\x07" + image_message().cdr[2:],
}


@pytest.mark.parametrize("cdr", BROKEN_IMAGES.values(), ids=BROKEN_IMAGES)
def test_a_broken_image_is_counted_and_logged_once_and_the_next_is_served(wire, cdr):
    wire.base(START_NS - 1_000_000)
    wire.base(START_NS + 1_000_000)
    for _ in range(3):
        wire.core.receive(Input.IMAGES, Encoded(IMAGE, cdr))
        wire.settle()
    play(wire, 7, START_NS + FRAME_NS)
    assert len(wire.detector.stamps_ns) >= 2
    said = [text for level, text in wire.logged if level == "warning"]
    assert 1 <= len(said) <= 2  # of three the second and third may repeat a stamp
    assert wire.diagnose()["images"].values["malformed"] == "3"


def scan_message(**changes):
    fields = {
        "angle_min": -1.0, "angle_max": 1.0, "angle_increment": 0.02, "range_min": 0.1,
        "range_max": 10.0, "ranges": np.ones(101, np.float32),
    } | changes  # fmt: skip
    return serialize(build("sensor_msgs/msg/LaserScan", **fields))


BROKEN_SCANS = {
    "empty": b"",
    "cut": scan_message().cdr[:-20],
    "huge-length": scan_message().cdr[:-412] + b"\xff\xff\xff\xff" + bytes(408),
    "zero-increment": scan_message(angle_increment=0.0).cdr,
    "other-turn": scan_message(angle_max=3.0).cdr,
    "nan-start": scan_message(angle_min=float("nan")).cdr,
}


@pytest.mark.parametrize("cdr", BROKEN_SCANS.values(), ids=BROKEN_SCANS)
def test_a_broken_scan_is_counted_and_logged_once(wire, cdr):
    for _ in range(5):
        wire.core.receive(Input.SCAN, Encoded("sensor_msgs/msg/LaserScan", cdr))
    play(wire, 31)
    assert wire.diagnose()["scan"].values["malformed"] == "5"
    assert len([text for level, text in wire.logged if level == "warning"]) == 1
    assert wire.messages(Output.CUSTOMER_POSE)


def test_broken_transforms_are_counted_and_the_good_ones_used(wire):
    unusable = StampedTransform(START_NS, "map", "base_link", RigidTransform((float("nan"), 0, 0)))
    wire.core.receive(Input.TRANSFORMS, encode(unusable))
    wire.core.receive(
        Input.TRANSFORMS, Encoded("tf2_msgs/msg/TFMessage", b"\0\1\0\0" + b"\xff" * 9)
    )
    play(wire, 4)
    assert wire.diagnose()["transforms"].values["malformed"] == "2"
    assert wire.diagnose()["transforms"].message != "stale"
    assert len(wire.detector.stamps_ns) == 2


def test_a_scanner_of_which_nothing_is_used_is_told_with_its_reason(wire):
    for number in range(40):
        stamp_ns = START_NS + number * FRAME_NS
        wire.scan(stamp_ns - 800_000_000)  # another clock
        wire.base(stamp_ns - 1_000_000)
        wire.base(stamp_ns + 1_000_000)
        wire.image(stamp_ns)
        wire.settle()
    status = wire.diagnose()["scan"]
    assert status.level == WARN
    assert "no scan was used in the last 14 images" in status.message
    assert "0.8" in status.message
    play(wire, 4, START_NS + 40 * FRAME_NS)
    assert wire.diagnose()["scan"].message == "coming"


def test_depth_gives_the_pose_where_no_scanner_is(wire):
    wire.mounting()
    wire.base(START_NS - 1_000_000)
    for number in range(4):
        stamp_ns = START_NS + number * PERIOD_NS
        wire.base(stamp_ns + 1)
        wire.depth(stamp_ns)
        wire.image(stamp_ns)
        wire.settle()
    assert wire.messages(Output.CUSTOMER_POSE)[-1].pose.position.x == pytest.approx(2.0, abs=0.2)
