"""What would the robot have recorded? A scene as one time-ordered stream of sensor events."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from heapq import merge
from pathlib import Path

import numpy as np

from tracker.camera import CameraModel, DepthCamera
from tracker.containers import CameraImage, DepthImage, OccupancyGrid, Scan, Truth
from tracker.errors import SceneError
from tracker.geometry import RigidTransform, euler_to_quaternion
from tracker.messages import CameraInfo, Encodable, Event
from tracker.recording import RecordingWriter
from tracker.simulation.floor_map import floor_map
from tracker.simulation.lidar import ScanSimulator
from tracker.simulation.motion import people_at, planar_transform, robot_pose
from tracker.simulation.projection import Viewpoint
from tracker.simulation.rendering.camera_view import CameraView, hands_in_view
from tracker.simulation.rendering.depth_view import DepthView, depth_camera
from tracker.simulation.scene import Scene
from tracker.transforms import StampedTransform

TRANSFORM_RATE_HZ = 50.0

# From measuring to recording; guesses at an ordinary robot.
_IMAGE_DELAY_NS, _SCAN_DELAY_NS, _TRANSFORM_DELAY_NS = 20_000_000, 5_000_000, 2_000_000
_DEPTH_DELAY_NS = 18_000_000

DEPTH_FRAME = "camera_depth_optical_frame"

_BODY_FROM_OPTICAL = euler_to_quaternion(-np.pi / 2, 0.0, -np.pi / 2)


def simulate(scene: Scene, seed: int) -> Iterator[tuple[int, Event]]:
    """Play a scene as its sensors would report it.

    Frames: map -> odom (fixed) -> base_link (moving) -> camera_link and the laser's (fixed), and
    camera_link -> camera_optical_frame where the scene's camera speaks of that, and likewise for a
    depth camera that is not registered. The truth is given
    in the map at each image's stamp.

    Args:
        scene: What happens.
        seed: Of all noise; the same seed gives the same bytes.

    Yields:
        When it was recorded (log_ns) and the event, in that order; an event of the world's first
        instant comes first. A `CameraModel` comes with each image.

    Raises:
        SceneError: The seed is negative.
    """
    if seed < 0:
        raise SceneError(f"The seed is {seed}; expected a whole number, 0 or more.")
    camera_rng, scan_rng, depth_rng = (np.random.default_rng([seed, row]) for row in range(3))
    painter = CameraView(scene, camera_rng)
    start_ns = scene.start_s * 1_000_000_000
    at_once: list[Event] = [*_static_transforms(scene), floor_map(scene)]
    yield from merge(
        ((start_ns, event) for event in at_once),
        _moving_transforms(scene),
        _scans(scene, scan_rng),
        _images(scene, painter),
        _depths(scene, painter, depth_rng),
        key=lambda item: item[0],
    )


def write_simulation(
    scene: Scene,
    path: str | Path,
    seed: int,
    progress: Callable[[float], None] | None = None,
    *,
    jpeg_quality: int | None = None,
    overwrite: bool = False,
) -> None:
    """Write a scene as a recording.

    Topics: /image_raw, /camera_info, /scan, /map, /tf, /tf_static and /truth/people; /depth where
    the scene has a depth camera, and /depth_camera_info where that is not registered.

    Args:
        scene: What happens.
        path: Of the new recording.
        seed: Of all noise; the same seed gives the same bytes.
        progress: Told the share of the scene that is done, from 0 to 1, about once an image.
        jpeg_quality: From 1 to 100: images as JPEG on /image_raw/compressed, a twentieth the size;
            and depth images as PNG on /depth/compressedDepth.
        overwrite: Replace a recording that is there.

    Raises:
        SceneError: The seed is negative.
        RecordingError: The recording cannot be written.
    """
    camera = scene.camera
    with RecordingWriter(path, jpeg_quality=jpeg_quality, overwrite=overwrite) as writer:
        # One message with all of them, because players keep only the last one for latecomers.
        writer.write("/tf_static", scene.start_s * 1_000_000_000, _static_transforms(scene))
        for log_ns, event in simulate(scene, seed):
            item: Encodable
            if isinstance(event, StampedTransform) and event.is_static:
                continue
            if isinstance(event, CameraModel):
                stamp_ns = log_ns - _IMAGE_DELAY_NS
                item = CameraInfo(stamp_ns, camera.frame, camera.width, camera.height, event)
            elif isinstance(event, DepthCamera):
                own, stamp_ns = event.camera, log_ns - _DEPTH_DELAY_NS
                item = CameraInfo(stamp_ns, DEPTH_FRAME, own.width or 0, own.height or 0, own)
            else:
                item = event
            writer.write(topic_of(event), log_ns, item)
            if progress is not None and isinstance(event, CameraImage):
                progress(min((event.stamp_ns / 1e9 - scene.start_s) / scene.duration_s, 1.0))
    if progress is not None:
        progress(1.0)


def topic_of(event: Event) -> str:
    """The topic on which an event is recorded."""
    if isinstance(event, StampedTransform):
        return "/tf_static" if event.is_static else "/tf"
    topics: dict[type, str] = {
        CameraImage: "/image_raw",
        CameraModel: "/camera_info",
        Scan: "/scan",
        OccupancyGrid: "/map",
        DepthImage: "/depth",
        DepthCamera: "/depth_camera_info",
        Truth: "/truth/people",
    }
    return topics[type(event)]


def map_from_camera(scene: Scene, time_s: float) -> RigidTransform:
    """Pose of the camera's body frame (x forward) at a time."""
    return robot_pose(scene, time_s) @ _base_from_camera(scene)


