"""A body to stand in for anybody: shoulders 40 px wide around (200, 100), arms hanging."""

import numpy as np
import pytest

from tracker.containers import Hands
from tracker.perception.bodies.bodies import Bodies, Joint

STANDING = {
    "nose": (200, 60), "left_eye": (205, 55), "right_eye": (195, 55),
    "left_ear": (210, 58), "right_ear": (190, 58),
    "left_shoulder": (220, 100), "right_shoulder": (180, 100),
    "left_elbow": (225, 130), "right_elbow": (175, 130),
    "left_wrist": (226, 158), "right_wrist": (174, 158),
    "left_hip": (212, 156), "right_hip": (188, 156),
    "left_knee": (212, 205), "right_knee": (188, 205),
    "left_ankle": (212, 250), "right_ankle": (188, 250),
}  # fmt: skip


@pytest.fixture
def body():
    """Makes a batch of one; joints by name take other places, None hides them."""

    def make(*, age_s=0.0, score=1.0, shift_px=(0, 0), **joints):
        places = {**STANDING, **joints}
        points = np.array([places[joint.name.lower()] or (0, 0) for joint in Joint], float)
        visibility = np.array([float(places[joint.name.lower()] is not None) for joint in Joint])
        return Bodies(
            points[None] + shift_px, visibility[None], np.array([score]), np.array([age_s])
        )

    return make


@pytest.fixture
def upright_hand():
    """Makes a batch of one raised hand, its palm `palm_px` long, at a wrist."""

    def make(wrist_px, palm_px=10.0, *, raised=True):
        landmarks = np.zeros((1, 21, 2)) + np.array(wrist_px, float)
        landmarks[0, 9:13, 1] -= palm_px * np.array([1.0, 1.4, 1.7, 1.9])
        one = np.ones(1)
        return Hands(landmarks, one, one, np.array([raised]), np.array([1.9]))

    return make
