import struct
from types import SimpleNamespace

import cv2
import numpy as np
import pytest

from tracker.camera import DepthCamera
from tracker.containers import DepthImage, depth_in_meters
from tracker.errors import RecordingError
from tracker.messages import decode, encode, types
from tracker.messages.depth import depth_from_compressed, depth_from_image
from tracker.messages.picture_size import MAX_PIXELS


def millimeters():
    rng = np.random.default_rng(3)
    pixels = rng.integers(300, 9000, (6, 8)).astype(np.uint16)
    pixels[0, 0] = 0
    return pixels


def meters():
    pixels = millimeters().astype(np.float32) / 1000.0
    pixels[0, :3] = (np.nan, np.inf, 0.0)
    return pixels


def image(pixels, encoding, *, step=None, is_bigendian=0):
    height, width = pixels.shape
    row = width * pixels.dtype.itemsize
    padded = np.zeros((height, step or row), np.uint8)
    padded[:, :row] = np.ascontiguousarray(pixels).view(np.uint8).reshape(height, row)
    return SimpleNamespace(
        encoding=encoding, height=height, width=width, step=step or row, data=padded.reshape(-1),
        is_bigendian=is_bigendian,
    )  # fmt: skip


@pytest.mark.parametrize("jpeg_quality", [None, 90], ids=["plain", "packed"])
@pytest.mark.parametrize("pixels", [millimeters(), meters()], ids=["mm", "m"])
def test_depth_comes_back_as_it_was_sent(pixels, jpeg_quality):
    sent = encode(DepthImage.of(5, "eye", pixels), jpeg_quality=jpeg_quality)
    (came,) = decode(*sent, is_depth=True)
    assert (came.stamp_ns, came.frame_id) == (5, "eye")
    np.testing.assert_allclose(
        depth_in_meters(came.read()), depth_in_meters(pixels), atol=0.005 + 1e-6
    )


def test_holes_nan_infinity_and_zero_are_no_readings():
    assert np.isnan(depth_in_meters(meters())[0, :3]).all()
    assert np.isnan(depth_in_meters(millimeters())[0, 0])


@pytest.mark.parametrize("encoding", ["16UC1", "mono16"])
def test_big_endian_rows_with_padding_are_understood(encoding):
    pixels = millimeters()
    message = image(pixels.astype(">u2"), encoding, step=24, is_bigendian=1)
    np.testing.assert_array_equal(depth_from_image(message, MAX_PIXELS)(), pixels)


def test_quantized_depth_is_decoded_as_compressed_depth_image_transport_writes_it():
    gain, offset = 100.0 * 101.0, 1.0 - 100.0 * 101.0 / 10.0
    inverse = (gain / np.array([[1.0, 2.5, 7.0]]) + offset).astype(np.uint16)  # rounds down
    _, png = cv2.imencode(".png", inverse)
    data = struct.pack("<iff", 0, gain, offset) + png.tobytes()
    message = SimpleNamespace(format="32FC1; compressedDepth", data=data)
    read = depth_from_compressed(message, MAX_PIXELS)
    np.testing.assert_allclose(read(), [[1.0, 2.5, 7.0]], atol=0.006)


def test_a_plain_png_of_millimeters_is_understood():
    _, png = cv2.imencode(".png", millimeters())
    message = SimpleNamespace(format="16UC1; png compressed ", data=png.tobytes())
    np.testing.assert_array_equal(depth_from_compressed(message, MAX_PIXELS)(), millimeters())


@pytest.mark.parametrize(
    ("words", "data", "told"),
    [
        ("16UC1; compressedDepth rvl", b"\0" * 40, "set the publisher's `format` to png"),
        ("16UC1; compressedDepth png", b"\0" * 40, "no PNG"),
        ("16UC1; compressedDepth png", b"", "no PNG"),
    ],
    ids=["rvl", "noise", "empty"],
)
def test_what_is_no_packed_depth_is_refused_by_name(words, data, told):
    with pytest.raises(RecordingError, match=told):
        depth_from_compressed(SimpleNamespace(format=words, data=data), MAX_PIXELS)


def test_a_damaged_png_is_told_when_it_is_read():
    sent = encode(DepthImage.of(5, "eye", np.full((64, 64), 900, np.uint16)), jpeg_quality=90)
    (came,) = decode(sent.type_name, sent.cdr[:-40] + b"\0" * 40, is_depth=True)
    assert came.stamp_ns == 5
    damaged = types.deserialize(*sent)
    damaged.data = damaged.data[:60]
    with pytest.raises(RecordingError, match="cannot be decompressed"):
        depth_from_compressed(damaged, MAX_PIXELS)()


def test_a_color_picture_is_no_depth():
    message = image(np.zeros((4, 4), np.uint8), "mono8")
    with pytest.raises(RecordingError, match="16UC1"):
        depth_from_image(message, MAX_PIXELS)


def test_a_picture_that_brings_too_few_bytes_is_refused():
    message = image(millimeters(), "16UC1")
    message.data = message.data[:-3]
    with pytest.raises(RecordingError, match="brings"):
        depth_from_image(message, MAX_PIXELS)


def test_intrinsics_of_a_depth_camera_are_told_apart(camera_info):
    (event,) = decode(*encode(camera_info), is_depth=True)
    assert event == DepthCamera(camera_info.camera)


@pytest.fixture
def camera_info():
    from tracker.camera import CameraModel
    from tracker.messages import CameraInfo

    return CameraInfo(
        1, "eye", 640, 480, CameraModel(400.0, 400.0, 320.0, 240.0, (0.0,) * 5, "plumb_bob",
                                         width=640, height=480),
    )  # fmt: skip
