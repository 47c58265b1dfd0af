from types import SimpleNamespace

import numpy as np
import pytest

from tracker.camera import CameraModel, Pinhole, Sensor
from tracker.containers import CameraImage, OccupancyGrid, Scan, Truth
from tracker.errors import ClockError, ConfigError, RecordingError, ShapeError, TrackerError
from tracker.geometry import RigidTransform
from tracker.messages import CameraInfo, decode, encode, events_from_message
from tracker.messages.types import build, serialize
from tracker.transforms import StampedTransform

INFO = "sensor_msgs/msg/CameraInfo"
SCAN = "sensor_msgs/msg/LaserScan"


def camera_info(k=(400.0, 0.0, 320.0, 0.0, 300.0, 240.0, 0.0, 0.0, 1.0), **fields):
    return build(INFO, k=np.array(k), **fields)


def test_binning_and_region_of_interest_shift_the_intrinsics():
    roi = build("sensor_msgs/msg/RegionOfInterest", x_offset=100, y_offset=40)
    (camera,) = events_from_message(INFO, camera_info(binning_x=2, binning_y=4, roi=roi))
    assert (camera.fx, camera.fy, camera.cx, camera.cy) == (200.0, 75.0, 110.0, 50.0)


def region(**fields):
    return build("sensor_msgs/msg/RegionOfInterest", **fields)


def test_intrinsics_belong_to_the_region_as_it_is_sent():
    roi = region(x_offset=500, y_offset=100, width=300, height=200, do_rectify=True)
    info = camera_info(
        (900.0, 0.0, 810.0, 0.0, 890.0, 590.0, 0.0, 0.0, 1.0),
        width=1600, height=1200, binning_x=2, binning_y=2, roi=roi,
    )  # fmt: skip
    (camera,) = events_from_message(INFO, info)
    assert (camera.width, camera.height) == (150, 100)
    assert (camera.fx, camera.fy, camera.cx, camera.cy) == (450.0, 445.0, 155.0, 245.0)
    assert camera.sensor == Sensor(-250.0, -50.0, 800.0, 600.0)
    assert camera.is_centered


def test_p_is_kept_for_rectified_images():
    p = np.array([420.0, 0, 330, -21, 0, 410, 250, 0, 0, 0, 1, 0])
    (camera,) = events_from_message(INFO, camera_info(p=p, width=640, height=480, binning_x=2))
    assert (camera.fx, camera.rectified) == (200.0, Pinhole(210.0, 410.0, 165.0, 250.0))


def test_a_camera_with_p_alone_sends_rectified_images():
    p = np.array([420.0, 0, 330, 0, 0, 410, 250, 0, 0, 0, 1, 0])
    info = camera_info((0.0,) * 9, p=p, d=np.full(5, 0.1), distortion_model="plumb_bob")
    (camera,) = events_from_message(INFO, info)
    assert (camera.fx, camera.fy, camera.cx, camera.cy) == (420.0, 410.0, 330.0, 250.0)
    assert camera.distortion == ()


def test_a_region_without_a_size_is_the_whole_picture():
    (camera,) = events_from_message(INFO, camera_info(width=640, height=480, binning_x=1))
    assert (camera.width, camera.height, camera.sensor) == (640, 480, None)


def test_a_camera_info_without_a_size_belongs_to_any_picture():
    (camera,) = events_from_message(INFO, camera_info())
    assert (camera.width, camera.height) == (None, None)


@pytest.mark.parametrize(
    "roi",
    [
        region(x_offset=400, width=300, height=480),
        region(y_offset=480),
        region(width=641, height=480),
    ],
    ids=["beyond the right", "below", "too wide"],
)
def test_a_region_beyond_its_picture_is_refused(roi):
    with pytest.raises(ConfigError, match=r"region of .* of a picture of 640x480"):
        events_from_message(INFO, camera_info(width=640, height=480, roi=roi))


def test_ros1_names_of_the_matrices_are_understood():
    message = camera_info()
    ros1 = SimpleNamespace(
        K=message.k, D=[0.0] * 5, P=message.p, width=640, height=480, binning_x=0, binning_y=0,
        roi=message.roi, distortion_model="plumb_bob",
    )  # fmt: skip
    (camera,) = events_from_message(INFO, ros1)
    assert (camera.fx, camera.fy, camera.cx, camera.cy) == (400.0, 300.0, 320.0, 240.0)


