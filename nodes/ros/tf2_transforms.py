"""Where was each frame? tf2's buffer, as the pipeline asks for it."""

from __future__ import annotations

from geometry_msgs.msg import TransformStamped
from rclpy.time import Time
from tf2_ros import Buffer, TransformException

from tracker.errors import TransformError
from tracker.geometry import RigidTransform
from tracker.transforms import StampedTransform, checked

#: A buffer that ends later than this after a stamp is of the time before a jump.
_LATER_NS = 1_000_000_000


class Tf2Transforms:
    """`tracker.transforms.Transforms` on a tf2 buffer.

    It is filled with `add` rather than by a TransformListener: that one's subscription hands out
    half-filled messages for broken bytes, which could be neither refused nor counted.

    Args:
        buffer: Made with the node, so that it is emptied when simulated time jumps back.
    """

    def __init__(self, buffer: Buffer) -> None:
        self._buffer = buffer
        self._latest_ns = 0

    def add(self, sample: StampedTransform) -> None:
        """Take in one transform.

        Raises:
            TransformError: tf2 would ignore it.
        """
        sample = checked(sample)
        message = TransformStamped()
        message.header.stamp = Time(nanoseconds=sample.stamp_ns).to_msg()
        message.header.frame_id, message.child_frame_id = sample.parent, sample.child
        at, turn = message.transform.translation, message.transform.rotation
        at.x, at.y, at.z = map(float, sample.transform.translation_m)
        turn.x, turn.y, turn.z, turn.w = sample.transform.quaternion_xyzw
        if sample.is_static:
            self._buffer.set_transform_static(message, "hand_detector")
        else:
            self._latest_ns = max(self._latest_ns, sample.stamp_ns)
            self._buffer.set_transform(message, "hand_detector")

    def lookup(self, target: str, source: str, stamp_ns: int) -> RigidTransform:
        """`target_from_source` at a stamp.

        Raises:
            TransformError: tf2 does not know it, for the reason it gives.
        """
        try:
            found = self._buffer.lookup_transform_core(*_question(target, source, stamp_ns))
        except TransformException as error:
            raise TransformError(f"{error}") from error
        at, turn = found.transform.translation, found.transform.rotation
        return RigidTransform((at.x, at.y, at.z), (turn.x, turn.y, turn.z, turn.w))

    def can_lookup(self, target: str, source: str, stamp_ns: int) -> bool:
        """Whether `lookup` would answer."""
        return bool(self._buffer.can_transform_core(*_question(target, source, stamp_ns))[0])

    def forget_after(self, stamp_ns: int) -> None:
        """Forget the moving transforms, if they are later than a stamp.

        tf2 cannot forget some of them, and would ignore everything earlier than what it knows.
        """
        if self._latest_ns > stamp_ns + _LATER_NS:
            self.clear()

    def clear(self) -> None:
        """Forget the moving transforms; tf2 keeps the static ones."""
        self._buffer.clear()
        self._latest_ns = 0


def _question(target: str, source: str, stamp_ns: int) -> tuple[str, str, Time]:
    # To tf2 the stamp zero means "the latest".
    return target.lstrip("/"), source.lstrip("/"), Time(nanoseconds=max(stamp_ns, 1))
