"""Golden bytes are packed by hand after the CDR rules: 4 bytes of encapsulation, then every number
aligned to its own size, strings and lists with a 32-bit length, strings with a closing zero."""

import struct
from dataclasses import replace

import numpy as np
import pytest

from tracker.camera import CameraModel
from tracker.containers import CameraImage, Hands, OccupancyGrid, Pose, Scan, Tracks, Truth
from tracker.errors import RecordingError
from tracker.geometry import RigidTransform
from tracker.gesture import Gesture
from tracker.messages import CameraInfo, Encoded, decode, encode, encode_tracks
from tracker.messages.types import deserialize
from tracker.transforms import StampedTransform

STAMP_NS = 1_700_000_000_123_456_789


class Cdr:
    """Little-endian CDR, as far as these messages need it."""

    def __init__(self):
        self.body = b""

    def put(self, code, *values):
        size = struct.calcsize(code)
        for value in values:
            self.body += b"\0" * (-len(self.body) % size) + struct.pack("<" + code, value)
        return self

    def text(self, value):
        data = value.encode() + b"\0"
        self.put("I", len(data))
        self.body += data
        return self

    def header(self, stamp_ns, frame):
        return self.put("i", stamp_ns // 10**9).put("I", stamp_ns % 10**9).text(frame)

    @property
    def bytes(self):
        return b"\x00\x01\x00\x00" + self.body


def tracks(**changes):
    values = {
        "stamp_ns": STAMP_NS,
        "id": [7, 12],
        "mean": [[1.0, 2.0, 0.1, 0.2], [3.0, 4.0, 0.0, 0.0]],
        "covariance": np.arange(32.0).reshape(2, 4, 4),
        "existence": [0.9, 0.6],
        "confirmed": [True, False],
        "raised": [True, False],
        "raised_since_ns": [5, -1],
        "age_s": [1.0, 2.0],
        "unseen_s": [0.0, 0.5],
        "hand": [0, -1],
        "selected_id": 7,
    }
    return Tracks(**(values | changes))


@pytest.mark.parametrize("value", [True, False])
def test_bool_has_the_bytes_of_ros(value):
    assert encode(value) == ("std_msgs/msg/Bool", b"\x00\x01\x00\x00" + bytes([value]))
    assert encode(np.bool_(value)) == encode(value)


def test_pose_has_the_bytes_of_ros():
    pose = Pose(STAMP_NS, "map", (1.0, -2.0, 0.5), (0.0, 0.0, 0.6, 0.8))
    golden = Cdr().header(STAMP_NS, "map").put("d", 1.0, -2.0, 0.5, 0.0, 0.0, 0.6, 0.8)
    assert encode(pose) == ("geometry_msgs/msg/PoseStamped", golden.bytes)


#: What one knows of a pose that nobody estimates: the floor is flat to 5 cm, people stand upright
#: to .2 rad, and look anywhere.
UNESTIMATED = {14: 0.05**2, 21: 0.2**2, 28: 0.2**2, 35: np.pi**2 / 3}


def test_tracks_have_the_bytes_of_vision_msgs():
    golden = Cdr().header(STAMP_NS, "odom").put("I", 2)
    people = [
        ("7", (1.0, 2.0, 0.1, 0.2), 0.9,
         ["hand_raised", "age_s/1.000", "raised_since/1699999999.500000001"]),
        ("12", (3.0, 4.0, 0.0, 0.0), 0.6, ["hand_lowered", "age_s/2.000"]),
    ]  # fmt: skip
    for row, (name, (x, y, vx, vy), score, words) in enumerate(people):
        place, velocity = [0.0] * 36, [0.0] * 36
        for index, value in UNESTIMATED.items():
            place[index] = value
        first = 16.0 * row
        place[0], place[1], place[6], place[7] = first, first + 1.0, first + 4.0, first + 5.0
        velocity[0], velocity[1] = first + 10.0, first + 11.0
        velocity[6], velocity[7] = first + 14.0, first + 15.0
        golden.header(STAMP_NS, "odom").put("I", len(words) + 1)
        for word in words:
            golden.text(word).put("d", score)
            golden.put("d", x, y, 0.0, 0.0, 0.0, 0.0, 1.0, *place)
        golden.text("velocity").put("d", score)
        golden.put("d", vx, vy, 0.0, 0.0, 0.0, 0.0, 1.0, *velocity)
        golden.put("d", x, y, 0.85, 0.0, 0.0, 0.0, 1.0, 0.5, 0.5, 1.7)
        golden.text(name)

    type_name, cdr = encode(
        tracks(raised_since_ns=[1_699_999_999_500_000_001, -1]), frame_id="odom"
    )

    assert type_name == "vision_msgs/msg/Detection3DArray"
    assert cdr == golden.bytes


def test_at_the_cameras_height_nobody_knows_where_the_floor_is():
    message = deserialize(*encode_tracks(tracks(), frame_id="camera_link", is_on_floor=False))
    assert message.detections[0].results[0].pose.covariance[14] == 1.0


def test_what_is_most_likely_by_its_score_is_the_hand():
    """Programs that take the class with the highest score get the first one."""
    for person in deserialize(*encode(tracks(gesture=[Gesture.WAVE, Gesture.NONE]))).detections:
        best = max(person.results, key=lambda result: result.hypothesis.score)
        assert best.hypothesis.class_id.startswith("hand_")


def test_nobody_is_an_empty_list_of_detections():
    golden = Cdr().header(STAMP_NS, "map").put("I", 0)
    assert encode(Tracks.none(STAMP_NS)).cdr == golden.bytes


def test_an_image_comes_back_pixel_by_pixel():
    bgr = np.random.default_rng(1).integers(0, 256, (5, 7, 3), dtype=np.uint8)
    for picture in (bgr, bgr[:, ::-1]):  # the second is not contiguous
        (image,) = decode(*encode(CameraImage(STAMP_NS, "camera", picture)))
        assert (image.stamp_ns, image.frame_id) == (STAMP_NS, "camera")
        np.testing.assert_array_equal(image.bgr, picture)


def test_a_compressed_image_comes_back_nearly():
    bgr = np.full((40, 60, 3), (20, 120, 220), dtype=np.uint8)
    message = encode(CameraImage(STAMP_NS, "camera", bgr), jpeg_quality=90)
    assert message.type_name == "sensor_msgs/msg/CompressedImage"
    (image,) = decode(*message)
    assert (image.stamp_ns, image.frame_id) == (STAMP_NS, "camera")
    np.testing.assert_allclose(image.bgr, bgr, atol=3)


def test_a_scan_comes_back_in_single_precision():
    scan = Scan(STAMP_NS, "laser", -1.5, -0.01, 0.1, 12.0, np.array([1.25, np.inf, np.nan, 3.1]))
    (back,) = decode(*encode(scan))
    assert (back.stamp_ns, back.frame_id) == (STAMP_NS, "laser")
    assert back.angle_increment_rad == pytest.approx(-0.01)
    np.testing.assert_allclose(back.ranges_m, scan.ranges_m, rtol=1e-7)
    assert deserialize(*encode(scan)).angle_max == pytest.approx(-1.53)
    assert len(decode(*encode(Scan(0, "", 0.0, 0.0, 0.0, 0.0, np.zeros(0))))[0].ranges_m) == 0


def test_transforms_come_back_exactly_and_static_as_told():
    moving = StampedTransform(
        STAMP_NS, "map", "base", RigidTransform((1.0, 2.0, 3.0), (0.1, 0.2, 0.3, 0.9))
    )
    lasting = StampedTransform(0, "base", "laser", RigidTransform(), is_static=True)
    assert decode(*encode(moving)) == [moving]
    assert decode(*encode([lasting, lasting]), is_static=True) == [lasting, lasting]
    assert decode(*encode([])) == []


@pytest.mark.parametrize(
    "camera",
    [
        CameraModel(460.0, 461.0, 320.0, 240.0, (0.1, -0.2, 0.0, 0.01, 0.0), "plumb_bob"),
        CameraModel(400.0, 400.0, 320.0, 240.0, (0.1, 0.2, 0.3, 0.4), "equidistant"),
        CameraModel(400.0, 400.0, 320.0, 240.0, (0.0,) * 4, "equidistant"),
        CameraModel(400.0, 400.0, 320.0, 240.0, (0.1,) * 12, "thin_prism"),
    ],
    ids=["plumb_bob", "equidistant", "equidistant of zeros", "thin prism"],
)
def test_intrinsics_come_back_exactly(camera):
    camera = replace(camera, width=640, height=480)
    info = CameraInfo(STAMP_NS, "camera", 640, 480, camera)
    assert decode(*encode(info)) == [camera]
    message = deserialize(*encode(info))
    assert (message.width, message.height, message.header.frame_id) == (640, 480, "camera")
    assert message.p[[0, 2, 5, 6]].tolist() == [camera.fx, camera.cx, camera.fy, camera.cy]


def test_a_camera_without_distortion_gets_a_name_that_tools_know():
    info = CameraInfo(0, "camera", 640, 480, CameraModel(460.0, 460.0, 320.0, 240.0))
    assert deserialize(*encode(info)).distortion_model == "plumb_bob"
    (back,) = decode(*encode(info))
    assert not any(back.distortion)


def test_a_map_comes_back_exactly_but_for_its_resolution_in_single_precision():
    cells = np.random.default_rng(2).integers(-1, 101, (3, 5)).astype(np.int8)
    sent = OccupancyGrid(STAMP_NS, "map", 0.05, (-1.5, 2.5, 2.0), cells)
    (grid,) = decode(*encode(sent))
    assert (grid.stamp_ns, grid.frame_id) == (STAMP_NS, "map")
    assert grid.resolution_m == pytest.approx(0.05, rel=1e-6)
    assert grid.origin == pytest.approx((-1.5, 2.5, 2.0))
    np.testing.assert_array_equal(grid.cells, cells)


def test_a_map_has_the_bytes_of_ros():
    golden = Cdr().header(STAMP_NS, "map")
    golden.put("i", STAMP_NS // 10**9).put("I", STAMP_NS % 10**9)
    golden.put("f", 0.25).put("I", 2, 1).put("d", 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    golden.put("I", 2).put("b", -1, 100)
    grid = OccupancyGrid(STAMP_NS, "map", 0.25, (1.0, 2.0, 0.0), np.array([[-1, 100]], np.int8))
    assert encode(grid) == ("nav_msgs/msg/OccupancyGrid", golden.bytes)


def test_truth_comes_back_exactly():
    truth = Truth(STAMP_NS, [1, 5], [[1.0, 2.0], [-3.0, 0.25]], [True, False], [False, True])
    (back,) = decode(*encode(truth))
    assert back.stamp_ns == STAMP_NS
    for name in ("id", "xy_m", "hand_up", "in_view"):
        np.testing.assert_array_equal(getattr(back, name), getattr(truth, name))
    (nobody,) = decode(*encode(Truth(5, [], np.zeros((0, 2)), [], [])))
    assert len(nobody) == 0


def test_what_is_encoded_already_passes_through():
    message = Encoded("std_msgs/msg/Bool", b"\0\1\0\0\1")
    assert encode(message) is message


@pytest.mark.parametrize("item", [Hands.none(), 3, None, [1, 2]], ids=repr)
def test_what_ros_has_no_message_for_is_refused(item):
    with pytest.raises(RecordingError, match="no ROS message"):
        encode(item)


def test_stamps_beyond_ros_time_are_refused():
    with pytest.raises(RecordingError, match="2147483647 seconds"):
        encode(Pose(2**31 * 10**9, "map", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)))


@pytest.mark.parametrize("quality", [0, 101])
def test_an_impossible_jpeg_quality_is_refused(quality):
    image = CameraImage(0, "", np.zeros((2, 2, 3), dtype=np.uint8))
    with pytest.raises(RecordingError, match="1 to 100"):
        encode(image, jpeg_quality=quality)


def test_what_a_customer_says_is_a_second_hypothesis():
    message = deserialize(*encode(tracks(gesture=[Gesture.WAVE, Gesture.NONE])))
    words = [
        [result.hypothesis.class_id for result in person.results] for person in message.detections
    ]
    assert words[0][:2] == ["hand_raised", "customer/wave"]
    assert not any(word.startswith("customer/") for word in words[1])
    assert {result.hypothesis.score for result in message.detections[0].results} == {0.9}


def test_a_text_has_the_bytes_of_ros():
    golden = Cdr().text("3 wave")
    assert encode("3 wave") == ("std_msgs/msg/String", golden.bytes)