def map_from_laser(scene: Scene, time_s: float) -> RigidTransform:
    """Pose of the scanner at a time."""
    return robot_pose(scene, time_s) @ _base_from_laser(scene)


def _images(scene: Scene, painter: CameraView) -> Iterator[tuple[int, Event]]:
    camera = scene.camera
    model = CameraModel(
        camera.fx, camera.fy, camera.cx, camera.cy, width=camera.width, height=camera.height
    )
    for stamp_ns, time_s in _ticks(scene, camera.rate_hz, scene.duration_s):
        people = people_at(scene, time_s)
        view = Viewpoint.of(camera, map_from_camera(scene, time_s))
        log_ns = stamp_ns + _IMAGE_DELAY_NS
        in_view = hands_in_view(scene, view, people)
        yield log_ns, model
        yield log_ns, CameraImage(stamp_ns, camera.frame, painter.render(view, people))
        yield log_ns, Truth(stamp_ns, people.id, people.xy_m, people.hand_up, in_view)


def _depths(
    scene: Scene, painter: CameraView, rng: np.random.Generator
) -> Iterator[tuple[int, Event]]:
    depth = scene.depth
    if depth is None:
        return
    view = DepthView(scene, painter, rng)
    own = depth_camera(scene, depth)
    frame = scene.camera.frame if depth.registered else DEPTH_FRAME
    for stamp_ns, time_s in _ticks(scene, depth.rate_hz, scene.duration_s):
        place = map_from_camera(scene, time_s)
        if not depth.registered:
            place = place @ RigidTransform((0.0, depth.y_m, 0.0))
            model = CameraModel(own.fx, own.fy, own.cx, own.cy, width=own.width, height=own.height)
            yield stamp_ns + _DEPTH_DELAY_NS, DepthCamera(model)
        pixels = view.render(Viewpoint.of(own, place), people_at(scene, time_s))
        yield stamp_ns + _DEPTH_DELAY_NS, DepthImage.of(stamp_ns, frame, pixels)


def _scans(scene: Scene, rng: np.random.Generator) -> Iterator[tuple[int, Event]]:
    scanner = ScanSimulator(scene, rng)
    for stamp_ns, time_s in _ticks(scene, scene.laser.rate_hz, scene.duration_s):
        pose = map_from_laser(scene, time_s)
        scan = scanner.scan(stamp_ns, pose, people_at(scene, time_s))
        yield stamp_ns + _SCAN_DELAY_NS, scan


def _moving_transforms(scene: Scene) -> Iterator[tuple[int, Event]]:
    odom_from_map = planar_transform(scene.map_from_odom).inverse()
    # One more than needed, so that the last image lies between two of them.
    until_s = scene.duration_s + 2.0 / TRANSFORM_RATE_HZ
    for stamp_ns, time_s in _ticks(scene, TRANSFORM_RATE_HZ, until_s):
        odom_from_base = odom_from_map @ robot_pose(scene, time_s)
        sample = StampedTransform(stamp_ns, "odom", "base_link", odom_from_base)
        yield stamp_ns + _TRANSFORM_DELAY_NS, sample


def _static_transforms(scene: Scene) -> list[StampedTransform]:
    start_ns = scene.start_s * 1_000_000_000
    links = [
        ("map", "odom", planar_transform(scene.map_from_odom)),
        ("base_link", "camera_link", _base_from_camera(scene)),
        ("base_link", scene.laser.frame, _base_from_laser(scene)),
    ]
    if scene.camera.frame != "camera_link":
        optical = RigidTransform(quaternion_xyzw=_BODY_FROM_OPTICAL)
        links.append(("camera_link", scene.camera.frame, optical))
    if scene.depth is not None and not scene.depth.registered:
        optical = RigidTransform((0.0, scene.depth.y_m, 0.0), _BODY_FROM_OPTICAL)
        links.append(("camera_link", DEPTH_FRAME, optical))
    return [StampedTransform(start_ns, *link, is_static=True) for link in links]


def _base_from_camera(scene: Scene) -> RigidTransform:
    camera = scene.camera
    yaw = float(np.radians(camera.yaw_deg))
    return RigidTransform.from_planar(camera.x_m, camera.y_m, yaw, camera.z_m)


def _base_from_laser(scene: Scene) -> RigidTransform:
    laser = scene.laser
    return RigidTransform.from_planar(
        laser.x_m, laser.y_m, float(np.radians(laser.yaw_deg)), laser.z_m
    )


def _ticks(scene: Scene, rate_hz: float, until_s: float) -> Iterator[tuple[int, float]]:
    """Stamps of a sensor, and the scene's time at them."""
    number = 0
    while (since_ns := round(number * 1e9 / rate_hz)) < until_s * 1e9:
        yield scene.start_s * 1_000_000_000 + since_ns, since_ns / 1e9
        number += 1
