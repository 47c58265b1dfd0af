import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage, Hands
from tracker.perception.arm_watch import LOOK_PERIOD, WATCH_S, ArmWatch, hands_of_arms
from tracker.perception.bodies import Bodies
from tracker.perception.strips import upright_strips

SIZE = (640, 480)
STRIPS = upright_strips(*SIZE)
UP = {"right_elbow": (150, 105), "right_wrist": (148, 70)}
PERIOD_NS = 100_000_000


def picture(number, *spots_px, frame_id="camera"):
    """An image with bright spots where hands may have come to."""
    bgr = np.full((SIZE[1], SIZE[0], 3), 60, np.uint8)
    for x, y in spots_px:
        bgr[y - 15 : y + 15, x - 15 : x + 15] = 220
    return CameraImage(number * PERIOD_NS, frame_id, bgr)


class Looks:
    """Notes the windows looked at, and sees the same people in each."""

    def __init__(self, people):
        self.people = people
        self.windows = []

    def __call__(self, bgr, window):
        self.windows.append(window)
        return self.people


@pytest.fixture
def looks():
    return Looks(Bodies.none())


def test_a_still_picture_is_not_looked_at(looks):
    watch = ArmWatch(looks)
    assert not any(len(watch.find(picture(number))) for number in range(20))
    assert not watch.looks_next
    assert looks.windows == []


def test_the_strip_in_which_something_moved_is_looked_at_in_the_next_image(looks, body):
    looks.people = body(**UP)
    watch = ArmWatch(looks)
    assert len(watch.find(picture(0))) == 0
    assert len(watch.find(picture(1, (520, 100)))) == 0
    assert watch.looks_next
    assert len(watch.find(picture(2, (520, 100)))) == 1
    assert looks.windows == [STRIPS[-1]]


def test_looks_keep_their_distance_and_end_after_the_movement(looks):
    watch = ArmWatch(looks)
    looked = []
    for number in range(60):
        watch.find(picture(number, *[(520, 100)] * (number >= 5)))
        looked += [number] * (len(looks.windows) - len(looked))
    assert looked[0] == 6
    assert set(np.diff(looked)) == {LOOK_PERIOD}
    assert (looked[-1] - 6) * PERIOD_NS <= WATCH_S * 1e9


def test_strips_take_turns(looks):
    watch = ArmWatch(looks)
    watch.find(picture(0))
    for number in range(1, 3 + 2 * LOOK_PERIOD):
        watch.find(picture(number, (80, 100), (560, 100)))
    assert sorted(looks.windows[:2]) == [STRIPS[0], STRIPS[-1]]
    assert looks.windows[2] == looks.windows[0]


def test_a_look_waits_while_other_models_are_at_work(looks):
    watch = ArmWatch(looks)
    watch.find(picture(0))
    watch.find(picture(1, (520, 100)))
    watch.find(picture(2, (520, 100)), rests=True)
    assert looks.windows == []
    watch.find(picture(3, (520, 100)))
    assert len(looks.windows) == 1


def test_another_camera_starts_anew(looks):
    watch = ArmWatch(looks)
    watch.find(picture(0))
    watch.find(picture(1, (520, 100)))
    watch.find(picture(2, (520, 100), frame_id="other"))
    assert looks.windows == []
    assert not watch.looks_next


def test_an_arm_that_is_up_tells_where_its_hand_is(body):
    (landmarks,) = hands_of_arms(Hands.none(), body(**UP), SIZE, Config())
    np.testing.assert_allclose(landmarks[0], (148, 70))
    middle_tip = landmarks[12] - landmarks[0]
    forearm = np.subtract(UP["right_wrist"], UP["right_elbow"])
    assert np.linalg.norm(middle_tip) == pytest.approx(20.8)  # of shoulders of 40
    assert np.cross(np.append(middle_tip, 0), np.append(forearm, 0))[2] == pytest.approx(0.0)


def test_an_arm_whose_hand_was_found_tells_nothing_new(body, upright_hand):
    assert len(hands_of_arms(upright_hand((148, 72)), body(**UP), SIZE, Config())) == 0


@pytest.mark.parametrize(
    "joints",
    [
        {},  # both hang
        {"right_elbow": (165, 120), "right_wrist": (183, 78)},  # phones
        {"right_elbow": (150, 130), "right_wrist": (160, 115)},  # talks
        {"right_elbow": (150, 105), "right_wrist": None},
    ],
)
def test_arms_that_poses_would_refuse_tell_of_no_hand(body, joints):
    assert len(hands_of_arms(Hands.none(), body(**joints), SIZE, Config())) == 0


def test_nobody_has_no_hand():
    assert hands_of_arms(Hands.none(), Bodies.none(), SIZE, Config()).shape == (0, 21, 2)
