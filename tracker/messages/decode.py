"""From ROS sensor messages to the tracker's containers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np

from tracker.camera import CameraModel, DepthCamera, Pinhole, Sensor
from tracker.containers import CameraImage, DepthImage, OccupancyGrid, Scan, Truth
from tracker.errors import ConfigError, RecordingError, ShapeError
from tracker.geometry import RigidTransform
from tracker.messages import types
from tracker.messages.depth import depth_from_compressed, depth_from_image
from tracker.messages.images import Picture, picture_from_compressed, picture_from_image
from tracker.messages.picture_size import MAX_PIXELS
from tracker.transforms import StampedTransform

#: What sensors, and simulations, say.
Event: TypeAlias = (
    CameraImage
    | DepthImage
    | Scan
    | StampedTransform
    | CameraModel
    | DepthCamera
    | OccupancyGrid
    | Truth
)


def decode(
    type_name: str,
    cdr: bytes | memoryview,
    *,
    is_static: bool = False,
    is_depth: bool = False,
    max_pixels: int = MAX_PIXELS,
) -> list[Event]:
    """Read one serialized message.

    Args:
        type_name: `package/msg/Name`; one of `DECODABLE`.
        cdr: The serialized message with its encapsulation.
        is_static: Transforms hold at every time (they came on /tf_static).
        is_depth: Images and intrinsics are a depth camera's (they came on its topics).
        max_pixels: A larger picture is refused before it is decoded.

    Returns:
        One event; any number where the message carries transforms.

    Raises:
        RecordingError: The type is not decodable, or the bytes are no such message.
        ShapeError: A scan or a map makes no sense.
        ClockError: A stamp is negative.
        ConfigError: Camera intrinsics make no sense.
    """
    message = types.deserialize(type_name, cdr)
    return events_from_message(
        type_name, message, is_static=is_static, is_depth=is_depth, max_pixels=max_pixels
    )


def events_from_message(
    type_name: str,
    message: Any,
    *,
    is_static: bool = False,
    is_depth: bool = False,
    max_pixels: int = MAX_PIXELS,
) -> list[Event]:
    """Read one message object, of rclpy or anything with the same field names.

    Args, returns and raises as `decode`.
    """
    if type_name in (types.TF_MESSAGE, types.TF_MESSAGE_ROS1):
        return list(transforms_from_message(message, is_static=is_static))
    if is_depth and type_name == types.CAMERA_INFO:
        return [DepthCamera(camera_from_message(message))]
    convert_image = (_DEPTHS if is_depth else _IMAGES).get(type_name)
    if convert_image is not None:
        return [convert_image(message, max_pixels)]
    convert = _SINGLE.get(type_name)
    if convert is None:
        raise RecordingError(
            f"Messages of type {type_name!r} are not supported; supported are "
            f"{', '.join(sorted(DECODABLE))}."
        )
    return [convert(message)]


def image_from_message(message: Any, max_pixels: int = MAX_PIXELS) -> CameraImage:
    """The picture of a sensor_msgs/Image."""
    return _camera_image(message, picture_from_image(message, max_pixels))


def image_from_compressed(message: Any, max_pixels: int = MAX_PIXELS) -> CameraImage:
    """The picture of a sensor_msgs/CompressedImage."""
    return _camera_image(message, picture_from_compressed(message, max_pixels))


def depth_from_message(message: Any, max_pixels: int = MAX_PIXELS) -> DepthImage:
    """The depths of a sensor_msgs/Image or CompressedImage."""
    is_packed = hasattr(message, "format")
    read = (depth_from_compressed if is_packed else depth_from_image)(message, max_pixels)
    return DepthImage(stamp_ns(message.header), message.header.frame_id, read)


def scan_from_message(message: Any) -> Scan:
    """The turn of a sensor_msgs/LaserScan."""
    scan = Scan(
        stamp_ns=stamp_ns(message.header),
        frame_id=message.header.frame_id,
        angle_min_rad=float(message.angle_min),
        angle_increment_rad=float(message.angle_increment),
        range_min_m=float(message.range_min),
        range_max_m=float(message.range_max),
        ranges_m=np.array(message.ranges, dtype=np.float64),
        time_increment_s=float(message.time_increment),
    )
    _check_beams(scan, float(message.angle_max))
    return scan


def camera_from_message(message: Any) -> CameraModel:
    """The intrinsics of a sensor_msgs/CameraInfo, for the pictures as they are sent.

    K and P belong to a picture of `width` x `height`. A region of interest is cut from that (all
    of it where the region has no size), then binned. A camera that fills in P alone sends
    rectified pictures.

    Raises:
        ConfigError: The intrinsics make no sense, or the region does not lie in the picture.
    """
    k = message.K if hasattr(message, "K") else message.k  # ROS 1 writes it large
    d = message.D if hasattr(message, "D") else message.d
    p = message.P if hasattr(message, "P") else message.p
    width, height, roi = int(message.width), int(message.height), message.roi
    across, down = max(int(message.binning_x), 1), max(int(message.binning_y), 1)
    left, top = int(roi.x_offset), int(roi.y_offset)
    wide, high = int(roi.width) or width - left, int(roi.height) or height - top
    is_sized = width > 0 and height > 0
    if is_sized and not (0 < wide <= width - left and 0 < high <= height - top):
        raise ConfigError(
            f"A CameraInfo names a region of {wide}x{high} from column {left} and row {top} "
            f"of a picture of {width}x{height}; it must lie within. Correct the driver's roi, or "
            "set use_camera_info: false."
        )
    is_cut = is_sized and (wide, high) != (width, height)

    def sent(fx: float, fy: float, cx: float, cy: float) -> Pinhole:
        return Pinhole(fx / across, fy / down, (cx - left) / across, (cy - top) / down)

    distorted = sent(float(k[0]), float(k[4]), float(k[2]), float(k[5]))
    rectified = sent(float(p[0]), float(p[5]), float(p[2]), float(p[6])) if p[0] > 0.0 else None
    is_rectified = rectified is not None and not any(k)
    return CameraModel(
        *(rectified if rectified is not None and is_rectified else distorted),
        distortion=() if is_rectified else tuple(float(value) for value in d),
        distortion_model="" if is_rectified else message.distortion_model,
        width=max(wide // across, 1) if is_sized else None,
        height=max(high // down, 1) if is_sized else None,
        sensor=Sensor(-left / across, -top / down, width / across, height / down)
        if is_cut
        else None,
        rectified=rectified,
    )


def map_from_message(message: Any) -> OccupancyGrid:
    """The map of a nav_msgs/OccupancyGrid.

    Raises:
        ShapeError: It has another number of cells than it says, or they make no sense.
    """
    info, at, turn = message.info, message.info.origin.position, message.info.origin.orientation
    cells = np.array(message.data, dtype=np.int8)
    rows, columns = int(info.height), int(info.width)
    if len(cells) != rows * columns:
        raise ShapeError(
            f"A map says {columns}x{rows} cells and brings {len(cells)}; they must agree."
        )
    yaw_rad = RigidTransform(quaternion_xyzw=(turn.x, turn.y, turn.z, turn.w)).yaw_rad
    return OccupancyGrid(
        stamp_ns=stamp_ns(message.header),
        frame_id=message.header.frame_id,
        resolution_m=float(info.resolution),
        origin=(float(at.x), float(at.y), yaw_rad),
        cells=cells.reshape(rows, columns),
    )


def transforms_from_message(message: Any, *, is_static: bool = False) -> list[StampedTransform]:
    """The transforms of a tf2_msgs/TFMessage."""
    samples = []
    for sample in message.transforms:
        at, turn = sample.transform.translation, sample.transform.rotation
        samples.append(
            StampedTransform(
                stamp_ns=stamp_ns(sample.header),
                parent=sample.header.frame_id,
                child=sample.child_frame_id,
                transform=RigidTransform((at.x, at.y, at.z), (turn.x, turn.y, turn.z, turn.w)),
                is_static=is_static,
            )
        )
    return samples


def truth_from_message(message: Any) -> Truth:
    """Simulated people, from the vision_msgs/Detection3DArray that `encode` makes of them."""
    people = message.detections
    said = [{result.hypothesis.class_id for result in person.results} for person in people]
    try:
        ids = [int(person.id) for person in people]
    except ValueError as error:
        raise RecordingError(
            f"Detections came whose ids are no numbers ({error}); they are no simulated people."
        ) from error
    return Truth(
        stamp_ns=stamp_ns(message.header),
        id=np.array(ids, dtype=np.int64),
        xy_m=np.array(
            [[person.bbox.center.position.x, person.bbox.center.position.y] for person in people]
        ).reshape(-1, 2),
        hand_up=np.array(["hand_raised" in words for words in said], dtype=bool),
        in_view=np.array(["in_view" in words for words in said], dtype=bool),
    )


def stamp_ns(header: Any) -> int:
    """The stamp of a std_msgs/Header, in nanoseconds."""
    return int(header.stamp.sec) * 1_000_000_000 + int(header.stamp.nanosec)


def _camera_image(message: Any, picture: Picture) -> CameraImage:
    return CameraImage(
        stamp_ns(message.header), message.header.frame_id, picture.bgr, picture.remark
    )


def _check_beams(scan: Scan, angle_max_rad: float) -> None:
    """Check that angles and ranges fit together; drivers differ by one beam."""
    came = len(scan.ranges_m)
    if not came:
        return
    said = (angle_max_rad - scan.angle_min_rad) / scan.angle_increment_rad + 1.0
    if not abs(said - came) <= max(2.0, 0.02 * came):
        raise ShapeError(
            f"A scan says {said:.1f} beams from {scan.angle_min_rad:.3f} to {angle_max_rad:.3f} "
            f"rad and brings {came}; its angles and ranges must agree."
        )


_IMAGES: dict[str, Callable[[Any, int], Event]] = {
    types.IMAGE: image_from_message,
    types.COMPRESSED_IMAGE: image_from_compressed,
}
_DEPTHS = dict.fromkeys((types.IMAGE, types.COMPRESSED_IMAGE), depth_from_message)
_SINGLE: dict[str, Callable[[Any], Event]] = {
    types.LASER_SCAN: scan_from_message,
    types.CAMERA_INFO: camera_from_message,
    types.OCCUPANCY_GRID: map_from_message,
    types.DETECTIONS: truth_from_message,
}

#: Type names that `decode` understands.
DECODABLE = frozenset(_SINGLE) | frozenset(_IMAGES) | {types.TF_MESSAGE, types.TF_MESSAGE_ROS1}
