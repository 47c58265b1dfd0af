"""How do the bytes of a ROS image become a picture? In every common encoding, with padding."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple, cast

import cv2
import numpy as np
from numpy.typing import NDArray

from tracker.containers import ImageArray
from tracker.errors import RecordingError
from tracker.messages.encodings import ENCODINGS, File, Packed, Planar
from tracker.messages.picture_size import MAX_PIXELS, PictureSize, check_pixels, picture_size

#: Depths of sensors, in bits.
_DEPTHS = (8, 10, 12, 14, 16)
#: Compressed transports that send no pictures one by one, or no pictures of light.
_NO_PICTURES = {
    "compresseddepth": "a depth image",
    "32fc1": "a depth image",
    "rvl": "a depth image",
    "theora": "a piece of a video stream",
    "h264": "a piece of a video stream",
    "h265": "a piece of a video stream",
    "hevc": "a piece of a video stream",
    "av1": "a piece of a video stream",
}


class Picture(NamedTuple):
    """What an image message shows.

    Attributes:
        bgr: Shape (height, width, 3), uint8, blue-green-red.
        remark: What had to be guessed about it; empty where nothing had to be.
    """

    bgr: ImageArray
    remark: str = ""


def picture_from_image(message: Any, max_pixels: int = MAX_PIXELS) -> Picture:
    """The picture of a sensor_msgs/Image.

    Args:
        message: Any object with the fields of sensor_msgs/Image.
        max_pixels: A larger picture is refused before it is decoded.

    Returns:
        A view of the message's own bytes where these are BGR already.

    Raises:
        RecordingError: The encoding is unknown, the sizes do not fit each other, or the picture
            is too large.
    """
    encoding = ENCODINGS.get(message.encoding.strip().lower())
    what = f"A {message.width}x{message.height} image as {message.encoding}"
    if encoding is None:
        raise RecordingError(
            f"An image has the encoding {message.encoding!r}; supported are "
            f"{', '.join(ENCODINGS)}."
        )
    if isinstance(encoding, File):
        return picture_from_file(as_bytes(message.data), what, max_pixels)
    check_pixels(PictureSize(int(message.width), int(message.height)), max_pixels, "An image")
    if isinstance(encoding, Planar):
        return Picture(_with_opencv(lambda: _bgr_of_planes(message, encoding), what))
    numbers, remark = _eight_bits(_packed_numbers(message, encoding), encoding.bits, what)
    if encoding.to_bgr is None:
        return Picture(numbers, remark)
    to_bgr = encoding.to_bgr
    return Picture(_with_opencv(lambda: cv2.cvtColor(numbers, to_bgr), what), remark)


def picture_from_compressed(message: Any, max_pixels: int = MAX_PIXELS) -> Picture:
    """The picture of a sensor_msgs/CompressedImage: JPEG, PNG, WebP, BMP or TIFF.

    Args:
        message: Any object with the fields of sensor_msgs/CompressedImage.
        max_pixels: A larger picture is refused before it is decoded.

    Raises:
        RecordingError: The bytes are no picture, or one that is too large.
    """
    what = f"A compressed image of format {message.format!r}"
    words = message.format.lower().replace(";", " ").split()
    kind = next((_NO_PICTURES[word] for word in words if word in _NO_PICTURES), None)
    if kind is not None:
        raise RecordingError(
            f"{what} is {kind}; expected pictures of light, each by itself, as jpeg or png."
        )
    return picture_from_file(as_bytes(message.data), what, max_pixels)


def picture_from_file(data: NDArray[np.uint8], what: str, max_pixels: int = MAX_PIXELS) -> Picture:
    """The picture in the bytes of an image file, turned upright as its EXIF data say.

    Args:
        data: Shape (bytes,), uint8.
        what: What this is, as the beginning of the message of an error.
        max_pixels: A larger picture is refused before it is decoded.

    Raises:
        RecordingError: The bytes are no picture, or one that is too large.
    """
    if not len(data):
        raise RecordingError(f"{what} is empty.")
    what = f"{what} ({len(data)} bytes)"
    size = picture_size(data)
    if size is None:
        raise RecordingError(
            f"{what} cannot be decoded; expected a JPEG, PNG, WebP, BMP or TIFF with its header."
        )
    check_pixels(size, max_pixels, what)
    flags = cv2.IMREAD_COLOR | cv2.IMREAD_ANYDEPTH
    numbers = _with_opencv(lambda: cv2.imdecode(data, flags), what)
    if numbers.dtype not in (np.uint8, np.uint16):
        raise RecordingError(f"{what} holds numbers of type {numbers.dtype}; it is not a picture.")
    return Picture(*_eight_bits(numbers, 8 if numbers.dtype == np.uint8 else None, what))


def _with_opencv(convert: Callable[[], Any], what: str) -> ImageArray:
    try:
        picture = convert()
    except cv2.error as error:
        raise RecordingError(f"{what} cannot be decoded ({error.err}).") from error
    if picture is None:
        raise RecordingError(f"{what} cannot be decoded; is it cut off, or not a picture?")
    return cast(ImageArray, picture)


def _eight_bits(numbers: Any, bits: int | None, what: str) -> tuple[ImageArray, str]:
    """The most significant 8 of the bits in use, and a remark where their number is a guess.

    Sensors of 10, 12 and 14 bits send numbers of 16 without saying which they are. The smallest
    depth that holds the largest number of the picture is taken: right unless the picture is so
    dark that it needs brightening anyway.
    """
    if bits == 8:
        return numbers, ""
    remark = ""
    if bits is None:
        most = int(numbers[..., :3].max())  # not the opacity
        bits = next(depth for depth in _DEPTHS if most < 1 << depth)
        if bits < 16:
            remark = f"{what}, whose largest number is {most}, is taken for one of {bits} bits"
    return (numbers >> (bits - 8)).astype(np.uint8), remark


def _packed_numbers(message: Any, encoding: Packed) -> Any:
    """Shape (height, width, channels), uint8 or uint16."""
    height, width = int(message.height), int(message.width)
    row_bytes = width * encoding.channels * encoding.bytes_each
    step = int(message.step) or row_bytes  # some drivers leave it zero
    least, most = step * (height - 1) + row_bytes, step * height
    data = as_bytes(message.data)
    if height < 1 or width < 1 or step < row_bytes or not least <= len(data) <= most:
        raise _misfit(message, least, row_bytes)
    rows = filled(data, most).reshape(height, step)[:, :row_bytes]
    if encoding.order and row_bytes % 4 == 0:
        rows = rows.reshape(height, -1, 4)[..., encoding.order]
    numbers = np.ascontiguousarray(rows)
    if encoding.bytes_each == 2:
        numbers = numbers.view(">u2" if message.is_bigendian else "<u2")
    return numbers.reshape(height, width, encoding.channels)


def _bgr_of_planes(message: Any, encoding: Planar) -> ImageArray:
    light, u, v = _planes(message, encoding)
    height, width = light.shape
    if encoding.down == 2 and height % 2 == 0 and width % 2 == 0:
        packed = np.concatenate([light.reshape(-1), u.reshape(-1), v.reshape(-1)])
        i420 = packed.reshape(height * 3 // 2, width)
        return cast(ImageArray, cv2.cvtColor(i420, cv2.COLOR_YUV2BGR_I420))
    u, v = (
        plane.repeat(encoding.down, axis=0)[:height].repeat(encoding.across, axis=1)[:, :width]
        for plane in (u, v)
    )
    # Twice as wide, since OpenCV knows no format in which each pixel has a color of its own.
    doubled = np.stack([u, light, v, light], axis=-1).reshape(height, 2 * width, 2)
    return np.ascontiguousarray(cv2.cvtColor(doubled, cv2.COLOR_YUV2BGR_UYVY)[:, ::2])


def _planes(message: Any, encoding: Planar) -> tuple[Any, Any, Any]:
    """Brightness, shape (height, width); u and v, each with a number for those that share it."""
    height, width, data = int(message.height), int(message.width), as_bytes(message.data)
    steps = {int(message.step), width}  # some drivers count the colors into the step
    for step in sorted(step for step in steps if step >= width > 0 and height > 0):
        shapes = list(_plane_shapes(encoding, height, width, step))
        size = sum(rows * row_step for rows, row_step, _ in shapes)
        _, last_step, last_bytes = shapes[-1]
        if not size - (last_step - last_bytes) <= len(data) <= size:
            continue
        data, planes = filled(data, size), []
        for rows, row_step, row_bytes in shapes:
            planes.append(data[: rows * row_step].reshape(rows, row_step)[:, :row_bytes])
            data = data[rows * row_step :]
        light, *colors = planes
        if encoding.is_interleaved:
            colors = [colors[0][:, 0::2], colors[0][:, 1::2]]
        u, v = reversed(colors) if encoding.is_v_first else colors
        return light, u, v
    needed = sum(rows * step for rows, step, _ in _plane_shapes(encoding, height, width, width))
    raise _misfit(message, needed, width)


def _plane_shapes(
    encoding: Planar, height: int, width: int, step: int
) -> Iterator[tuple[int, int, int]]:
    """Rows of each plane, bytes from one row to the next, and those of them that are pixels."""
    yield height, step, width
    rows = -(-height // encoding.down)
    color_step, color_bytes = -(-step // encoding.across), -(-width // encoding.across)
    if encoding.is_interleaved:
        yield rows, 2 * color_step, 2 * color_bytes
    else:
        yield rows, color_step, color_bytes
        yield rows, color_step, color_bytes


def _misfit(message: Any, least: int, row_bytes: int) -> RecordingError:
    return RecordingError(
        f"An image says {message.width}x{message.height} {message.encoding} in rows of "
        f"{message.step} bytes and brings {len(message.data)} bytes; expected "
        f"{max(least, 0)}, rows of at least {row_bytes} bytes, and some pixels."
    )


def filled(data: NDArray[np.uint8], size: int) -> NDArray[np.uint8]:
    """Bytes of a picture, up to a size: some drivers leave the last row's padding away."""
    if len(data) == size:
        return data
    return np.concatenate([data, np.zeros(size - len(data), dtype=np.uint8)])


def as_bytes(data: Any) -> NDArray[np.uint8]:
    """The data of a message, not copied."""
    # rosbags gives arrays, rclpy array('B'), others bytes: all of them lend their memory.
    return data if isinstance(data, np.ndarray) else np.frombuffer(data, dtype=np.uint8)
