"""Which intrinsics does this picture have? A CameraInfo's where they fit, else the parameters'."""

from __future__ import annotations

import re
from typing import NamedTuple

import numpy as np

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.errors import ConfigError
from tracker.notes import Note, NoteKind

#: As image_proc names what it has rectified: image_rect, image_rect_color, rectified/image.
_RECTIFIED_NAME = re.compile(r"(^|[/_])rect(ified)?([/_]|$)")
#: Half-way from the principal point to an edge cameras look so far off the axis: from those that
#: show 2 degrees in all to the widest fisheyes (guess).
_HALFWAY_DEG = (0.5, 80.0)
#: The specification's camera.
_SPECIFIED_SIZE = (640, 480)


class PictureCamera(NamedTuple):
    """Intrinsics of pictures of one size, and what is to be said about them."""

    camera: CameraModel
    notes: tuple[Note, ...] = ()


class PictureCameras:
    """Gives pictures of any size their intrinsics; remembers those of the last size.

    Args:
        config: `camera_fx` to `camera_height` serve where no CameraInfo fits; `image_form`.
        image_topic: Where the pictures come from; tells whether they are rectified.
    """

    def __init__(self, config: Config, image_topic: str = "") -> None:
        self._configured = configured_camera(config)
        self._form = config.image_form
        self._is_named_rectified = bool(_RECTIFIED_NAME.search(image_topic))
        self._calibrated: CameraModel | None = None
        self._last: PictureCamera | None = None

    def calibrate(self, camera: CameraModel) -> None:
        """Take in a CameraInfo."""
        if camera != self._calibrated:
            self._calibrated, self._last = camera, None

    def configure(self, config: Config) -> None:
        """Parameters that have changed replace a CameraInfo, until the next one comes."""
        configured = configured_camera(config)
        if configured != self._configured:
            self._configured, self._calibrated, self._last = configured, None, None

    def of(self, width: int, height: int) -> PictureCamera:
        """The intrinsics of a picture of this size."""
        last = self._last
        if last is None or (last.camera.width, last.camera.height) != (width, height):
            self._last = last = self._choose(width, height)
        return last

    def _choose(self, width: int, height: int) -> PictureCamera:
        told = self._calibrated
        if told is None:
            return _assumed(self._configured, width, height)
        try:
            told = self._as_sent(told)
            camera = told.for_picture(width, height)
            _check_plausible(camera)
        except ConfigError as error:
            assumed = _assumed(self._configured, width, height)
            refused = Note(
                NoteKind.CAMERA_INFO_REFUSED,
                f"CameraInfo is not used; the configured intrinsics are used: {error}",
            )
            return PictureCamera(assumed.camera, (refused, *assumed.notes))
        notes = _scaling(told, camera, "CameraInfo's intrinsics")
        # Before it is scaled: whether the driver has told the truth about its own size.
        told = camera if told.width is None else told
        return PictureCamera(camera, notes + _off_middle(told, "CameraInfo", _DRIVER_REMEDY))

    def _as_sent(self, told: CameraModel) -> CameraModel:
        """K with the distortion, or P; a camera that is named rectified may send no P."""
        is_named = self._form == "auto" and self._is_named_rectified and told.rectified is not None
        return told.for_rectified() if self._form == "rectified" or is_named else told


def _check_plausible(camera: CameraModel) -> None:
    """Refuse intrinsics that no camera has.

    Raises:
        ConfigError: The picture would show next to nothing, or half a room in every direction, or
            the lens would end well inside the picture.
    """
    width, height = float(camera.width or 0), float(camera.height or 0)
    corners = [(0.0, camera.cy), (width, camera.cy), (camera.cx, 0.0), (camera.cx, height)]
    halfway = [((x + camera.cx) / 2, (y + camera.cy) / 2) for x, y in corners]
    rays = camera.rays(halfway)
    off_axis_deg = np.degrees(np.arccos(np.clip(rays[:, 0], -1.0, 1.0)))
    low, high = _HALFWAY_DEG
    # Corners beside the principal point of a small region tell nothing.
    inside = np.linalg.norm(np.subtract(halfway, (camera.cx, camera.cy)), axis=-1) > 1.0
    if np.all((off_axis_deg[inside] >= low) & (off_axis_deg[inside] <= high)):
        return
    raise ConfigError(
        f"Focal lengths {camera.fx:g} and {camera.fy:g} with distortion "
        f"{list(camera.distortion)} came for a picture of {camera.width}x{camera.height}; this "
        "is impossible for a camera. Calibrate it, in pixels."
    )


def configured_camera(config: Config) -> CameraModel:
    """The intrinsics of the parameters; of no known size where `camera_width` is 0."""
    return CameraModel(
        config.camera_fx,
        config.camera_fy,
        config.camera_cx,
        config.camera_cy,
        width=config.camera_width or None,
        height=config.camera_height or None,
    )


def _assumed(configured: CameraModel, width: int, height: int) -> PictureCamera:
    """The configured intrinsics for a picture of any size and shape.

    Where the shape differs, the longer side is supposed to show the same, as of the many cameras
    that make wide pictures by leaving out rows, with the principal point as far from the middle.
    """
    told = configured
    if configured.width is None or configured.height is None:
        told = _of_likely_size(configured, width, height)
    size = (told.width or width, told.height or height)
    scale = max(width, height) / max(size)
    camera = told.scaled(scale, scale, width, height)
    camera = CameraModel(
        camera.fx,
        camera.fy,
        camera.cx + (width - scale * size[0]) / 2,
        camera.cy + (height - scale * size[1]) / 2,
        width=width,
        height=height,
    )
    notes = _scaling(told, camera, "configured intrinsics")
    return PictureCamera(camera, notes + _off_middle(told, "camera_cx, camera_cy", _OWN_REMEDY))


def _of_likely_size(configured: CameraModel, width: int, height: int) -> CameraModel:
    """Intrinsics without a size: of 640x480, or of the picture if its middle fits them better."""

    def off_middle(size: tuple[int, int]) -> float:
        return abs(configured.cx / size[0] - 0.5) + abs(configured.cy / size[1] - 0.5)

    size = min(_SPECIFIED_SIZE, (width, height), key=off_middle)
    return configured.scaled(1.0, 1.0, *size)


def _scaling(told: CameraModel, camera: CameraModel, what: str) -> tuple[Note, ...]:
    if told.width is None or (told.width, told.height) == (camera.width, camera.height):
        return ()
    text = (
        f"{what} scaled from {told.width}x{told.height} to {camera.width}x{camera.height}: "
        f"fx {camera.fx:.1f}, fy {camera.fy:.1f}, cx {camera.cx:.1f}, cy {camera.cy:.1f}"
    )
    return (Note(NoteKind.INTRINSICS_SCALED, text),)


def _off_middle(told: CameraModel, what: str, remedy: str) -> tuple[Note, ...]:
    if told.is_centered:
        return ()
    text = (
        f"the principal point of {what}, ({told.cx:.1f}, {told.cy:.1f}), is far from the middle "
        f"of the picture, ({told.middle_px[0]:.1f}, {told.middle_px[1]:.1f}): the intrinsics "
        f"seem to belong to pictures of another size, and bearings may be wrong. {remedy}"
    )
    return (Note(NoteKind.PRINCIPAL_POINT_OFF, text),)


_DRIVER_REMEDY = (
    "Calibrate the camera at this size or correct the driver's CameraInfo (K, width, height, "
    "binning, roi), or set use_camera_info: false and camera_fx to camera_height."
)
_OWN_REMEDY = "Set camera_width and camera_height to the size that they were calibrated at."
