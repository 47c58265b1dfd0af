"""Where do sightings come from? A recording, or a simulated room with wrong mounts and stamps."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.evaluation.recordings.recorded_frames import recorded_frames
from tracker.evaluation.trials.scan_trial import play_scene, visit_of
from tracker.evaluation.trials.scenario import ScanScenario
from tracker.evaluation.trials.trial_seed import trial_rng
from tracker.evaluation.tuning.sightings import Sightings, sightings_of
from tracker.evaluation.tuning.stamp_offset import Headings, headings_of
from tracker.geometry import RigidTransform
from tracker.locating import shown_ns
from tracker.perception.detector import HandDetector
from tracker.pipeline import Pipeline
from tracker.ranging.rays import body_pose
from tracker.recording import Topics
from tracker.simulation.random_rooms.restaurant import draw_restaurant
from tracker.simulation.scene import Camera, DrivePoint, Robot
from tracker.simulation.stream import map_from_camera, map_from_laser

#: People who stand and keep calling, for a robot that turns.
STANDING = ScanScenario(
    title="Three people stand about and call every few seconds.",
    duration_s=60.0,
    people=(3, 3),
    sitting_share=0.0,
    pause_s=1e5,
    hand_up_s=(4.0, 8.0),
    hand_down_s=(1.0, 3.0),
)
_SWAY_S = 1.6
#: People who walk about and keep calling: what one would ask volunteers for.
CALLERS = ScanScenario(
    title="Three people walk about and call every few seconds.",
    rate_hz=5.0,
    people=(3, 3),
    sitting_share=0.0,
    pause_s=4.0,
    hand_up_s=(4.0, 8.0),
    hand_down_s=(1.0, 3.0),
)


@dataclass(frozen=True, slots=True, eq=False)
class Mounted:
    """Sightings, and how the camera is believed to be mounted.

    Attributes:
        sightings: Hands and bodies.
        laser_from_camera: The camera with body axes in the laser's frame, as transforms tell.
        camera: Intrinsics.
        hand_headings: Who called, as the camera saw it.
        body_headings: The same people, as the laser saw them.
    """

    sightings: Sightings
    laser_from_camera: RigidTransform
    camera: CameraModel
    hand_headings: Headings
    body_headings: Headings


def recorded_sightings(
    source: str | Path,
    config: Config | None = None,
    *,
    topics: Topics | None = None,
    detector: HandDetector | None = None,
) -> Mounted:
    """Run a recording through the pipeline and keep who raised a hand and who stood nearby.

    Args:
        source: Whatever `replay` reads.
        config: Every parameter.
        topics: Where in the recording the data are.
        detector: Finds hands; by default what `config.detector` names.

    Raises:
        RecordingError: The source cannot be opened, or holds no image that could be processed.
        ModelFileError: The hand models are not there.
    """
    pipeline = Pipeline(config, detector)
    config = pipeline.config
    frame, axes = config.camera_frame, config.camera_axes
    parts, headings, mounting = [], [], RigidTransform()
    for result in recorded_frames(source, pipeline, topics=topics):
        if result.sensor_pose is None or result.scan is None:
            continue  # nobody knows where the camera was
        stamp_ns = shown_ns(result.stamp_ns, config.camera_stamp_offset_s)
        looked_up = pipeline.transforms.lookup(config.fixed_frame, frame, stamp_ns)
        pose = body_pose(looked_up, frame, axes)
        parts.append(sightings_of(result, pipeline.camera, pose, config))
        headings.append(headings_of(result, pipeline.camera, pose, config))
        looked_up = pipeline.transforms.lookup(result.scan.frame_id, frame, stamp_ns)
        mounting = body_pose(looked_up, frame, axes)
    return _mounted(parts, headings, mounting, pipeline.camera)


def simulated_sightings(
    true_camera: Camera,
    believed_camera: Camera,
    seed: int = 1,
    scenario: ScanScenario = CALLERS,
    config: Config | None = None,
    *,
    late_s: tuple[float, float] = (0.0, 0.0),
    turns: bool = False,
) -> Mounted:
    """The same of a room drawn at random.

    Args:
        true_camera: As it is mounted.
        believed_camera: As the transforms tell.
        seed: Of the room, the people and all noise.
        scenario: What people do.
        config: Every parameter.
        late_s: How late the stamps of camera and laser are.
        turns: The robot turns to and fro on its place, by up to 1 rad/s.
    """
    config, rng = config or Config(), trial_rng(seed, 0)
    scene = draw_restaurant(rng, visit_of(scenario, scenario.people[1]))
    if turns:
        scene = scene.model_copy(update={"robot": _turning(scenario.duration_s)})
    true = scene.model_copy(update={"camera": true_camera})
    believed = scene.model_copy(update={"camera": believed_camera})
    model = CameraModel(
        true_camera.fx,
        true_camera.fy,
        true_camera.cx,
        true_camera.cy,
        width=true_camera.width,
        height=true_camera.height,
    )
    parts, headings = [], []
    for _, result in play_scene(scenario, true, config, rng, believed, late_s=late_s):
        at_s = (result.stamp_ns - scene.start_s * 1_000_000_000) / 1e9
        pose = map_from_camera(believed, at_s - config.camera_stamp_offset_s)
        parts.append(sightings_of(result, model, pose, config))
        headings.append(headings_of(result, model, pose, config))
    mounting = map_from_laser(scene, 0.0).inverse() @ map_from_camera(believed, 0.0)
    return _mounted(parts, headings, mounting, model)


def _turning(duration_s: float) -> Robot:
    """To and fro by 60 degrees in 1.6 s each."""
    path = [
        DrivePoint(at_s=number * _SWAY_S, yaw_deg=30.0 * (-1.0) ** number)
        for number in range(int(duration_s / _SWAY_S) + 2)
    ]
    return Robot(path=tuple(path))


def _mounted(
    parts: list[Sightings],
    headings: list[tuple[Headings, Headings]],
    mounting: RigidTransform,
    camera: CameraModel,
) -> Mounted:
    hands, bodies = zip(*headings, strict=True) if headings else ((), ())
    return Mounted(
        Sightings.concatenate(*parts),
        mounting,
        camera,
        Headings.concatenate(hands),
        Headings.concatenate(bodies),
    )
