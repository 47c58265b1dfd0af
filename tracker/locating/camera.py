"""Where does the camera stand, at the stamp of an image?"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray
from tracker.errors import TransformError
from tracker.geometry import RigidTransform, euler_to_quaternion, normalize_angle
from tracker.ranging import body_pose
from tracker.transforms import Transforms

#: The camera's motion is told by its poses so long before and after (guess: odometry at 20 Hz).
_HALF_NS = 50_000_000


@dataclass(frozen=True, slots=True, eq=False)
class CameraPlace:
    """The camera at the stamp of one image.

    Attributes:
        fixed_from_camera: With body axes (x forward); where it is unknown, what is supposed.
        frame_id: The frame that places are in: the fixed one, before the first transform the
            camera's; None where that is unknown.
        missing: Why it is not located; empty where it is.
        is_first: The first place after images without any.
        motion: Shape (3,): x_mps, y_mps, yaw_radps of the camera in the fixed frame, from
            transforms around the stamp; zeros where they do not tell.
        moved: Shape (3,): x_m, y_m, yaw_rad that the camera has moved by since it was supposed to
            stand still; None where it was located all the time.
        unseen_s: In which time.
    """

    fixed_from_camera: RigidTransform
    frame_id: str | None
    missing: str = ""
    is_first: bool = False
    motion: FloatArray = field(default_factory=lambda: np.zeros(3))
    moved: FloatArray | None = None
    unseen_s: float = 0.0

    @property
    def is_located(self) -> bool:
        """Whether a transform has told it."""
        return not self.missing


class CameraLocator:
    """Remembers where the camera was last.

    Before the first transform the camera itself is the fixed frame: hands are still told apart and
    counted. Where a transform is missing later, the camera is supposed where it was.
    """

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget where the camera was."""
        self._last: RigidTransform | None = None
        self._located_ns, self._is_supposed = 0, False

    def locate(
        self, transforms: Transforms, stamp_ns: int, frame_id: str, config: Config
    ) -> CameraPlace:
        """The camera in the fixed frame.

        Args:
            transforms: Where frames were.
            stamp_ns: Of what the image shows; `shown_ns`.
            frame_id: Of the image; `camera_frame` wins over it.
            config: The frames group.
        """
        frame = config.camera_frame or frame_id
        try:
            found = transforms.lookup(config.fixed_frame, frame, stamp_ns)
        except TransformError as error:
            return self._supposed(frame, config, str(error))
        pose = mounted(body_pose(found, frame, config.camera_axes), config)
        before, was_supposed = self._last, self._is_supposed
        unseen_s = (stamp_ns - self._located_ns) / 1e9
        self._last, self._located_ns, self._is_supposed = pose, stamp_ns, False
        return CameraPlace(
            pose,
            config.fixed_frame,
            is_first=before is None,
            motion=_motion(transforms, stamp_ns, frame, pose, config),
            moved=(pose @ before.inverse()).planar
            if before is not None and was_supposed
            else None,
            unseen_s=unseen_s,
        )

    def _supposed(self, frame: str, config: Config, missing: str) -> CameraPlace:
        if self._last is not None:
            self._is_supposed = True
            return CameraPlace(self._last, None, missing)
        unmoved = RigidTransform()
        pose = mounted(unmoved, config)
        # Places in a frame with optical axes, or on its side, would be read wrongly.
        is_plain = pose == unmoved == body_pose(unmoved, frame, config.camera_axes)
        return CameraPlace(pose, frame if is_plain else None, missing)


def shown_ns(stamp_ns: int, offset_s: float) -> int:
    """The true time of sensor data whose stamps are late by an offset; never before 0."""
    return max(stamp_ns - round(offset_s * 1e9), 0)


def _motion(
    transforms: Transforms, stamp_ns: int, frame: str, pose: RigidTransform, config: Config
) -> FloatArray:
    """Shape (3,): x_mps, y_mps, yaw_radps of the camera, over half an interval at least."""
    ends = [(0, pose.planar)]
    for away_ns in (-_HALF_NS, _HALF_NS):
        try:
            found = transforms.lookup(config.fixed_frame, frame, stamp_ns + away_ns)
        except TransformError:  # the next transform has mostly not come yet
            continue
        turned = mounted(body_pose(found, frame, config.camera_axes), config)
        ends.append((away_ns, turned.planar))
    (begin_ns, begin), (end_ns, end) = min(ends, key=_time), max(ends, key=_time)
    if begin_ns == end_ns:
        return np.zeros(3)
    way = end - begin
    way[2] = normalize_angle(way[2])
    return np.asarray(way / ((end_ns - begin_ns) / 1e9))


def _time(end: tuple[int, FloatArray]) -> int:
    return end[0]


def mounted(target_from_camera: RigidTransform, config: Config) -> RigidTransform:
    """The camera's pose with `camera_roll_deg`, the roll that its transform omits."""
    roll_rad = float(np.radians(config.camera_roll_deg))
    if not roll_rad:
        return target_from_camera
    roll = RigidTransform(quaternion_xyzw=euler_to_quaternion(roll_rad, 0.0, 0.0))
    return target_from_camera @ roll
