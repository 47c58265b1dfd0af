"""What do the names of image encodings mean? Those of ROS, of drivers and of V4L2."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import cv2


@dataclass(frozen=True, slots=True)
class Packed:
    """Every pixel's numbers lie beside each other.

    Attributes:
        channels: Numbers a pixel, on average.
        to_bgr: OpenCV's color conversion; None where the numbers are blue, green, red already.
        bits: That a number holds; None for numbers of 16 bits of which nobody knows how many are
            in use.
        order: Where the bytes of each group of four are to come from; empty if they are in order.
    """

    channels: int
    to_bgr: int | None = None
    bits: int | None = 8
    order: tuple[int, ...] = ()

    @property
    def bytes_each(self) -> int:
        """Bytes of one number."""
        return 1 if self.bits == 8 else 2


@dataclass(frozen=True, slots=True)
class Planar:
    """A plane of brightness, then one of color (u and v in turn) or two.

    Attributes:
        across: Columns that share a color.
        down: Rows that share a color.
        is_interleaved: Both colors lie in one plane.
        is_v_first: v comes before u.
    """

    across: int
    down: int
    is_interleaved: bool
    is_v_first: bool = False


@dataclass(frozen=True, slots=True)
class File:
    """The bytes of an image file, JPEG above all."""


Encoding: TypeAlias = Packed | Planar | File

# Of a Bayer pattern OpenCV names the second row, ROS the first.
_BAYER = {
    "rggb": cv2.COLOR_BayerBG2BGR,
    "bggr": cv2.COLOR_BayerRG2BGR,
    "gbrg": cv2.COLOR_BayerGR2BGR,
    "grbg": cv2.COLOR_BayerGB2BGR,
}
_COLORS = {
    "bgr": (3, None),
    "rgb": (3, cv2.COLOR_RGB2BGR),
    "bgra": (4, cv2.COLOR_BGRA2BGR),
    "rgba": (4, cv2.COLOR_RGBA2BGR),
    "mono": (1, cv2.COLOR_GRAY2BGR),
}
_UYVY = Packed(2, cv2.COLOR_YUV2BGR_UYVY)
_YUYV = Packed(2, cv2.COLOR_YUV2BGR_YUY2)

#: By name in small letters.
ENCODINGS: dict[str, Encoding] = {
    **{f"{name}8": Packed(*color) for name, color in _COLORS.items()},
    **{f"{name}16": Packed(*color, bits=None) for name, color in _COLORS.items()},
    **{f"mono{bits}": Packed(*_COLORS["mono"], bits=bits) for bits in (10, 12, 14)},
    "8uc1": Packed(*_COLORS["mono"]),
    "8uc3": Packed(*_COLORS["bgr"]),
    "8uc4": Packed(*_COLORS["bgra"]),
    "16uc1": Packed(*_COLORS["mono"], bits=None),
    "16uc3": Packed(*_COLORS["bgr"], bits=None),
    "16uc4": Packed(*_COLORS["bgra"], bits=None),
    "gray8": Packed(*_COLORS["mono"]),
    "rgb24": Packed(*_COLORS["rgb"]),
    "bgr24": Packed(*_COLORS["bgr"]),
    **{f"bayer_{name}8": Packed(1, code) for name, code in _BAYER.items()},
    **{f"bayer_{name}16": Packed(1, code, bits=None) for name, code in _BAYER.items()},
    **{
        f"bayer_{name}{bits}": Packed(1, code, bits=bits)
        for name, code in _BAYER.items()
        for bits in (10, 12, 14)
    },
    **dict.fromkeys(("yuv422", "uyvy", "uyvy422", "yuv422_uyvy"), _UYVY),
    **dict.fromkeys(("yuyv", "yuy2", "yuyv422", "yuv422_yuy2", "yuv422_yuyv"), _YUYV),
    **dict.fromkeys(("yvyu", "yvyu422"), Packed(2, cv2.COLOR_YUV2BGR_YVYU)),
    **dict.fromkeys(("vyuy", "vyuy422"), Packed(2, cv2.COLOR_YUV2BGR_UYVY, order=(2, 1, 0, 3))),
    "nv12": Planar(2, 2, is_interleaved=True),
    "nv21": Planar(2, 2, is_interleaved=True, is_v_first=True),
    "nv16": Planar(2, 1, is_interleaved=True),
    "nv61": Planar(2, 1, is_interleaved=True, is_v_first=True),
    "nv24": Planar(1, 1, is_interleaved=True),
    "nv42": Planar(1, 1, is_interleaved=True, is_v_first=True),
    **dict.fromkeys(
        ("i420", "yuv420", "yuv420p", "iyuv", "yu12"), Planar(2, 2, is_interleaved=False)
    ),
    **dict.fromkeys(("yv12", "yvu420"), Planar(2, 2, is_interleaved=False, is_v_first=True)),
    **dict.fromkeys(("i422", "yuv422p"), Planar(2, 1, is_interleaved=False)),
    **dict.fromkeys(("i444", "yuv444p"), Planar(1, 1, is_interleaved=False)),
    **dict.fromkeys(("jpeg", "jpg", "mjpeg", "mjpg", "png"), File()),
}
