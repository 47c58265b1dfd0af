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
from tracker.perception.detector import NO_HINTS, Hints
from tracker.pipeline import Pipeline
from tracker.simulation.floor_map import floor_map
from tracker.simulation.lidar import ScanSimulator
from tracker.simulation.motion import people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.random_rooms.bistro import draw_bistro
from tracker.simulation.random_rooms.guests import Visit
from tracker.simulation.random_rooms.restaurant import draw_restaurant
from tracker.simulation.rendering.camera_view import hands_in_view
from tracker.simulation.scene import Scene
from tracker.simulation.shown_hands import show_hands
from tracker.simulation.stream import map_from_camera, map_from_laser
from tracker.tracking.trace import Watch
from tracker.transforms import StampedTransform

#: As a robot tells its odometry; it is told so far ahead.
_TRANSFORM_S, _AHEAD_S = 0.02, 0.3


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
    visit = visit_of(scenario, int(rng.integers(low, high + 1)))
    yield from play_scene(scenario, draw_room(rng, visit), config, rng, watch=watch)


def visit_of(scenario: ScanScenario, people: int) -> Visit:
    """So many people, who do what the scenario says."""
    return Visit(
        people=people,
        duration_s=scenario.duration_s,
        rate_hz=scenario.rate_hz,
        sitting_share=scenario.sitting_share,
        pause_s=scenario.pause_s,
        hand_up_s=scenario.hand_up_s,
        hand_down_s=scenario.hand_down_s,
    )


def play_scene(
    scenario: ScanScenario,
    scene: Scene,
    config: Config,
    rng: np.random.Generator,
    believed: Scene | None = None,
    watch: Watch | None = None,
    late_s: tuple[float, float] = (0.0, 0.0),
) -> Iterator[tuple[Truth, FrameResult]]:
    """Play a scene of one's own.

    Args:
        scenario: Its rate, duration, and the noise of hands.
        scene: What happens.
        config: The pipeline's parameters.
        rng: All randomness.
        believed: Whose mountings of camera and laser the transforms tell; the scene's own where
            None.
        watch: Passed on to the tracker.
        late_s: How late the stamps of camera and laser are: they show what was before.

    Yields:
        What is true and what the pipeline makes of it, frame by frame.
    """
    believed = scene if believed is None else believed
    camera = scene.camera
    detector = _ShownHands(scenario, scene, rng)
    pipeline = Pipeline(config, detector, watch=watch)
    pipeline.set_camera(CameraModel(camera.fx, camera.fy, camera.cx, camera.cy))
    start_ns = scene.start_s * 1_000_000_000
    if scenario.map_known:
        pipeline.set_map(floor_map(scene))
    told_s = -_AHEAD_S
    scanner = ScanSimulator(scene, rng)
    nothing = np.zeros((camera.height, camera.width, 3), np.uint8)
    for number in range(round(scenario.duration_s * scenario.rate_hz)):
        time_s = number / scenario.rate_hz
        stamp_ns = start_ns + round(time_s * 1e9)
        shown_s, scanned_s = (max(time_s - each, 0.0) for each in late_s)
        detector.look(shown_s)
        for sample in _transforms(believed, told_s, time_s + _AHEAD_S, config.fixed_frame):
            pipeline.add_transform(sample)
        told_s = time_s + _AHEAD_S
        scan = scanner.scan(
            stamp_ns, map_from_laser(scene, scanned_s), people_at(scene, scanned_s)
        )
        pipeline.add_scan(scan)
        result = pipeline.process(CameraImage(stamp_ns, camera.frame, nothing))
        people = people_at(scene, time_s)
        in_view = detector.in_view
        yield Truth(stamp_ns, people.id, people.xy_m, people.hand_up, in_view), result


def _transforms(
    scene: Scene, from_s: float, until_s: float, fixed_frame: str
) -> Iterator[StampedTransform]:
    """Camera and laser in the fixed frame for a while; once for all where the robot stands."""
    moves = len(scene.robot.path) > 1
    if not moves and from_s >= 0.0:
        return
    for at_s in np.arange(from_s, until_s, _TRANSFORM_S) if moves else [0.0]:
        stamp_ns = scene.start_s * 1_000_000_000 + round(at_s * 1e9)
        for frame, pose in (
            (scene.camera.frame, map_from_camera(scene, at_s)),
            (scene.laser.frame, map_from_laser(scene, at_s)),
        ):
            yield StampedTransform(stamp_ns, fixed_frame, frame, pose, is_static=not moves)


class _ShownHands:
    """Replaces the hand models: it gets the truth, and looks at no picture."""

    work = None

    def __init__(self, scenario: ScanScenario, scene: Scene, rng: np.random.Generator) -> None:
        self._scenario, self._scene, self._rng = scenario, scene, rng
        self.look(0.0)

    def look(self, time_s: float) -> None:
        """What the next picture shows."""
        self.people = people_at(self._scene, time_s)
        self._view = Viewpoint.of(self._scene.camera, map_from_camera(self._scene, time_s))
        self.in_view = hands_in_view(self._scene, self._view, self.people)

    def find(self, image: CameraImage, hints: Hints = NO_HINTS) -> Hands:
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
