"""How do the bytes of a ROS image become a picture? In every common encoding, with padding."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple, cast

import cv2
import numpy as np
from numpy.typing import NDArray

from tracker.containers import ImageArray
from tracker.errors import RecordingError


class _Encoding(NamedTuple):
    channels: int
    to_bgr: int | None = None  # OpenCV's color conversion; None where the bytes are BGR already
    bytes_per_channel: int = 1


_BGR = _Encoding(3)
_GRAY = _Encoding(1, cv2.COLOR_GRAY2BGR)
_BGRA = _Encoding(4, cv2.COLOR_BGRA2BGR)
_UYVY = _Encoding(2, cv2.COLOR_YUV2BGR_UYVY)
_YUYV = _Encoding(2, cv2.COLOR_YUV2BGR_YUY2)

#: sensor_msgs/image_encodings.hpp. Of a Bayer pattern OpenCV names the second row, ROS the first.
_ENCODINGS = {
    "bgr8": _BGR,
    "8UC3": _BGR,
    "rgb8": _Encoding(3, cv2.COLOR_RGB2BGR),
    "mono8": _GRAY,
    "8UC1": _GRAY,
    "bgra8": _BGRA,
    "8UC4": _BGRA,
    "rgba8": _Encoding(4, cv2.COLOR_RGBA2BGR),
    "mono16": _Encoding(1, cv2.COLOR_GRAY2BGR, bytes_per_channel=2),
    "yuv422": _UYVY,
    "uyvy": _UYVY,
    "yuv422_yuy2": _YUYV,
    "yuyv": _YUYV,
    "bayer_rggb8": _Encoding(1, cv2.COLOR_BayerBG2BGR),
    "bayer_bggr8": _Encoding(1, cv2.COLOR_BayerRG2BGR),
    "bayer_gbrg8": _Encoding(1, cv2.COLOR_BayerGR2BGR),
    "bayer_grbg8": _Encoding(1, cv2.COLOR_BayerGB2BGR),
}


def bgr_from_image(message: Any) -> ImageArray:
    """The picture of a sensor_msgs/Image.

    Args:
        message: Any object with the fields of sensor_msgs/Image.

    Returns:
        Shape (height, width, 3), uint8, blue-green-red; a view of the message's own bytes where
        these are BGR already.

    Raises:
        RecordingError: The encoding is unknown, or the sizes do not fit each other.
    """
    kind = _ENCODINGS.get(message.encoding)
    if kind is None:
        raise RecordingError(
            f"An image has the encoding {message.encoding!r}; known are {', '.join(_ENCODINGS)}."
        )
    rows = _pixel_bytes(message, kind)
    shape = (message.height, message.width, kind.channels)
    if kind.bytes_per_channel == 2:  # the more significant byte is the picture
        rows = rows[:, 0 if message.is_bigendian else 1 :: 2]
    pixels = np.ascontiguousarray(rows).reshape(shape)
    if kind.to_bgr is None:
        return pixels
    return _with_opencv(
        lambda: cv2.cvtColor(pixels, cast(int, kind.to_bgr)),
        f"A {message.width}x{message.height} image as {message.encoding}",
    )


def bgr_from_compressed(message: Any) -> ImageArray:
    """The picture of a sensor_msgs/CompressedImage (JPEG, PNG, whatever OpenCV reads).

    Args:
        message: Any object with the fields of sensor_msgs/CompressedImage.

    Returns:
        Shape (height, width, 3), uint8, blue-green-red.

    Raises:
        RecordingError: The bytes are no picture.
    """
    return bgr_from_file_bytes(
        _as_bytes(message.data), f"A compressed image of format {message.format!r}"
    )


def bgr_from_file_bytes(data: NDArray[np.uint8], what: str) -> ImageArray:
    """The picture in the bytes of an image file, turned upright as its EXIF data say.

    Args:
        data: Shape (bytes,), uint8.
        what: What this is, as the beginning of the message of an error.

    Returns:
        Shape (height, width, 3), uint8, blue-green-red.

    Raises:
        RecordingError: The bytes are no picture.
    """
    if not len(data):
        raise RecordingError(f"{what} is empty.")
    return _with_opencv(
        lambda: cv2.imdecode(data, cv2.IMREAD_COLOR), f"{what} ({len(data)} bytes)"
    )


def _with_opencv(convert: Callable[[], Any], what: str) -> ImageArray:
    try:
        picture = convert()
    except cv2.error as error:
        raise RecordingError(f"{what} cannot be decoded ({error.err}).") from error
    if picture is None:
        raise RecordingError(f"{what} cannot be decoded; is it cut off or of another kind?")
    return cast(ImageArray, picture)


def _pixel_bytes(message: Any, kind: _Encoding) -> NDArray[np.uint8]:
    """Shape (height, bytes of one row without its padding).

    Every size comes from the sender and is believed only as far as the bytes that really came.
    """
    height, width, data = int(message.height), int(message.width), _as_bytes(message.data)
    row_bytes = width * kind.channels * kind.bytes_per_channel
    step = int(message.step) or row_bytes  # some drivers leave it zero
    # Some drivers leave the last row's padding away.
    least, most = step * (height - 1) + row_bytes, step * height
    if height < 1 or width < 1 or step < row_bytes or not least <= len(data) <= most:
        raise RecordingError(
            f"An image says {width}x{height} {message.encoding} in rows of {message.step} bytes "
            f"and brings {len(data)} bytes; needed are {max(least, 0)}, rows of at least "
            f"{row_bytes} bytes, and some pixels."
        )
    if len(data) < most:
        data = np.concatenate([data, np.zeros(most - len(data), dtype=np.uint8)])
    return data.reshape(height, step)[:, :row_bytes]


def _as_bytes(data: Any) -> NDArray[np.uint8]:
    # rosbags gives arrays, rclpy array('B'), others bytes: all of them lend their memory.
    return data if isinstance(data, np.ndarray) else np.frombuffer(data, dtype=np.uint8)
