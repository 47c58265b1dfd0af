import numpy as np
import pytest

from tracker import Config
from tracker.containers import Hands
from tracker.evaluation.detection.episode import FRAMES_TO_FIND, score_caller, score_idlers
from tracker.evaluation.detection.scenes import HAND_UP_S, Conditions, caller_scene, idlers_scene
from tracker.simulation.motion import people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.rendering.camera_view import raised_hand_pixels
from tracker.simulation.stream import map_from_camera

CONFIG = Config()
CONDITIONS = Conditions(3.0, "normal", "sharp", "tan", "short", "right", "alone")


class Scripted:
    """Reports one hand in the images from `first` to `last`, counted from each reset."""

    work = None

    def __init__(self, landmarks_px, first, last=10_000):
        self.landmarks_px, self.first, self.last = landmarks_px, first, last

    def find(self, image, hints=None):
        self.image += 1
        if not self.first <= self.image - 1 < self.last:
            return Hands.none()
        one = np.ones(1)
        return Hands(self.landmarks_px[None], one, one, one.astype(bool), one)

    def reset(self):
        self.image = 0

    def configure(self, config):
        pass


@pytest.fixture(scope="module")
def scene():
    return caller_scene(
        CONDITIONS, (FRAMES_TO_FIND + 1) / CONFIG.processing_rate, 10.0, np.random.default_rng(1)
    )


@pytest.fixture(scope="module")
def hand_px(scene):
    view = Viewpoint.of(scene.camera, map_from_camera(scene, HAND_UP_S))
    return raised_hand_pixels(scene, view, people_at(scene, HAND_UP_S), 0)


UP = round(HAND_UP_S * CONFIG.processing_rate)


@pytest.mark.parametrize(
    ("first", "frames"), [(UP, 2), (UP + 5, 7), (UP + 28, 30), (UP + 29, None), (UP - 1, 1)]
)
def test_frames_count_from_the_hand_being_up_to_the_raised_track(scene, hand_px, first, frames):
    score = score_caller(scene, Scripted(hand_px, first), CONFIG, np.random.default_rng(2))
    assert score.frames == frames
    assert score.false_raises == 0
    assert score.hand_px == pytest.approx(np.linalg.norm(hand_px[12] - hand_px[0]))


def test_the_landmark_error_is_in_hand_lengths(scene, hand_px):
    length_px = np.linalg.norm(hand_px[12] - hand_px[0])
    off = Scripted(np.add(hand_px, (0.0, 0.1 * length_px)), UP)
    score = score_caller(scene, off, CONFIG, np.random.default_rng(2))
    assert score.landmark_error == pytest.approx(0.1)


def test_a_hand_elsewhere_is_false_and_finds_nobody(scene, hand_px):
    elsewhere = hand_px - (np.sign(hand_px[0, 0] - 320.0) * 200.0, 0.0)
    score = score_caller(scene, Scripted(elsewhere, UP), CONFIG, np.random.default_rng(2))
    assert (score.frames, score.false_raises) == (None, 1)
    assert np.isnan(score.landmark_error)


def test_a_track_raised_before_the_arm_moves_is_false(scene, hand_px):
    score = score_caller(scene, Scripted(hand_px, 0, 5), CONFIG, np.random.default_rng(2))
    assert (score.frames, score.false_raises) == (None, 1)


def test_who_is_taken_for_a_caller_is_named_by_bearing(hand_px):
    scene = idlers_scene(0, 2.0, (2.0, 3.0), 10.0, np.random.default_rng(3))
    person = scene.people[2]
    column = 320.0 - 460.0 * person.path[0].y_m / person.path[0].x_m
    hand = hand_px - hand_px[0] + (column, 200.0)
    for last, raises in ((10_000, 1), (1, 0)):
        found = score_idlers(scene, Scripted(hand, 0, last), CONFIG, np.random.default_rng(4))
        assert len(found) == raises
    (false,) = score_idlers(scene, Scripted(hand, 0), CONFIG, np.random.default_rng(4))
    assert false.what == person.activities[0].what
    assert false.at_s == pytest.approx(0.1)  # the second detection
    assert false.distance_m == person.path[0].x_m


@pytest.mark.model
def test_the_real_models_find_a_drawn_hand_at_one_meter(model_store):
    from tracker.perception import HandFinder

    near = Conditions(1.0, "normal", "sharp", "tan", "short", "right", "alone")
    scene = caller_scene(near, 3.1, 10.0, np.random.default_rng(6))
    score = score_caller(scene, HandFinder(CONFIG, model_store), CONFIG, np.random.default_rng(7))
    assert score.frames is not None
    assert score.landmark_error < 0.06  # of the hand; drawn hands measure 0.016 to 0.035
    assert score.false_raises == 0


@pytest.mark.parametrize(("beside_m", "found"), [(0.0, True), (0.15, True), (-0.5, False)])
def test_a_track_on_the_bodys_bearing_is_the_callers(scene, hand_px, beside_m, found):
    camera, place = scene.camera, scene.people[0].path[0]
    hand_side = np.sign(hand_px[0, 0] - camera.cx + camera.fx * place.y_m / place.x_m)
    body_px = camera.cx - camera.fx * place.y_m / place.x_m
    # The thumb points at a body .3 m beside the hand.
    column = body_px + hand_side * camera.fx * (0.3 + beside_m) / place.x_m
    moved = hand_px + np.array([column - hand_px[0, 0], 0.0])
    score = score_caller(scene, Scripted(moved, UP), CONFIG, np.random.default_rng(2))
    assert (score.frames is not None) is found
