"""From the tracker's containers to serialized ROS messages."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, TypeAlias

import cv2
import numpy as np

from tracker.camera import CameraModel
from tracker.containers import CameraImage, DepthImage, OccupancyGrid, Pose, Scan, Tracks, Truth
from tracker.errors import RecordingError
from tracker.geometry import euler_to_quaternion
from tracker.messages import types
from tracker.messages.depth import depth_message_fields, packed_depth_fields
from tracker.messages.parts import header, point, ros_pose, turn
from tracker.messages.people import tracks_message, truth_message
from tracker.messages.types import Encoded, build, serialize
from tracker.transforms import StampedTransform


@dataclass(frozen=True, slots=True)
class CameraInfo:
    """A camera's intrinsics as /camera_info carries them.

    Attributes:
        stamp_ns: When they hold.
        frame_id: The camera's frame.
        width: Columns of the full picture.
        height: Rows of the full picture.
        camera: The intrinsics.
    """

    stamp_ns: int
    frame_id: str
    width: int
    height: int
    camera: CameraModel


Encodable: TypeAlias = (
    CameraImage
    | DepthImage
    | Scan
    | StampedTransform
    | Iterable[StampedTransform]
    | CameraInfo
    | OccupancyGrid
    | bool
    | str
    | Pose
    | Tracks
    | Truth
    | Encoded
)


def encode(item: Encodable, *, frame_id: str = "map", jpeg_quality: int | None = None) -> Encoded:
    """Serialize one container as the ROS 2 message that says the same.

    | container | message |
    | --- | --- |
    | CameraImage | sensor_msgs/Image (bgr8), or CompressedImage where `jpeg_quality` is given |
    | DepthImage | sensor_msgs/Image (16UC1 or 32FC1), or CompressedImage likewise |
    | Scan | sensor_msgs/LaserScan |
    | StampedTransform, or several | tf2_msgs/TFMessage |
    | CameraInfo | sensor_msgs/CameraInfo |
    | OccupancyGrid | nav_msgs/OccupancyGrid |
    | bool | std_msgs/Bool |
    | str | std_msgs/String |
    | Pose | geometry_msgs/PoseStamped |
    | Tracks | vision_msgs/Detection3DArray, as `encode_tracks` |
    | Truth | vision_msgs/Detection3DArray: id, place, `hand_raised` or `hand_lowered`, and
      `in_view` where that holds |
    | Encoded | itself |

    Args:
        item: The container.
        frame_id: The fixed frame of `Tracks` and `Truth`, which do not name it themselves.
        jpeg_quality: From 1 to 100, to compress images; depth images go as PNG then, without a
            loss (in meters: with the loss of `compressedDepth`).

    Raises:
        RecordingError: There is no message for such an item, or a stamp does not fit into one.
    """
    if isinstance(item, Encoded):
        return item
    return serialize(_message(item, frame_id, jpeg_quality))


def _message(item: Encodable, frame_id: str, jpeg_quality: int | None) -> Any:
    match item:
        case bool() | np.bool_():
            return build(types.BOOL, data=bool(item))
        case str():
            return build(types.STRING, data=item)
        case CameraImage():
            return _image(item) if jpeg_quality is None else _compressed(item, jpeg_quality)
        case DepthImage():
            return _depth(item, is_packed=jpeg_quality is not None)
        case Scan():
            return _scan(item)
        case StampedTransform():
            return _transforms([item])
        case CameraInfo():
            return _camera_info(item)
        case OccupancyGrid():
            return _map(item)
        case Pose():
            return build(
                types.POSE_STAMPED,
                header=header(item.stamp_ns, item.frame_id),
                pose=ros_pose(item.position_m, item.quaternion_xyzw),
            )
        case Tracks():
            return tracks_message(item, frame_id)
        case Truth():
            return truth_message(item, frame_id)
        case list() | tuple() if all(isinstance(part, StampedTransform) for part in item):
            return _transforms(item)
    raise RecordingError(
        f"There is no ROS message for {type(item).__name__}; `encode` lists the supported ones."
    )


def _image(image: CameraImage) -> Any:
    return build(
        types.IMAGE,
        header=header(image.stamp_ns, image.frame_id),
        height=image.height,
        width=image.width,
        encoding="bgr8",
        step=3 * image.width,
        data=np.ascontiguousarray(image.bgr).reshape(-1),
    )


def _compressed(image: CameraImage, quality: int) -> Any:
    if not 1 <= quality <= 100:
        raise RecordingError(f"A JPEG quality of {quality} was given; expected one from 1 to 100.")
    _, data = cv2.imencode(".jpg", image.bgr, [cv2.IMWRITE_JPEG_QUALITY, quality])
    return build(
        types.COMPRESSED_IMAGE,
        header=header(image.stamp_ns, image.frame_id),
        format="bgr8; jpeg compressed bgr8",  # the words of image_transport
        data=data.reshape(-1),
    )


def _depth(image: DepthImage, *, is_packed: bool) -> Any:
    stamp, pixels = header(image.stamp_ns, image.frame_id), image.read()
    if is_packed:
        return build(types.COMPRESSED_IMAGE, header=stamp, **packed_depth_fields(pixels))
    return build(types.IMAGE, header=stamp, **depth_message_fields(pixels))


def _scan(scan: Scan) -> Any:
    beams = max(len(scan.ranges_m) - 1, 0)
    return build(
        types.LASER_SCAN,
        header=header(scan.stamp_ns, scan.frame_id),
        angle_min=scan.angle_min_rad,
        angle_max=scan.angle_min_rad + beams * scan.angle_increment_rad,
        angle_increment=scan.angle_increment_rad,
        time_increment=scan.time_increment_s,
        range_min=scan.range_min_m,
        range_max=scan.range_max_m,
        ranges=scan.ranges_m.astype(np.float32),
    )


def _transforms(samples: Iterable[StampedTransform]) -> Any:
    return build(
        types.TF_MESSAGE,
        transforms=[
            build(
                "geometry_msgs/msg/TransformStamped",
                header=header(sample.stamp_ns, sample.parent),
                child_frame_id=sample.child,
                transform=build(
                    "geometry_msgs/msg/Transform",
                    translation=point(*sample.transform.translation_m, "Vector3"),
                    rotation=turn(sample.transform.quaternion_xyzw),
                ),
            )
            for sample in samples
        ],
    )


def _camera_info(info: CameraInfo) -> Any:
    camera = info.camera
    fx, fy, cx, cy = camera.fx, camera.fy, camera.cx, camera.cy
    return build(
        types.CAMERA_INFO,
        header=header(info.stamp_ns, info.frame_id),
        height=info.height,
        width=info.width,
        # RViz and image_proc know no empty name for "no distortion".
        distortion_model=camera.distortion_model or "plumb_bob",
        d=np.array(camera.distortion or (0.0,) * 5),
        k=np.array([fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0]),
        r=np.eye(3).reshape(-1),
        p=np.array([fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0]),
    )


def _map(grid: OccupancyGrid) -> Any:
    rows, columns = grid.cells.shape
    x_m, y_m, yaw_rad = grid.origin
    stamped = header(grid.stamp_ns, grid.frame_id)
    return build(
        types.OCCUPANCY_GRID,
        header=stamped,
        info=build(
            "nav_msgs/msg/MapMetaData",
            map_load_time=stamped.stamp,
            resolution=grid.resolution_m,
            width=columns,
            height=rows,
            origin=ros_pose((x_m, y_m, 0.0), euler_to_quaternion(0.0, 0.0, yaw_rad)),
        ),
        data=grid.cells.reshape(-1),
    )
