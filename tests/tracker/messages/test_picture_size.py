"""Sizes in headers, of files that OpenCV wrote and of such as claim too much."""

import struct
import zlib
from types import SimpleNamespace

import cv2
import numpy as np
import pytest

from tracker.errors import RecordingError
from tracker.messages.images import picture_from_compressed
from tracker.messages.picture_size import picture_size

SIZES = [(1, 1), (1, 300), (257, 2), (640, 481)]


def size_of(data):
    return picture_size(np.frombuffer(data, np.uint8))


def encoded(suffix, width, height, *flags):
    rng = np.random.default_rng(width)
    picture = rng.integers(0, 256, (height, width, 3), dtype=np.uint8)
    return cv2.imencode(suffix, picture, list(flags))[1].tobytes()


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize(
    ("suffix", "flags"),
    [
        (".jpg", ()),
        (".jpg", (cv2.IMWRITE_JPEG_PROGRESSIVE, 1, cv2.IMWRITE_JPEG_RST_INTERVAL, 4)),
        (".png", ()),
        (".bmp", ()),
        (".webp", (cv2.IMWRITE_WEBP_QUALITY, 60)),
        (".webp", (cv2.IMWRITE_WEBP_QUALITY, 101)),
        (".tiff", ()),
    ],
    ids=["jpeg", "progressive", "png", "bmp", "webp", "lossless webp", "tiff"],
)
def test_the_header_tells_the_size(suffix, flags, size):
    assert size_of(encoded(suffix, *size, *flags)) == size


def test_a_thumbnail_in_front_of_the_picture_is_not_its_size():
    thumbnail, picture = encoded(".jpg", 32, 24), encoded(".jpg", 200, 100)
    exif = b"Exif\0\0" + thumbnail
    data = picture[:2] + b"\xff\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif + picture[2:]
    assert size_of(data) == (200, 100)


def test_a_webp_with_a_canvas_tells_the_canvas():
    canvas = bytes(4) + (4999).to_bytes(3, "little") + (2999).to_bytes(3, "little")
    data = b"RIFF" + struct.pack("<I", 22) + b"WEBPVP8X" + struct.pack("<I", 10) + canvas
    assert size_of(data) == (5000, 3000)


@pytest.mark.parametrize("suffix", [".jpg", ".png", ".bmp", ".webp", ".tiff"])
def test_headers_cut_anywhere_tell_nothing_or_the_truth(suffix):
    whole = encoded(suffix, 30, 20)
    for length in range(min(len(whole), 700)):
        assert size_of(whole[:length]) in (None, (30, 20))


@pytest.mark.parametrize("data", [b"", b"GIF89a", b"\xff\xd8\xff\xd9", bytes(64)])
def test_other_files_tell_nothing(data):
    assert size_of(data) is None


def png_bomb(width, height):
    def chunk(name, content):
        crc = zlib.crc32(name + content)
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", crc)

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    pixels = zlib.compress(bytes(1_000_000))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels)


def jpeg_bomb(width, height):
    data = encoded(".jpg", 16, 16)
    at = data.index(b"\xff\xc0")
    return data[: at + 5] + struct.pack(">HH", height, width) + data[at + 9 :]


def tiff_bomb(width, height):
    tags = [(256, width), (257, height), (322, 2**20), (323, 2**20)]
    entries = b"".join(struct.pack("<HHII", tag, 4, 1, value) for tag, value in tags)
    return b"II*\0" + struct.pack("<IH", 8, len(tags)) + entries + bytes(4)


@pytest.mark.parametrize(
    ("data", "claim"),
    [
        (png_bomb(18_000, 22_000), "18000x22000"),
        (jpeg_bomb(60_000, 50_000), "60000x50000"),
        (tiff_bomb(100, 100), "1048576x1048576"),
        (b"BM" + bytes(12) + struct.pack("<Iii", 40, 40_000, -40_000), "40000x40000"),
    ],
    ids=["png", "jpeg", "tiff by its tiles", "bmp"],
)
def test_bombs_are_refused_before_they_are_decoded(data, claim, monkeypatch):
    monkeypatch.setattr(cv2, "imdecode", lambda *_: pytest.fail("it was decoded"))
    with pytest.raises(RecordingError, match=rf"{claim} pixels; at most 50000000 are decoded"):
        picture_from_compressed(SimpleNamespace(format="jpeg", data=data))


def test_the_limit_is_a_matter_of_the_caller():
    data = encoded(".jpg", 40, 30)
    message = SimpleNamespace(format="jpeg", data=data)
    assert picture_from_compressed(message, max_pixels=1200).bgr.shape == (30, 40, 3)
    with pytest.raises(RecordingError, match="picture_max_pixels"):
        picture_from_compressed(message, max_pixels=1199)
