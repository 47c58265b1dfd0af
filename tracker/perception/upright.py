"""How must a picture be turned so that people stand upright in it? For cameras that are rolled.

The models and the raise rules look for "up" in the picture. Pictures of a camera that lies on its
side, hangs upside down or leans are turned before, and what was found is turned back, so that
pixels always belong to the camera's own intrinsics.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tracker.containers import CameraImage, FloatArray, Hands, ImageArray
from tracker.geometry import RigidTransform

#: Rolls this close to the turn in force change nothing. The raise rules bear a lean, a turn by
#: other than a quarter costs time and sharpness, and those who are followed are forgotten when it
#: changes; most robots on a ramp stay below (guess).
TOLERANCE_DEG = 12.0
#: A camera that looks this steeply up or down shows nobody upright (guess): what gravity leaves in
#: the picture, as a share.
_LEVEL_SHARE_MIN = 0.17


@dataclass(frozen=True, slots=True)
class Turn:
    """A turn of pictures about their middle; the picture grows until all of it fits.

    Attributes:
        clockwise_deg: In (-180, 180]. Quarter turns move pixels without a loss.
    """

    clockwise_deg: float = 0.0

    def picture(self, image: CameraImage) -> CameraImage:
        """The image turned; the very same without a turn."""
        if self.clockwise_deg == 0.0:
            return image
        return replace(image, bgr=self._turn_pixels(image.bgr))

    def boxes(self, boxes_px: FloatArray, image_size: tuple[int, int]) -> FloatArray:
        """Upright boxes in the turned picture around boxes, (B, 4), of one of (width, height)."""
        if self.clockwise_deg == 0.0:
            return boxes_px
        matrix = self._matrix(image_size)
        center = (boxes_px[:, :2] + boxes_px[:, 2:]) / 2.0 @ matrix[:, :2].T + matrix[:, 2]
        half = (boxes_px[:, 2:] - boxes_px[:, :2]) / 2.0 @ np.abs(matrix[:, :2]).T
        return np.concatenate([center - half, center + half], axis=-1)

    def hands_back(self, hands: Hands, image_size: tuple[int, int]) -> Hands:
        """What was found in the turned picture, in pixels of the picture before its turn."""
        if self.clockwise_deg == 0.0:
            return hands
        matrix = self._matrix(image_size)
        turn, shift = matrix[:, :2], matrix[:, 2]
        return replace(
            hands,
            landmarks_px=(hands.landmarks_px - shift) @ turn,  # a rotation's inverse: transposed
            torso_px=(hands.torso_px - shift) @ turn,
        )

    def _turned_size(self, image_size: tuple[int, int]) -> tuple[int, int]:
        width, height = np.ceil(np.abs(self._rotation()) @ image_size - 1e-6).astype(int).tolist()
        return width, height

    def _rotation(self) -> FloatArray:
        """Shape (2, 2), exact for quarter turns: x to the right and y down, turned clockwise."""
        angle_rad = np.radians(self.clockwise_deg)
        cos, sin = np.cos(angle_rad), np.sin(angle_rad)
        rotation = np.array([[cos, -sin], [sin, cos]])
        return rotation.round() if self.clockwise_deg % 90.0 == 0.0 else rotation

    def _matrix(self, image_size: tuple[int, int]) -> FloatArray:
        """Shape (2, 3): affine map from pixels of a picture to those of the turned one."""
        rotation = self._rotation()
        middle = (np.array(image_size) - 1.0) / 2.0
        turned_middle = (np.array(self._turned_size(image_size)) - 1.0) / 2.0
        return np.column_stack([rotation, turned_middle - rotation @ middle])

    def _turn_pixels(self, bgr: ImageArray) -> ImageArray:
        import cv2  # only a rolled camera needs it

        quarters = {
            90.0: cv2.ROTATE_90_CLOCKWISE,
            -90.0: cv2.ROTATE_90_COUNTERCLOCKWISE,
            180.0: cv2.ROTATE_180,
        }
        if self.clockwise_deg in quarters:
            return np.asarray(cv2.rotate(bgr, quarters[self.clockwise_deg]), dtype=np.uint8)
        size = bgr.shape[1], bgr.shape[0]
        turned = cv2.warpAffine(
            bgr, self._matrix(size), self._turned_size(size), flags=cv2.INTER_LINEAR
        )
        return np.asarray(turned, dtype=np.uint8)


def upright_turn(fixed_from_camera: RigidTransform, before: Turn | None = None) -> Turn:
    """The turn after which a camera's pictures show people upright.

    A rolled camera's is its roll, or the quarter turn close to it. A turn stays in force while the
    roll is within `TOLERANCE_DEG` of it, and while the camera looks straight up or down, where the
    picture has no upright.

    Args:
        fixed_from_camera: The camera with body axes (x forward) in a frame whose z points up.
        before: The turn of the last picture; None before the first.
    """
    before = before or Turn()
    _, left, up = fixed_from_camera.matrix[2].tolist()  # the vertical in the camera's axes
    if np.hypot(left, up) < _LEVEL_SHARE_MIN:
        return before
    roll_deg = float(np.degrees(fixed_from_camera.roll_rad))
    if _apart_deg(roll_deg, before.clockwise_deg) <= TOLERANCE_DEG:
        return before
    quarter_deg = 90.0 * round(roll_deg / 90.0)
    if _apart_deg(roll_deg, quarter_deg) <= TOLERANCE_DEG:
        return Turn(180.0 if quarter_deg == -180.0 else quarter_deg)
    return Turn(roll_deg)


def _apart_deg(first_deg: float, second_deg: float) -> float:
    return abs((first_deg - second_deg + 180.0) % 360.0 - 180.0)
