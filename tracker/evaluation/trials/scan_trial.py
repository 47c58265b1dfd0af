"""One trial of everything behind the hand models: ray-cast scans, ranging, tracking."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from tracker.camera import CameraModel
from tracker.config import Config
from tracker.containers import CameraImage, FrameResult, Hands, Truth
from tracker.evaluation.metrics.scores import TrialScores
from tracker.evaluation.trials.scenario import ScanScenario
from tracker.evaluation.trials.trial_seed import trial_rng
from tracker.pipeline import Pipeline
from tracker.simulation.bistro import draw_bistro
from tracker.simulation.camera_view import hands_in_view
from tracker.simulation.floor_map import floor_map
from tracker.simulation.lidar import ScanSimulator
from tracker.simulation.motion import people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.restaurant import draw_restaurant
from tracker.simulation.scene import Scene
from tracker.simulation.shown_hands import show_hands
from tracker.simulation.stream import map_from_camera, map_from_laser
from tracker.tracking.trace import Watch
from tracker.transforms import StampedTransform


def scan_trial(scenario: ScanScenario, config: Config, seed: int, trial: int) -> dict[str, float]:
    """Run one trial through a pipeline of its own.

    Args:
        scenario: People and sensors.
        config: The pipeline's parameters.
        seed: Of the study.
        trial: From 0.

    Returns:
        The figures of `metrics.scores.score_trial`.
    """
    scores = TrialScores(config)
    for truth, result in play_scan_trial(scenario, config, seed, trial):
        scores.add(truth, result.tracks)
    return scores.row()


def play_scan_trial(
    scenario: ScanScenario, config: Config, seed: int, trial: int, watch: Watch | None = None
) -> Iterator[tuple[Truth, FrameResult]]:
    """What is true and what the pipeline makes of it, frame by frame.

    Args:
        scenario: People and sensors.
        config: The pipeline's parameters.
        seed: Of the study.
        trial: From 0.
        watch: Passed on to the tracker.
    """
    rng = trial_rng(seed, trial)
    low, high = scenario.people
    draw_room = draw_bistro if scenario.furniture == "bistro" else draw_restaurant
    scene = draw_room(
        rng,
        people=int(rng.integers(low, high + 1)),
        duration_s=scenario.duration_s,
        rate_hz=scenario.rate_hz,
        sitting_share=scenario.sitting_share,
        pause_s=scenario.pause_s,
        hand_up_s=scenario.hand_up_s,
        hand_down_s=scenario.hand_down_s,
    )
    yield from play_scene(scenario, scene, config, rng, watch=watch)


def play_scene(
    scenario: ScanScenario,
    scene: Scene,
    config: Config,
    rng: np.random.Generator,
    believed: Scene | None = None,
    watch: Watch | None = None,
) -> Iterator[tuple[Truth, FrameResult]]:
    """Play a scene of one's own, whose robot stands still.

    Args:
        scenario: Its rate, duration, and the noise of hands.
        scene: What happens.
        config: The pipeline's parameters.
        rng: All randomness.
        believed: Whose mountings of camera and laser the transforms tell; the scene's own where
            None.
        watch: Passed on to the tracker.

    Yields:
        What is true and what the pipeline makes of it, frame by frame.
    """
    believed = scene if believed is None else believed
    camera = scene.camera
    view = Viewpoint.of(camera, map_from_camera(scene, 0.0))
    detector = _ShownHands(scenario, scene, view, rng)
    pipeline = Pipeline(config, detector, watch=watch)
    pipeline.set_camera(CameraModel(camera.fx, camera.fy, camera.cx, camera.cy))
    start_ns = scene.start_s * 1_000_000_000
    for frame, pose in [
        (camera.frame, map_from_camera(believed, 0.0)),
        (scene.laser.frame, map_from_laser(believed, 0.0)),
    ]:
        pipeline.add_transform(
            StampedTransform(start_ns, config.fixed_frame, frame, pose, is_static=True)
        )
    if scenario.map_known:
        pipeline.set_map(floor_map(scene))
    scanner = ScanSimulator(scene, rng)
    nothing = np.zeros((camera.height, camera.width, 3), np.uint8)
    for number in range(round(scenario.duration_s * scenario.rate_hz)):
        time_s = number / scenario.rate_hz
        stamp_ns = start_ns + round(time_s * 1e9)
        people = people_at(scene, time_s)
        in_view = hands_in_view(scene, view, people)
        detector.people, detector.in_view = people, in_view
        pipeline.add_scan(scanner.scan(stamp_ns, map_from_laser(scene, time_s), people))
        result = pipeline.process(CameraImage(stamp_ns, camera.frame, nothing))
        yield Truth(stamp_ns, people.id, people.xy_m, people.hand_up, in_view), result


class _ShownHands:
    """Stands in for the hand models: it is told who is there, and looks at no picture."""

    def __init__(
        self, scenario: ScanScenario, scene: Scene, view: Viewpoint, rng: np.random.Generator
    ) -> None:
        self._scenario, self._scene, self._view, self._rng = scenario, scene, view, rng
        self.people = people_at(scene, 0.0)
        self.in_view = hands_in_view(scene, view, self.people)

    def find(self, image: CameraImage) -> Hands:
        return show_hands(
            self._scene,
            self._view,
            self.people,
            self.in_view,
            self._rng,
            detection_probability=self._scenario.detection_probability,
            clutter_per_frame=self._scenario.clutter_per_frame,
            landmark_std_px=self._scenario.landmark_std_px,
        )

    def reset(self) -> None:
        """It remembers nothing."""

    def configure(self, config: Config) -> None:
        """It has no parameters."""
