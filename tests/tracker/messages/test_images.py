from types import SimpleNamespace

import cv2
import numpy as np
import pytest
from rosbags.image import message_to_cvimage
from rosbags.typesys import Stores, get_typestore

from tracker.errors import RecordingError
from tracker.messages.images import bgr_from_compressed, bgr_from_image

_CHANNELS = {
    "bgr8": 3, "rgb8": 3, "bgra8": 4, "rgba8": 4, "mono8": 1, "8UC1": 1, "8UC3": 3,
    "yuv422": 2, "yuv422_yuy2": 2,
    "bayer_rggb8": 1, "bayer_bggr8": 1, "bayer_gbrg8": 1, "bayer_grbg8": 1,
}  # fmt: skip


def image(encoding, height, width, data, step=None, is_bigendian=0):
    step = len(data) // max(height, 1) if step is None else step
    return SimpleNamespace(
        encoding=encoding, height=height, width=width, data=data, step=step,
        is_bigendian=is_bigendian,
    )  # fmt: skip


def random_pixels(encoding, height=6, width=8):
    rng = np.random.default_rng(4)
    return rng.integers(0, 256, (height, width * _CHANNELS[encoding]), dtype=np.uint8)


@pytest.mark.parametrize("encoding", [name for name in _CHANNELS if not name.startswith("8U")])
def test_tightly_packed_images_decode_as_rosbags_image_does(encoding):
    pixels = random_pixels(encoding)
    store = get_typestore(Stores.ROS2_JAZZY)
    stamp = store.types["builtin_interfaces/msg/Time"](sec=1, nanosec=2)
    message = store.types["sensor_msgs/msg/Image"](
        header=store.types["std_msgs/msg/Header"](stamp=stamp, frame_id="camera"),
        height=6, width=8, encoding=encoding, is_bigendian=0, step=pixels.shape[1],
        data=pixels.reshape(-1),
    )  # fmt: skip

    expected = message_to_cvimage(message, "bgr8")

    np.testing.assert_array_equal(bgr_from_image(message), expected)


@pytest.mark.parametrize("encoding", list(_CHANNELS))
def test_padding_at_the_end_of_rows_changes_nothing(encoding):
    pixels = random_pixels(encoding)
    padded = np.pad(pixels, ((0, 0), (0, 5)), constant_values=99)

    tight = bgr_from_image(image(encoding, 6, 8, pixels.reshape(-1)))
    loose = bgr_from_image(image(encoding, 6, 8, padded.reshape(-1)))
    short = bgr_from_image(image(encoding, 6, 8, padded.reshape(-1)[:-5], step=padded.shape[1]))

    np.testing.assert_array_equal(loose, tight)
    np.testing.assert_array_equal(short, tight)


def test_pure_colors_come_out_as_themselves():
    def first_pixel(encoding, *values):
        data = bytes(values)
        width = len(data) // _CHANNELS[encoding]
        return bgr_from_image(image(encoding, 1, width, data))[0, 0].tolist()

    assert first_pixel("bgr8", 1, 2, 3) == [1, 2, 3]
    assert first_pixel("rgb8", 1, 2, 3) == [3, 2, 1]
    assert first_pixel("bgra8", 1, 2, 3, 99) == [1, 2, 3]
    assert first_pixel("rgba8", 1, 2, 3, 99) == [3, 2, 1]
    assert first_pixel("mono8", 7) == [7, 7, 7]
    # Y = 81, U = 90, V = 240 is red in BT.601; the order is U Y V Y here and Y U Y V there.
    np.testing.assert_allclose(first_pixel("yuv422", 90, 81, 240, 81), [0, 0, 255], atol=2)
    np.testing.assert_allclose(first_pixel("yuv422_yuy2", 81, 90, 81, 240), [0, 0, 255], atol=2)


def test_a_red_scene_through_a_bayer_pattern_is_red():
    pattern = np.zeros((8, 8), dtype=np.uint8)
    pattern[::2, ::2] = 200  # rggb: red at even rows and columns
    middle = bgr_from_image(image("bayer_rggb8", 8, 8, pattern.reshape(-1)))[3:5, 3:5]
    assert middle[..., 2].min() == 200
    assert middle[..., :2].max() == 0


@pytest.mark.parametrize("is_bigendian", [0, 1])
def test_mono16_keeps_the_more_significant_byte(is_bigendian):
    values = np.array([[0x1234, 0xABCD]], dtype=">u2" if is_bigendian else "<u2")
    gray = bgr_from_image(image("mono16", 1, 2, values.tobytes(), is_bigendian=is_bigendian))
    assert gray[0, :, 0].tolist() == [0x12, 0xAB]


def test_a_bgr_image_is_not_copied():
    pixels = random_pixels("bgr8")
    assert np.shares_memory(bgr_from_image(image("bgr8", 6, 8, pixels.reshape(-1))), pixels)


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (image("bgr8", 0, 0, b""), "0x0"),
        (image("bgr8", 2, 0, b"", step=0), "0x2"),
        (image("bgr8", 2, 2, b"123456789", step=6), "needed are 12"),
        (image("bgr8", 2, 2, bytes(13), step=6), "brings 13 bytes"),
        (image("bgr8", 2, 2, bytes(10), step=5), "at least 6"),
        (image("bgr8", 2**32 - 1, 2**32 - 1, bytes(10), step=2**32 - 1), "4294967295"),
        (image("bgr8", 2**31, 1, bytes(10), step=3), "needed are 6442450944"),
        (image("jpeg2000", 2, 2, bytes(12)), "jpeg2000"),
        (image("", 2, 2, bytes(12)), "known are bgr8"),
        (image("32FC1", 1, 1, bytes(4)), "32FC1"),
        (image("yuv422", 1, 3, bytes(6)), "3x1"),
    ],
    ids=[
        "no pixels", "no columns", "too few bytes", "too many bytes", "short step", "huge",
        "many rows", "unknown", "unnamed", "depth", "odd width",
    ],
)  # fmt: skip
def test_images_that_cannot_be_are_refused_with_their_sizes(message, words):
    with pytest.raises(RecordingError, match=words):
        bgr_from_image(message)


@pytest.mark.parametrize("suffix", [".jpg", ".png"])
def test_compressed_images_decode_in_color_and_gray(suffix):
    color = np.full((20, 30, 3), (10, 100, 200), dtype=np.uint8)
    gray = np.full((20, 30), 77, dtype=np.uint8)
    for picture, expected in ((color, (10, 100, 200)), (gray, (77, 77, 77))):
        data = cv2.imencode(suffix, picture)[1].tobytes()
        decoded = bgr_from_compressed(SimpleNamespace(format=suffix, data=data))
        assert decoded.shape == (20, 30, 3)
        np.testing.assert_allclose(decoded[10, 10], expected, atol=3)


@pytest.mark.parametrize("data", [b"", b"\xff\xd8 no picture", bytes(100)])
def test_broken_compressed_images_are_refused(data):
    with pytest.raises(RecordingError, match="'jpeg'"):
        bgr_from_compressed(SimpleNamespace(format="jpeg", data=data))
