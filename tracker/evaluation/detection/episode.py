"""Was this raised hand found, how soon, and how exactly? Were others invented? For one scene.

The scene is rendered and goes through the whole pipeline without LiDAR, so that tracks have a
bearing and no range worth comparing: truth and tracks are compared by bearing, in the camera.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from tracker.config import Config
from tracker.containers import CameraImage, FloatArray, FrameResult
from tracker.evaluation.detection.scenes import HAND_UP_S
from tracker.perception import HandDetector
from tracker.pipeline import Pipeline
from tracker.simulation import Scene
from tracker.simulation.motion import People, people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.rendering.camera_view import CameraView, raised_hand_pixels
from tracker.simulation.scene import ARM_MOTION_S
from tracker.simulation.stream import map_from_camera

#: Images within which a hand must be found.
FRAMES_TO_FIND = 30

#: A track farther than this from the wrist's ray is not of this hand ...
_WRIST_OFF_M, _WRIST_OFF_RAD = 0.2, 0.03
#: ... unless it is within half the body's width of the body's: a track aims at the torso where the
#: pose is known.
_BODY_OFF_M = 0.2
_FINER = 1.5  # figures are painted this much finer than they are seen


@dataclass(frozen=True, slots=True)
class CallerScore:
    """What became of one raised hand.

    Attributes:
        hand_px: True length of the hand, from the wrist to the middle finger's tip.
        frames: Images from the hand being up until its track was raised, both included; None where
            that took more than `FRAMES_TO_FIND`.
        landmark_error: Mean distance of the landmarks from the drawn ones in hand lengths, median
            over the images; NaN where no hand was found.
        false_raises: Times that another track was raised, or this one before the arm moved.
    """

    hand_px: float
    frames: int | None
    landmark_error: float
    false_raises: int


def score_caller(
    scene: Scene, detector: HandDetector, config: Config, rng: np.random.Generator
) -> CallerScore:
    """Play a caller's scene until the hand is found, or for `FRAMES_TO_FIND` images.

    Args:
        scene: As from `caller_scene`.
        detector: Finds hands; it is reset first.
        config: The pipeline's parameters.
        rng: Pixel noise.
    """
    moment = people_at(scene, HAND_UP_S)
    view = _view(scene, HAND_UP_S)
    truth_px = raised_hand_pixels(scene, view, moment, 0)
    hand_px = float(np.linalg.norm(truth_px[12] - truth_px[0]))
    wrist_rad = -np.arctan2(truth_px[0, 0] - scene.camera.cx, scene.camera.fx)
    x_m, y_m = scene.people[0].path[0].x_m, scene.people[0].path[0].y_m
    body_rad = np.arctan2(y_m, x_m)
    near_rad, near_body_rad = _WRIST_OFF_M / x_m + _WRIST_OFF_RAD, _BODY_OFF_M / x_m
    errors: list[float] = []
    frames, false_raises, raised_before = 0, 0, set[int]()
    for time_s, people, result in _play(scene, detector, config, rng):
        bearings = _bearings(result)
        is_of_hand = np.abs(bearings - wrist_rad) <= near_rad
        is_of_hand |= np.abs(bearings - body_rad) <= near_body_rad
        is_early = time_s < HAND_UP_S - ARM_MOTION_S
        new = [row for row in _raised_rows(result) if result.tracks.id[row] not in raised_before]
        false_raises += sum(bool(is_early or not is_of_hand[row]) for row in new)
        raised_before = set(result.tracks.id[result.tracks.raised].tolist())
        if not people.hand_up[0]:
            continue
        frames += 1
        shown_px = raised_hand_pixels(scene, _view(scene, time_s), people, 0)  # a wave moves it
        errors += _landmark_errors(result, shown_px, hand_px)
        if np.any(result.tracks.raised & is_of_hand):
            return CallerScore(hand_px, frames, _median(errors), false_raises)
        if frames == FRAMES_TO_FIND:
            break
    return CallerScore(hand_px, None, _median(errors), false_raises)


@dataclass(frozen=True, slots=True)
class FalseRaise:
    """A track that was raised while nobody called.

    Attributes:
        at_s: When, in the scene.
        what: What the person nearest to its bearing was doing.
        distance_m: How far that person is.
    """

    at_s: float
    what: str
    distance_m: float


def score_idlers(
    scene: Scene, detector: HandDetector, config: Config, rng: np.random.Generator
) -> list[FalseRaise]:
    """Play a scene in which nobody calls.

    Args:
        scene: As from `idlers_scene`.
        detector: Finds hands; it is reset first.
        config: The pipeline's parameters.
        rng: Pixel noise.

    Returns:
        One item for each time that a track became raised.
    """
    found: list[FalseRaise] = []
    raised_before = set[int]()
    for time_s, people, result in _play(scene, detector, config, rng):
        away_rad = np.arctan2(people.xy_m[:, 1], people.xy_m[:, 0])
        bearings = _bearings(result)
        for row in _raised_rows(result):
            if result.tracks.id[row] not in raised_before:
                who = int(np.argmin(np.abs(away_rad - bearings[row])))
                person = scene.people[who]
                found.append(FalseRaise(time_s, person.activities[0].what, person.path[0].x_m))
        raised_before = set(result.tracks.id[result.tracks.raised].tolist())
    return found


def _play(
    scene: Scene, detector: HandDetector, config: Config, rng: np.random.Generator
) -> Iterator[tuple[float, People, FrameResult]]:
    """Every image's time, its truth, and what the pipeline made of it."""
    camera = scene.camera
    config = config.replace(
        camera_fx=camera.fx, camera_fy=camera.fy, camera_cx=camera.cx, camera_cy=camera.cy,
        camera_width=camera.width, camera_height=camera.height, bearing_convention="rep103",
    )  # fmt: skip
    detector.reset()
    pipeline = Pipeline(config, detector)
    nearest_m = min(person.path[0].x_m for person in scene.people)
    painter = CameraView(scene, rng, sharp_from_m=nearest_m / _FINER)
    for number in range(round(scene.duration_s * camera.rate_hz)):
        time_s = number / camera.rate_hz
        people = people_at(scene, time_s)
        picture = painter.render(_view(scene, time_s), people)
        stamp_ns = scene.start_s * 1_000_000_000 + round(time_s * 1e9)
        yield time_s, people, pipeline.process(CameraImage(stamp_ns, camera.frame, picture))


def _view(scene: Scene, time_s: float) -> Viewpoint:
    return Viewpoint.of(scene.camera, map_from_camera(scene, time_s))


def _raised_rows(result: FrameResult) -> list[int]:
    return [int(row) for row in np.flatnonzero(result.tracks.raised)]


def _bearings(result: FrameResult) -> FloatArray:
    mean = result.tracks.mean
    return np.arctan2(mean[:, 1], mean[:, 0])


def _landmark_errors(result: FrameResult, truth_px: FloatArray, hand_px: float) -> list[float]:
    """Of the hand nearest to the true one, if there is one within half its length."""
    hands = result.hands
    if len(hands) == 0:
        return []
    row = int(np.argmin(np.linalg.norm(hands.wrist_px - truth_px[0], axis=-1)))
    error = np.linalg.norm(hands.landmarks_px[row] - truth_px, axis=-1).mean() / hand_px
    return [float(error)] if error < 0.5 else []


def _median(values: list[float]) -> float:
    return float(np.median(values)) if values else float("nan")
