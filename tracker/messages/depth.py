"""How do depth images travel? As 16UC1 in millimeters or 32FC1 in meters, plain or packed.

Packed is what ROS's compressed_depth_image_transport makes: 12 bytes of settings, then a PNG of
16 bits, in which 32FC1 stands as quantized inverse depth. A plain PNG of millimeters will do too.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from functools import partial
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from tracker.errors import RecordingError
from tracker.messages.images import as_bytes, filled
from tracker.messages.picture_size import PictureSize, check_pixels, picture_size

_TYPES = {"16uc1": np.uint16, "mono16": np.uint16, "32fc1": np.float32}
#: compressed_depth_image_transport's ConfigHeader: an unused number, then two of quantization.
_SETTINGS = struct.Struct("<iff")
_PNG = b"\x89PNG\r\n\x1a\n"
#: Its own defaults: depths up to 10 m, quantized by 100.
_DEPTH_MAX_M, _QUANTIZATION = 10.0, 100.0


def depth_from_image(message: Any, max_pixels: int) -> Callable[[], NDArray[Any]]:
    """The pixels of a depth image in a sensor_msgs/Image; `DepthImage.read` says of which kind.

    Args:
        message: Any object with the fields of sensor_msgs/Image.
        max_pixels: A larger picture is refused.

    Raises:
        RecordingError: The encoding is none of depth, or the sizes do not fit each other.
    """
    kind = _TYPES.get(message.encoding.strip().lower())
    height, width = int(message.height), int(message.width)
    what = f"A {width}x{height} depth image as {message.encoding}"
    if kind is None:
        raise RecordingError(f"{what} was given; expected 16UC1 (millimeters) or 32FC1 (meters).")
    check_pixels(PictureSize(width, height), max_pixels, "A depth image")
    dtype = np.dtype(kind).newbyteorder(">" if message.is_bigendian else "<")
    row_bytes = width * dtype.itemsize
    step = int(message.step) or row_bytes
    data = as_bytes(message.data)
    least, most = step * (height - 1) + row_bytes, step * height
    if height < 1 or width < 1 or step < row_bytes or not least <= len(data) <= most:
        raise RecordingError(
            f"{what} brings {len(data)} bytes in rows of {step}; expected {max(least, 0)}, rows "
            f"of at least {row_bytes} bytes, and some pixels."
        )

    def read() -> NDArray[Any]:
        rows = filled(data, most).reshape(height, step)[:, :row_bytes]
        return np.asarray(np.ascontiguousarray(rows).view(dtype), dtype=kind)

    return read


def depth_from_compressed(message: Any, max_pixels: int) -> Callable[[], NDArray[Any]]:
    """The pixels of a depth image in a sensor_msgs/CompressedImage, unpacked when asked for.

    Args:
        message: Any object with the fields of sensor_msgs/CompressedImage.
        max_pixels: A larger picture is refused before it is unpacked.

    Raises:
        RecordingError: The bytes are no depth image; the reader raises it too, where the PNG is
            damaged.
    """
    words = message.format.lower().replace(";", " ").split()
    what = f"A compressed depth image of format {message.format!r}"
    if "rvl" in words:
        raise RecordingError(f"{what} is not supported; set the publisher's `format` to png.")
    data = as_bytes(message.data)
    begin = 0 if data[: len(_PNG)].tobytes() == _PNG else _SETTINGS.size
    size = picture_size(data[begin:])
    if size is None:
        raise RecordingError(f"{what} holds no PNG in its {len(data)} bytes.")
    check_pixels(size, max_pixels, what)
    if "32fc1" not in words:
        return partial(_unpacked, data[begin:], what)
    if not begin:
        raise RecordingError(f"{what} lacks the 12 bytes that say how it is quantized.")
    _, gain, offset = _SETTINGS.unpack_from(data.tobytes()[: _SETTINGS.size])
    return lambda: _from_inverse(_unpacked(data[begin:], what), gain, offset)


def depth_message_fields(pixels: NDArray[Any]) -> dict[str, Any]:
    """What a sensor_msgs/Image says of depth pixels, as `DepthImage.read` gives them."""
    height, width = pixels.shape
    return {
        "height": height,
        "width": width,
        "encoding": "16UC1" if pixels.dtype == np.uint16 else "32FC1",
        "step": width * pixels.dtype.itemsize,
        "data": np.ascontiguousarray(pixels).reshape(-1).view(np.uint8),
    }


def packed_depth_fields(pixels: NDArray[Any]) -> dict[str, Any]:
    """What a sensor_msgs/CompressedImage says of them, in compressed_depth_image_transport's way.

    Of meters, those beyond 10 m are left out, and the step from one depth to the next grows with
    its square: 0.1 mm at 1 m, 1 cm at 10 m.
    """
    gain = offset = 0.0
    encoding, numbers = "16UC1", pixels
    if pixels.dtype == np.float32:
        encoding = "32FC1"
        gain = _QUANTIZATION * (_QUANTIZATION + 1.0)
        offset = 1.0 - gain / _DEPTH_MAX_M
        with np.errstate(invalid="ignore", divide="ignore"):
            is_held = (pixels > gain / (65535.0 - offset)) & (pixels < _DEPTH_MAX_M)
            numbers = np.where(is_held, gain / pixels + offset + 0.5, 0.0).astype(np.uint16)
    _, png = cv2.imencode(".png", numbers, [cv2.IMWRITE_PNG_COMPRESSION, 1])
    settings = np.frombuffer(_SETTINGS.pack(0, gain, offset), dtype=np.uint8)
    return {
        "format": f"{encoding}; compressedDepth png",
        "data": np.concatenate([settings, png.reshape(-1)]),
    }


def _unpacked(png: NDArray[np.uint8], what: str) -> NDArray[Any]:
    try:
        numbers = cv2.imdecode(png, cv2.IMREAD_UNCHANGED)
    except cv2.error as error:
        raise RecordingError(f"{what} cannot be decompressed ({error.err}).") from error
    if numbers is None or numbers.ndim != 2 or numbers.dtype != np.uint16:
        raise RecordingError(
            f"{what} cannot be decompressed; expected a PNG of 16 bits, one channel."
        )
    return np.asarray(numbers)


def _from_inverse(numbers: NDArray[Any], gain: float, offset: float) -> NDArray[np.float32]:
    """Depth = gain / (number - offset); 0 stands for no reading."""
    with np.errstate(divide="ignore", invalid="ignore"):
        depth_m = np.float32(gain) / (numbers.astype(np.float32) - np.float32(offset))
    return np.asarray(np.where(numbers > 0, depth_m, np.nan), dtype=np.float32)