def test_an_uncalibrated_camera_is_refused():
    with pytest.raises(ConfigError, match="uncalibrated"):
        decode(*serialize(build(INFO)))


def test_a_scan_with_zero_increment_is_refused():
    with pytest.raises(ShapeError, match="increment"):
        decode(*serialize(build(SCAN, ranges=np.ones(3, dtype=np.float32))))


def test_a_map_whose_size_and_cells_disagree_is_refused():
    grid = OccupancyGrid(5, "map", 0.5, (0.0, 0.0, 0.0), np.zeros((3, 4), np.int8))
    cdr = bytearray(encode(grid).cdr)
    cdr[cdr.index(4, 20)] = 7  # the columns
    with pytest.raises(ShapeError, match="7x3 cells and brings 12"):
        decode("nav_msgs/msg/OccupancyGrid", bytes(cdr))


def test_a_negative_stamp_is_refused():
    time = build("builtin_interfaces/msg/Time", sec=-1)
    message = build(SCAN, header=build("std_msgs/msg/Header", stamp=time))
    with pytest.raises(ClockError, match="stamp"):
        decode(*serialize(message))


def test_unknown_types_are_refused_by_name():
    with pytest.raises(RecordingError, match="my_msgs/msg/Own"):
        decode("my_msgs/msg/Own", b"\0\1\0\0")
    with pytest.raises(RecordingError, match="are not supported"):
        decode("std_msgs/msg/Bool", b"\0\1\0\0\1")


def test_detections_of_others_are_no_truth():
    person = build("vision_msgs/msg/Detection3D", id="chair")
    with pytest.raises(RecordingError, match="chair"):
        decode(*serialize(build("vision_msgs/msg/Detection3DArray", detections=[person])))


def test_objects_of_rclpy_with_array_data_decode_like_bytes():
    image = CameraImage(5, "camera", np.arange(24, dtype=np.uint8).reshape(2, 4, 3))
    (from_bytes,) = decode(*encode(image))
    from array import array

    message = SimpleNamespace(
        header=SimpleNamespace(stamp=SimpleNamespace(sec=0, nanosec=5), frame_id="camera"),
        height=2, width=4, encoding="bgr8", step=12, is_bigendian=0,
        data=array("B", image.bgr.tobytes()),
    )  # fmt: skip
    (from_object,) = events_from_message("sensor_msgs/msg/Image", message)
    np.testing.assert_array_equal(from_object.bgr, from_bytes.bgr)


@pytest.mark.parametrize(
    "item",
    [
        Scan(5, "laser", 0.0, 0.1, 0.1, 9.0, np.ones(30)),
        StampedTransform(5, "map", "base", RigidTransform()),
        CameraInfo(5, "camera", 64, 48, CameraModel(50.0, 50.0, 32.0, 24.0)),
        OccupancyGrid(5, "map", 0.5, (0.0, 0.0, 0.0), np.zeros((3, 3), np.int8)),
        Truth(5, [1], [[1.0, 2.0]], [True], [True]),
    ],
    ids=lambda item: type(item).__name__,
)
def test_bytes_cut_anywhere_are_refused_in_one_line(item):
    type_name, whole = encode(item)
    for length in range(len(whole) - 1):
        with pytest.raises(TrackerError) as caught:
            decode(type_name, whole[:length])
        assert "\n" not in str(caught.value)


def test_random_bytes_never_raise_anything_but_the_own_errors():
    rng = np.random.default_rng(11)
    whole = np.frombuffer(
        encode(CameraImage(5, "camera", np.zeros((4, 4, 3), np.uint8))).cdr, np.uint8
    )
    for _ in range(500):
        noisy = whole.copy()
        at = rng.integers(0, len(noisy), 4)
        noisy[at] = rng.integers(0, 256, 4)
        try:
            (image,) = decode("sensor_msgs/msg/Image", noisy.tobytes())
        except TrackerError:
            continue
        assert image.bgr.size <= 48 * 3  # nothing is allocated beyond the bytes that came
