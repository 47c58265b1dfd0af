"""Where do sightings come from? A recording, or a simulated room whose camera is mounted askew."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.evaluation.recordings.recorded_frames import recorded_frames
from tracker.evaluation.trials.scan_trial import play_scene
from tracker.evaluation.trials.scenario import ScanScenario
from tracker.evaluation.trials.trial_seed import trial_rng
from tracker.evaluation.tuning.sightings import Sightings, sightings_of
from tracker.geometry import RigidTransform
from tracker.perception.detector import HandDetector
from tracker.pipeline import Pipeline
from tracker.ranging.rays import body_pose
from tracker.recording import Topics
from tracker.simulation.restaurant import draw_restaurant
from tracker.simulation.scene import Camera
from tracker.simulation.stream import map_from_camera, map_from_laser

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
    """

    sightings: Sightings
    laser_from_camera: RigidTransform
    camera: CameraModel


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
    parts, mounting = [], RigidTransform()
    for result in recorded_frames(source, pipeline, topics=topics):
        if result.sensor_pose is None or result.scan is None:
            continue  # nobody knows where the camera was
        looked_up = pipeline.transforms.lookup(config.fixed_frame, frame, result.stamp_ns)
        pose = body_pose(looked_up, frame, axes)
        parts.append(sightings_of(result, pipeline.camera, pose, config))
        looked_up = pipeline.transforms.lookup(result.scan.frame_id, frame, result.stamp_ns)
        mounting = body_pose(looked_up, frame, axes)
    return Mounted(Sightings.concatenate(parts), mounting, pipeline.camera)


def simulated_sightings(
    true_camera: Camera,
    believed_camera: Camera,
    seed: int = 1,
    scenario: ScanScenario = CALLERS,
    config: Config | None = None,
) -> Mounted:
    """The same of a room drawn at random.

    Args:
        true_camera: As it is mounted.
        believed_camera: As the transforms tell.
        seed: Of the room, the people and all noise.
        scenario: What people do.
        config: Every parameter.
    """
    config, rng = config or Config(), trial_rng(seed, 0)
    scene = draw_restaurant(
        rng,
        people=scenario.people[1],
        duration_s=scenario.duration_s,
        rate_hz=scenario.rate_hz,
        sitting_share=scenario.sitting_share,
        pause_s=scenario.pause_s,
        hand_up_s=scenario.hand_up_s,
        hand_down_s=scenario.hand_down_s,
    )
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
    map_from_believed = map_from_camera(believed, 0.0)
    parts = [
        sightings_of(result, model, map_from_believed, config)
        for _, result in play_scene(scenario, true, config, rng, believed)
    ]
    laser_from_camera = map_from_laser(scene, 0.0).inverse() @ map_from_believed
    return Mounted(Sightings.concatenate(parts), laser_from_camera, model)
