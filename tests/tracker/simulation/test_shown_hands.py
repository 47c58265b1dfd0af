import numpy as np
import pytest

from tracker.geometry import RigidTransform
from tracker.simulation import scene_from_mapping
from tracker.simulation.motion import people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.rendering.camera_view import hands_in_view
from tracker.simulation.shown_hands import show_hands

UP = [{"from_s": 0.5, "until_s": 1.5}]


def shown(*people, time_s=1.0, probability=1.0, clutter=0.0, std_px=0.0):
    scene = scene_from_mapping({"duration_s": 2.0, "people": list(people)})
    view = Viewpoint.of(scene.camera, RigidTransform.from_planar(0.0, 0.0, 0.0, 1.2))
    at = people_at(scene, time_s)
    return show_hands(
        scene,
        view,
        at,
        hands_in_view(scene, view, at),
        np.random.default_rng(1),
        detection_probability=probability,
        clutter_per_frame=clutter,
        landmark_std_px=std_px,
    )


def guest(x_m, y_m, number=1, **changes):
    return {"id": number, "path": [{"x_m": x_m, "y_m": y_m}], "raises": UP, **changes}


def test_a_raised_hand_is_beside_its_owner_and_as_large_as_it_is_near():
    hands = shown(guest(3.0, 0.0))
    assert hands.raised.tolist() == [True]
    beside_m = (320.0 - hands.wrist_px[0, 0]) * 3.0 / 460.0
    assert 0.2 < abs(beside_m) < 0.5
    assert hands.length_px[0] == pytest.approx(460.0 * 0.18 / 3.0, rel=0.05)


def test_a_lowered_hand_and_one_out_of_the_picture_are_not_shown():
    assert len(shown(guest(3.0, 0.0), time_s=0.0)) == 0
    assert len(shown(guest(3.0, 3.0))) == 0


def test_a_hand_behind_somebody_tall_is_hidden_and_above_somebody_who_sits_is_not():
    behind = guest(5.0, 0.6)
    hand_column = shown(behind).wrist_px[0, 0]
    left_m = (320.0 - hand_column) / 460.0 * 2.5
    tall = {"id": 2, "path": [{"x_m": 2.5, "y_m": left_m}], "look": {"stature_m": 1.9}}
    assert len(shown(behind, tall)) == 0
    assert len(shown(behind, {**tall, "seat_m": 0.45, "look": {"stature_m": 1.6}})) == 1


def test_missed_and_false_hands_come_as_often_as_wanted():
    assert len(shown(guest(3.0, 0.0), probability=0.0)) == 0
    assert len(shown(clutter=20.0)) > 5
