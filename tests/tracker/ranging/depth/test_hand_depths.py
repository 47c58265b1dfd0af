from dataclasses import replace

import numpy as np
import pytest

from tracker import Config, Hands
from tracker.camera import CameraModel
from tracker.geometry import RigidTransform
from tracker.ranging import hand_rays
from tracker.ranging.depth import depth_points, hand_depths

CAMERA = CameraModel(460.0, 460.0, 320.0, 240.0, width=640, height=480)
CONFIG = Config()


def caller(x, y, *, owned=True):
    """The raised hand of somebody at (x, y), beside the head, for a camera 1.2 m high."""

    def pixel(left, height):
        return np.array([320.0 - 460.0 * left / x, 240.0 - 460.0 * (height - 1.2) / x])

    landmarks = np.tile(pixel(y + 0.3, 1.45), (1, 21, 1))
    landmarks[0, 9], landmarks[0, 12] = pixel(y + 0.3, 1.545), pixel(y + 0.3, 1.63)
    torso = pixel(y, 1.15)[None] if owned else None
    one = np.ones(1)
    return Hands(landmarks, one, one, one.astype(bool), one, torso)


def body(x, y):
    """Trunk and raised arm, flat."""
    return (x, y, 0.2, 0.0, 1.65), (x, y + 0.3, 0.06, 1.1, 1.65)


def ranged(hands, image, place, camera=CAMERA, color=None, config=CONFIG):
    color = place if color is None else color
    points = depth_points(image, camera, place)
    rays = hand_rays(hands, CAMERA, color, config)
    return hand_depths(hands, rays, points, CAMERA, color, config)


@pytest.mark.parametrize("owned", [True, False], ids=["by the torso", "by the arm"])
@pytest.mark.parametrize("range_m", [1.0, 2.5, 5.0])
def test_the_body_counts_and_not_the_wall_behind_it(room, standing, range_m, owned):
    found = ranged(caller(range_m, 0.1, owned=owned), room(*body(range_m, 0.1)), standing)
    assert found.range_m[0] == pytest.approx(range_m, abs=0.15)


def test_who_walks_past_in_front_of_the_body_is_not_its_owner(room, standing):
    image = room(*body(4.0, 0.1), (1.8, 0.05, 0.2, 0.0, 1.25))
    found = ranged(caller(4.0, 0.1), image, standing)
    assert not found.is_known[0] or found.range_m[0] == pytest.approx(4.0, abs=0.2)


def test_holes_leave_the_range_unknown(room, standing):
    image = room(*body(2.0, 0.1), noise=lambda depth: np.where(depth < 5.0, np.nan, depth))
    found = ranged(caller(2.0, 0.1), image, standing)
    assert not found.is_known[0] or found.range_m[0] > 5.0
    empty = room(noise=lambda depth: depth * np.nan)
    assert not ranged(caller(2.0, 0.1), empty, standing).is_known[0]


def test_noise_grows_with_the_square_of_the_range(room, standing):
    config = Config(depth_std_m=0.1)
    near, far = (
        ranged(caller(x, 0.1), room(*body(x, 0.1)), standing, config=config).std_m[0]
        for x in (1.5, 3.0)
    )
    assert far / near == pytest.approx(4.0, rel=0.2)


def test_a_depth_camera_beside_the_color_camera_tells_the_same(room, standing):
    own = CameraModel(400.0, 400.0, 424.0, 240.0, width=848, height=480)
    beside = RigidTransform((0.0, 0.1, 1.2))
    image = room(*body(2.5, 0.1), camera=own, left_m=0.1)
    found = ranged(caller(2.5, 0.1), image, beside, camera=own, color=standing)
    same = ranged(caller(2.5, 0.1), room(*body(2.5, 0.1)), standing)
    assert found.range_m[0] == pytest.approx(same.range_m[0], abs=0.02)


def test_no_hand_asks_nothing(room, standing):
    assert len(ranged(Hands.none(), room(), standing).range_m) == 0


def test_a_torso_at_another_range_than_the_hand_is_somebody_else_s(room, standing):
    passer = (1.8, 0.0, 0.35, 0.0, 1.28)
    hidden = ranged(caller(4.0, 0.1), room(*body(4.0, 0.1), passer), standing)
    seen = ranged(caller(4.0, 0.1), room(*body(4.0, 0.1)), standing)
    assert (hidden.is_strange[0], seen.is_strange[0]) == (True, False)
    assert hidden.range_m[0] == pytest.approx(4.0, abs=0.25)
    assert hidden.std_m[0] > seen.std_m[0]


def test_without_a_torso_the_body_stands_on_the_thumb_s_side_of_the_hand(room, standing):
    hands = caller(2.5, 0.1, owned=False)
    landmarks = hands.landmarks_px.copy()
    landmarks[0, 4, 0] += 460.0 * 0.1 / 2.5  # to the picture's right
    hands = replace(hands, landmarks_px=landmarks)
    found = ranged(hands, room(*body(2.5, 0.1)), standing)
    assert found.xy_m[0] == pytest.approx([2.5, 0.1], abs=0.12)
