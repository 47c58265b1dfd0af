from dataclasses import replace

import numpy as np
import pytest

from tracker import Config, Hands, Measurements, Tracks
from tracker.camera import CameraModel
from tracker.geometry import RigidTransform
from tracker.ranging import Background, Ownership, PersonClusters, hand_rays

CONFIG, CAMERA = Config(), CameraModel(460.0, 460.0, 320.0, 240.0)
PERIOD_NS = 100_000_000


def hand_at(x, y, noise_px=0.0):
    """One hand at a point of the camera's body frame, its thumb toward nobody."""
    landmarks = np.tile([320.0 - 460.0 * y / x, 240.0], (1, 21, 1))
    landmarks[0, 9, 1] -= 460.0 * 0.095 / x
    landmarks += noise_px
    one = np.ones(1)
    return Hands(landmarks, one, one, one.astype(bool), one)


def clusters_at(*points, furniture=0.0):
    count = len(points)
    return PersonClusters(
        np.array(points, float).reshape(-1, 2),
        np.full(count, 0.3),
        np.full(count, 2),
        np.zeros(count) + furniture,
    )


def known_at(*points, stamp_ns=0):
    count = len(points)
    one = np.ones(count)
    mean = np.zeros((count, 4))
    mean[:, :2] = points
    return Tracks(
        stamp_ns=stamp_ns,
        id=np.arange(1, count + 1),
        mean=mean,
        covariance=np.tile(0.01 * np.eye(4), (count, 1, 1)),
        existence=0.99 * one,
        confirmed=one.astype(bool),
        raised=one.astype(bool),
        raised_since_ns=np.zeros(count, dtype=np.int64),
        age_s=10.0 * one,
        unseen_s=0.0 * one,
        hand=np.full(count, -1),
    )


def judge(ownership, hands, people, tracked=None, number=0):
    rays = hand_rays(hands, CAMERA, RigidTransform(), CONFIG)
    stamp_ns = number * PERIOD_NS
    nobody = Tracks.none(stamp_ns)
    return ownership.judge(
        hands,
        rays,
        CAMERA,
        people,
        Background(),
        nobody if tracked is None else tracked,
        stamp_ns,
        CONFIG,
    )


def test_a_hidden_owner_keeps_the_hand_though_somebody_else_stands_in_front():
    hands, in_front = hand_at(5.0, 0.0), clusters_at((2.5, 0.0))
    tracked, ownership = known_at((2.5, 0.0), (5.0, 0.1)), Ownership()
    judge(ownership, hands, clusters_at((2.5, 0.0), (5.0, 0.1)), tracked=tracked)
    owners = judge(ownership, hands, in_front, tracked=tracked)
    assert (owners.cluster[0], owners.person[0]) == (-1, 1)


def test_a_hand_that_fits_nobody_is_somebody_s_who_is_not_seen():
    owners = judge(Ownership(), hand_at(5.0, 0.0), clusters_at((2.0, 0.3)))
    assert (owners.cluster[0], owners.person[0]) == (-1, -1)
    assert owners.range_m[0] == pytest.approx(5.0, abs=0.2)


def test_what_looks_like_furniture_owns_no_hand_that_a_person_may_own():
    people = clusters_at((2.0, 0.2), (2.0, -0.3), furniture=[4.0, 0.0])
    owners = judge(Ownership(), hand_at(2.0, 0.0), people)
    assert owners.cluster.tolist() == [1]


def test_many_images_tell_how_far_a_hand_is_better_than_one():
    rng, ownership = np.random.default_rng(1), Ownership()
    people, found, std_m = clusters_at((4.0, 0.3), (6.5, 0.3)), [], []
    for number in range(40):
        hands = hand_at(4.0, 0.0, rng.standard_normal((1, 21, 2)))
        owners = judge(ownership, hands, people, number=number)
        found.append(owners.range_m[0])
        std_m.append(owners.range_std_m[0])
    assert np.std(found[15:]) < 0.1
    assert std_m[-1] < std_m[0]


