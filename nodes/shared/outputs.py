"""What is published for a processed image, and in which order?"""

from __future__ import annotations

from collections.abc import Callable

from nodes.shared.topics import Output
from tracker.config import Config
from tracker.containers import CameraImage, FloatArray, FrameResult, Tracks, WaitingList
from tracker.messages import (
    Encoded,
    encode,
    encode_markers,
    encode_raised,
    encode_tracks,
    encode_waiting_list,
)
from tracker.report.video.debug_picture import draw_debug_image

#: Hands a message to the wire.
Publish = Callable[[Output, Encoded], None]
#: Whether anybody listens; drawing for nobody costs more than ranging and tracking together.
HasSubscribers = Callable[[Output], bool]


def publish_answer(result: FrameResult, publish: Publish) -> None:
    """The poses, then the Bool: when the Bool arrives, the pose of its image is already there."""
    if result.customer_pose is not None:
        publish(Output.CUSTOMER_POSE, encode(result.customer_pose))
    if result.approach_pose is not None:
        publish(Output.APPROACH_POSE, encode(result.approach_pose))
    publish(Output.HAND_RAISED, encode(result.hand_raised))
    raised = encode_raised(result.tracks, frame_id=result.frame_id, is_on_floor=result.is_on_floor)
    publish(Output.RAISED_HANDS, raised)


def publish_waiting_list(
    calls: WaitingList, robot_xy_m: FloatArray, config: Config, publish: Publish
) -> None:
    """Everybody who has called, with the poses that hold for the robot's place.

    Args:
        calls: The list, with places in the fixed frame.
        robot_xy_m: Shape (2,): the camera in the fixed frame.
        config: `fixed_frame` and `approach_distance_m`.
        publish: Hands a message to the wire.
    """
    message = encode_waiting_list(
        calls,
        frame_id=config.fixed_frame,
        robot_xy_m=robot_xy_m,
        approach_distance_m=config.approach_distance_m,
    )
    publish(Output.WAITING_LIST, message)


def publish_views(
    image: CameraImage,
    result: FrameResult,
    config: Config,
    publish: Publish,
    has_subscribers: HasSubscribers,
) -> None:
    """Confirmed customers as detections and markers, and the debug image, for who listens.

    All of them bear the image's own stamp. Nothing is said of places in a frame that is unknown.
    """
    frame_id, confirmed = result.frame_id, result.tracks[result.tracks.confirmed]
    if frame_id is not None and has_subscribers(Output.TRACKS):
        said = encode_tracks(confirmed, frame_id=frame_id, is_on_floor=result.is_on_floor)
        publish(Output.TRACKS, said)
    if frame_id is not None and has_subscribers(Output.MARKERS):
        approach = result.approach_pose
        publish(Output.MARKERS, encode_markers(confirmed, frame_id=frame_id, approach=approach))
    if has_subscribers(Output.DEBUG_IMAGE):
        picture = draw_debug_image(image, result.hands, result.tracks, config)
        debug = CameraImage(result.stamp_ns, image.frame_id, picture)
        publish(Output.DEBUG_IMAGE, encode(debug))


def publish_nobody(
    stamp_ns: int, frame_id: str | None, publish: Publish, has_subscribers: HasSubscribers
) -> None:
    """Publish that nobody is there, so that no raised hand stays latched.

    Args:
        stamp_ns: Of the last image.
        frame_id: The frame that people were reported in, if they were.
        publish: Hands a message to the wire.
        has_subscribers: Whether anybody listens to an output.
    """
    publish(Output.HAND_RAISED, encode(False))
    nobody = Tracks.none(stamp_ns)
    publish(Output.RAISED_HANDS, encode_raised(nobody, frame_id=frame_id))
    if frame_id is None:
        return
    if has_subscribers(Output.TRACKS):
        publish(Output.TRACKS, encode_tracks(nobody, frame_id=frame_id))
    if has_subscribers(Output.MARKERS):
        publish(Output.MARKERS, encode_markers(nobody, frame_id=frame_id))
