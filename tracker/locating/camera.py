"""Where does the camera stand, at the stamp of an image?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.config import Config
from tracker.containers import FloatArray
from tracker.errors import TransformError
from tracker.geometry import RigidTransform, euler_to_quaternion
from tracker.ranging import body_pose
from tracker.transforms import Transforms


@dataclass(frozen=True, slots=True, eq=False)
class CameraPlace:
    """The camera at the stamp of one image.

    Attributes:
        fixed_from_camera: With body axes (x forward); where it is unknown, what is supposed.
        frame_id: The frame that places are in: the fixed one, before the first transform the
            camera's; None where that is unknown.
        missing: Why it is not located; empty where it is.
        is_first: The first place after images without any.
        moved: Shape (3,): x_m, y_m, yaw_rad that the camera has moved by since it was supposed to
            stand still; None where it was located all the time.
        unseen_s: In which time.
    """

    fixed_from_camera: RigidTransform
    frame_id: str | None
    missing: str = ""
    is_first: bool = False
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
            stamp_ns: Of the image.
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


def mounted(target_from_camera: RigidTransform, config: Config) -> RigidTransform:
    """The camera as it is mounted, where `camera_roll_deg` tells what its transform does not."""
    roll_rad = float(np.radians(config.camera_roll_deg))
    if not roll_rad:
        return target_from_camera
    roll = RigidTransform(quaternion_xyzw=euler_to_quaternion(roll_rad, 0.0, 0.0))
    return target_from_camera @ roll