def test_a_hand_that_comes_back_after_long_is_another_one():
    ownership, nobody = Ownership(), clusters_at()
    for number in range(10):
        judge(ownership, hand_at(4.0, 0.0), nobody, number=number)
    one = judge(ownership, hand_at(4.0, 0.0), nobody, number=10).range_std_m[0]
    again = judge(ownership, hand_at(4.0, 0.0), nobody, number=40).range_std_m[0]
    assert again > one


def test_the_tracker_is_told_of_hidden_owners_alone():
    ownership = Ownership()
    hands, tracked = hand_at(5.0, 0.0), known_at((2.5, 0.0), (5.0, 0.1))
    judge(ownership, hands, clusters_at((2.5, 0.0), (5.0, 0.1)), tracked=tracked)
    judge(ownership, hands, clusters_at((2.5, 0.0)), tracked=tracked)
    measured = Measurements.polar([0.0, 0.3], [5.0, 2.0], 0.05, 0.5, hand=[0, -1])
    likeness = ownership.likeness(measured, 2)
    assert likeness[1, 0] > 0.0 > likeness[0, 0]
    assert likeness[:, 1].tolist() == [0.0, 0.0]


def test_who_was_only_guessed_from_a_hand_is_no_rival_to_whom_the_scan_shows():
    ownership = Ownership()
    hands, tracked = hand_at(4.0, 0.0), known_at((4.0, 0.0))
    owners = judge(ownership, hands, clusters_at((4.6, 0.1)), tracked=tracked)
    assert owners.cluster.tolist() == [0]


def test_a_guess_keeps_its_hand_while_no_scan_shows_anybody():
    ownership = Ownership()
    judge(ownership, hand_at(4.0, 0.0), clusters_at(), tracked=known_at((4.0, 0.0)))
    measured = Measurements.polar([0.0], [4.0], 0.05, 0.5, hand=[0])
    assert ownership.likeness(measured, 1).tolist() == [[0.0]]


def test_noise_does_not_make_a_hand_look_near():
    rng, ownership = np.random.default_rng(2), Ownership()
    for number in range(60):
        noise_px = rng.standard_normal((1, 21, 2))
        owners = judge(ownership, hand_at(6.0, 0.0, noise_px), clusters_at(), number=number)
    assert owners.range_m[0] == pytest.approx(6.0, abs=0.6)


@pytest.mark.parametrize(("images", "owner"), [(20, 1), (0, 2)])
def test_who_walks_past_takes_no_call_along_that_somebody_has_made(images, owner):
    """The passer-by fits a little better: on the ray, and at the very distance of the palm."""
    ownership, tracked = Ownership(), known_at((3.3, 0.2), (3.0, 0.0))
    for number in range(images):
        judge(ownership, hand_at(3.0, 0.0), clusters_at((3.3, 0.2)), tracked[[0]], number)
    both = clusters_at((3.3, 0.2), (3.0, 0.0))
    owners = judge(ownership, hand_at(3.0, 0.0), both, tracked, images)
    assert tracked.id[owners.person[0]] == owner


def test_a_hand_keeps_its_owner_though_a_pose_gives_it_to_another_torso_for_once():
    def with_torso(y):
        hand = hand_at(3.0, 0.4)
        return replace(hand, torso_px=np.array([[320.0 - 460.0 * y / 3.0, 320.0]]))

    ownership, people = Ownership(), clusters_at((3.0, 0.7), (3.0, -0.1))
    tracked = known_at((3.0, 0.7), (3.0, -0.1))
    for number in range(20):
        judge(ownership, with_torso(0.7), people, tracked, number)
    for number in range(20, 23):
        owners = judge(ownership, with_torso(-0.1), people, tracked, number)
        assert owners.cluster.tolist() == [0]


def test_a_bystander_keeps_no_hand():
    ownership, tracked = Ownership(), known_at((3.3, 0.2), (3.0, 0.0))
    tracked = replace(tracked, id=np.array([-1, -2]))
    for number in range(20):
        judge(ownership, hand_at(3.0, 0.0), clusters_at((3.3, 0.2)), tracked[[0]], number)
    both = clusters_at((3.3, 0.2), (3.0, 0.0))
    owners = judge(ownership, hand_at(3.0, 0.0), both, tracked, 20)
    assert owners.cluster.tolist() == [1]
