"""Which depth image belongs to an image, and where was it taken? The nearest in time."""

from __future__ import annotations

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import DepthImage
from tracker.errors import TrackerError, TransformError
from tracker.geometry import RigidTransform
from tracker.locating.camera import CameraPlace, mounted
from tracker.notes import Note, NoteKind
from tracker.ranging import body_pose
from tracker.ranging.depth import DepthPoints, depth_points
from tracker.transforms import Transforms


class DepthLocator:
    """Knows the depth camera, once its intrinsics have come.

    Until then its images are supposed to be registered: to show what the color camera shows, pixel
    by pixel.
    """

    def __init__(self) -> None:
        self._camera: CameraModel | None = None

    def calibrate(self, camera: CameraModel) -> None:
        """Take in the intrinsics of the depth camera."""
        self._camera = camera

    def choose(
        self,
        images: list[DepthImage],
        transforms: Transforms,
        stamp_ns: int,
        place: CameraPlace,
        color: CameraModel,
        color_frame: str,
        config: Config,
    ) -> tuple[DepthPoints | None, list[Note]]:
        """The depth image that is used for a color image, as points of the fixed frame.

        Args:
            images: Those that have come, the nearest first.
            transforms: Where frames were.
            stamp_ns: Of the color image.
            place: Where that was taken.
            color: Intrinsics of the color image.
            color_frame: The color image's own frame.
            config: The frames and the ranging group.

        Returns:
            The points; None with the reason where no depth image can be used.
        """
        timely = [
            image
            for image in images
            if abs(image.stamp_ns - stamp_ns) <= config.scan_max_age_s * 1e9
        ]
        if not timely:
            return None, [_why_none(images, stamp_ns, config)]
        failure = ""
        for image in timely:
            try:
                pose = _located(image, transforms, place, color_frame, config)
            except TransformError as error:
                failure = failure or str(error)
                continue
            is_on_floor = place.is_located and config.fixed_frame != config.camera_frame
            floor_z_m = 0.0 if is_on_floor else float("nan")
            try:
                points = depth_points(image, self._camera or color, pose, floor_z_m=floor_z_m)
            except TrackerError as error:
                return None, [Note(NoteKind.DEPTH_UNREADABLE, f"depth unused: {error}")]
            return points, []
        return None, [Note(NoteKind.DEPTH_NOT_LOCATED, f"depth unused: {failure}")]


def _located(
    image: DepthImage,
    transforms: Transforms,
    place: CameraPlace,
    color_frame: str,
    config: Config,
) -> RigidTransform:
    """The depth camera with body axes in the fixed frame, at the depth image's stamp.

    Raises:
        TransformError: It is not known.
    """
    is_registered = image.frame_id in ("", color_frame, config.camera_frame)
    frame = (config.camera_frame or color_frame) if is_registered else image.frame_id
    axes = config.camera_axes if is_registered else "auto"
    if place.is_located and config.fixed_frame != config.camera_frame:
        found = transforms.lookup(config.fixed_frame, frame, image.stamp_ns)
        pose = body_pose(found, frame, axes)
        return mounted(pose, config) if is_registered else pose
    if is_registered:
        return place.fixed_from_camera
    color = config.camera_frame or color_frame
    beside = transforms.lookup(color, image.frame_id, image.stamp_ns)
    color_from_depth = body_pose(
        RigidTransform(), color, config.camera_axes
    ).inverse() @ body_pose(beside, frame, axes)
    return place.fixed_from_camera @ color_from_depth


def _why_none(images: list[DepthImage], stamp_ns: int, config: Config) -> Note:
    if not images:
        return Note(NoteKind.NO_DEPTH, "no depth image was received")
    off_s = (images[0].stamp_ns - stamp_ns) / 1e9
    where = f"{abs(off_s):.3f} s {'later' if off_s > 0 else 'earlier'}"
    text = f"no depth image within {config.scan_max_age_s:g} s: the nearest is {where}"
    return Note(NoteKind.DEPTH_TOO_OLD, text)
