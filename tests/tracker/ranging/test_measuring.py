from dataclasses import replace

import numpy as np
import pytest

from tracker import Config, Hands
from tracker.camera import CameraModel
from tracker.geometry import RigidTransform
from tracker.ranging import Background, Memory, PersonClusters, measure_people

CAMERA = CameraModel(460.0, 460.0, 320.0, 240.0)
AT_ORIGIN = RigidTransform()


def hands_toward(*points, raised=True, right=None, thumb=0):
    """Hands whose wrists stand at points (x, y) of the camera's body frame, 0.3 m up."""
    count = len(points)
    landmarks = np.zeros((count, 21, 2))
    for row, (x, y) in enumerate(points):
        wrist = np.array([320.0 - 460.0 * y / x, 240.0 - 460.0 * 0.3 / x])
        landmarks[row] = wrist
        landmarks[row, 12] = wrist - [0.0, 460.0 * 0.18 / x]
        landmarks[row, 9] = wrist - [0.0, 460.0 * 0.095 / x]
        # The thumb points to the image's right where `thumb` is 1, to its left where it is -1.
        landmarks[row, 4, 0] += thumb * 460.0 * 0.1 / x
    one = np.ones(count)
    right = one if right is None else np.asarray(right, float)
    return Hands(landmarks, one, right, np.full(count, raised), one)


def positions(measurements):
    angle = measurements.values[:, 0] + measurements.sensor_pose[:, 2]
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return measurements.sensor_pose[:, :2] + measurements.values[:, 1:] * direction


def test_the_person_is_measured_not_the_wall_behind_the_hand(cast, legs):
    scan = cast(legs(2.0, 0.3))
    found = measure_people(hands_toward((2.0, 0.0)), CAMERA, AT_ORIGIN, scan, Config())
    assert positions(found)[0] == pytest.approx([2.0, 0.3], abs=0.06)
    assert found.raised.tolist() == [True]


def test_ranging_spec_asks_the_beam_at_the_ray(cast, legs):
    scan = cast(legs(2.0, 0.4), wall_m=4.0)
    config = Config(ranging="spec", scan_sustains=False)
    found = measure_people(hands_toward((2.0, 0.0)), CAMERA, AT_ORIGIN, scan, config)
    assert found.values[0] == pytest.approx([0.0, 4.0], abs=1e-6)


def test_ranging_spec_follows_the_ray_of_a_camera_beside_the_laser(cast):
    laser = np.array([-0.3, -0.5, 1.0])
    scan = cast([(2.0, 0.0, 0.3)], laser)
    config = Config(ranging="spec", scan_sustains=False)
    found = measure_people(hands_toward((2.0, 0.0)), CAMERA, AT_ORIGIN, scan, config)
    assert found.values[0] == pytest.approx([0.0, 1.7], abs=0.03)


def test_somebody_who_passes_far_in_front_of_a_hand_does_not_own_it(cast, legs):
    scan = cast(legs(2.0, 0.1))
    found = measure_people(
        hands_toward((4.5, 0.0)), CAMERA, AT_ORIGIN, scan, Config(scan_sustains=False)
    )
    assert found.values[0] == pytest.approx([0.0, 4.5], abs=0.15)


def test_of_two_people_at_the_ray_the_one_as_near_as_the_hand_is_large(cast, legs):
    scan = cast(legs(1.2, 0.25) + legs(3.0, -0.1))
    for point, owner in [((1.2, 0.0), (1.2, 0.25)), ((3.0, 0.0), (3.0, -0.1))]:
        found = measure_people(hands_toward(point), CAMERA, AT_ORIGIN, scan, Config())
        assert positions(found)[0] == pytest.approx(owner, abs=0.07)


@pytest.mark.parametrize(("thumb", "owner_y"), [(1, -0.35), (-1, 0.35)])
def test_of_two_people_beside_the_hand_the_one_at_whom_the_thumb_points(
    cast, legs, thumb, owner_y
):
    scan = cast(legs(1.5, 0.35) + legs(1.5, -0.35))
    hands = hands_toward((1.5, 0.0), thumb=thumb)
    found = measure_people(hands, CAMERA, AT_ORIGIN, scan, Config())
    assert positions(found)[0] == pytest.approx([1.5, owner_y], abs=0.06)


def test_a_hand_whose_direction_is_unknown_is_not_measured_and_others_keep_their_row():
    hands = hands_toward((2.0, 0.5), (2.0, 0.0), (2.0, -0.5))
    landmarks = np.array(hands.landmarks_px)
    landmarks[1, :, 0] = np.nan
    found = measure_people(
        replace(hands, landmarks_px=landmarks), CAMERA, AT_ORIGIN, None, Config(ranging="spec")
    )
    assert found.hand.tolist() == [0, 2]


def test_a_camera_at_an_absurd_place_measures_nobody(cast, legs):
    nowhere = RigidTransform((9e9, 0.0, 0.0))
    scan = cast(legs(2.0, 0.0))
    assert len(measure_people(hands_toward((2.0, 0.0)), CAMERA, nowhere, scan, Config())) == 0


def test_of_a_body_at_the_lens_the_bearing_is_as_good_as_unknown(cast, legs):
    config = Config(range_std_m=2.0)
    found = measure_people(Hands.none(), CAMERA, AT_ORIGIN, cast(legs(0.3, 0.0)), config)
    assert len(found) == 1
    assert np.sqrt(found.covariance[0, 0, 0]) == pytest.approx(np.pi / np.sqrt(3.0))


def test_without_a_scan_a_hand_is_as_near_as_it_is_large():
    found = measure_people(hands_toward((2.0, 0.5)), CAMERA, AT_ORIGIN, None, Config())
    expected = np.arctan2(0.5, 2.0), np.hypot(2.0, 0.5)
    assert found.values[0] == pytest.approx(expected, abs=0.02)
    assert 0.3 < np.sqrt(found.covariance[0, 1, 1]) < 0.5


def test_a_palm_too_short_to_tell_leaves_a_bearing_only():
    found = measure_people(hands_toward((20.0, 5.0)), CAMERA, AT_ORIGIN, None, Config())
    assert found.values[0, 0] == pytest.approx(np.arctan2(5.0, 20.0))
    assert np.isnan(found.values[0, 1])


@pytest.mark.parametrize("thumb", [-1, 1])
def test_a_hand_whose_owner_nothing_shows_puts_the_owner_where_the_thumb_points(thumb):
    hands = hands_toward((2.0, 0.0), thumb=thumb)
    found = measure_people(hands, CAMERA, AT_ORIGIN, None, Config())
    assert positions(found)[0, 1] == pytest.approx(-0.3 * thumb, abs=0.02)


def test_other_people_in_the_scan_are_measured_as_not_raising(cast, legs):
    scan = cast(legs(2.0, 0.2) + legs(2.0, -1.0))
    found = measure_people(hands_toward((2.0, 0.0)), CAMERA, AT_ORIGIN, scan, Config())
    assert found.raised.tolist() == [True, False]
    assert positions(found)[1] == pytest.approx([2.0, -1.0], abs=0.06)
    alone = measure_people(
        hands_toward((2.0, 0.0)), CAMERA, AT_ORIGIN, scan, Config(), sustain=False
    )
    assert len(alone) == 1


def test_two_hands_at_one_body_name_the_same_person(cast, legs):
    scan = cast(legs(2.0, 0.0))
    found = measure_people(
        hands_toward((2.0, 0.3), (2.0, -0.3)), CAMERA, AT_ORIGIN, scan, Config()
    )
    assert found.person[0] == found.person[1] >= 0


def test_without_a_scan_a_left_and_a_right_hand_side_by_side_are_one_person():
    hands = hands_toward((2.0, 0.3), (2.0, -0.3), right=[1.0, 0.0])
    found = measure_people(hands, CAMERA, AT_ORIGIN, None, Config())
    assert found.person[0] == found.person[1] >= 0


def test_without_a_scan_two_right_hands_are_two_people():
    hands = hands_toward((2.0, 0.3), (2.0, -0.3))
    found = measure_people(hands, CAMERA, AT_ORIGIN, None, Config())
    assert found.person.tolist() == [-1, -1]


def test_the_scan_s_covariance_is_round_whatever_the_range(cast, legs):
    scan = cast(legs(3.0, 0.0))
    config = Config(range_std_m=0.1)
    found = measure_people(hands_toward((3.0, 0.0)), CAMERA, AT_ORIGIN, scan, config)
    across_m = np.sqrt(found.covariance[0, 0, 0]) * found.values[0, 1]
    assert across_m == pytest.approx(0.1)
    assert np.sqrt(found.covariance[0, 1, 1]) == pytest.approx(0.1)


def clusters_at(points, legs=2):
    count = len(points)
    width = np.full(count, 0.3 if legs == 2 else 0.06)
    return PersonClusters(
        np.array(points, float), width, np.full(count, legs), np.zeros(count)
    )  # fmt: skip


def still_background(scan, *points, legs=2):
    """A background that has seen things stand at these points for longer than a minute."""
    background = Background()
    for number in range(700):
        later = replace(scan, stamp_ns=number * 100_000_000)
        background.observe(later, clusters_at(points, legs), 30.0)
    return background


def test_what_has_stood_still_for_long_sustains_nobody(cast, legs):
    scan = cast(legs(2.0, 0.2) + legs(2.0, -1.0))
    background = still_background(scan, (2.0, -1.0))
    memory = Memory(background)
    found = measure_people(Hands.none(), CAMERA, AT_ORIGIN, scan, Config(), memory=memory)
    assert positions(found) == pytest.approx(np.array([[2.0, 0.2]]), abs=0.06)


def test_who_has_stood_still_for_long_and_raises_a_hand_is_somebody(cast, legs):
    scan = cast(legs(2.0, 0.3))
    background = still_background(scan, (2.0, 0.3))
    arguments = (CAMERA, AT_ORIGIN, scan, Config())
    found = measure_people(hands_toward((2.0, 0.0)), *arguments, memory=Memory(background))
    assert positions(found) == pytest.approx(np.array([[2.0, 0.3]]), abs=0.06)
    after = measure_people(Hands.none(), *arguments, memory=Memory(background))
    assert positions(after) == pytest.approx(np.array([[2.0, 0.3]]), abs=0.06)


def test_a_person_owns_a_hand_rather_than_the_furniture_beside(cast, legs):
    scan = cast([(2.0, -0.3, 0.07), (2.0, 0.45, 0.07)])
    background = still_background(scan, (2.0, -0.3), legs=1)
    found = measure_people(
        hands_toward((2.0, 0.0)), CAMERA, AT_ORIGIN, scan, Config(),
        memory=Memory(background),
    )  # fmt: skip
    assert positions(found)[0] == pytest.approx([2.0, 0.45], abs=0.08)


def test_a_leg_in_trousers_owns_a_hand_rather_than_a_table_s_leg_that_fits_better(cast):
    post, leg = (2.0, 0.15, 0.025), (2.0, -0.36, 0.07)
    for circles, owner in (([post, leg], leg), ([post], post)):
        found = measure_people(
            hands_toward((2.0, 0.0)), CAMERA, AT_ORIGIN, cast(circles, beams=1440), Config()
        )
        assert positions(found)[0] == pytest.approx(owner[:2], abs=0.08)


def test_somebody_far_behind_does_not_own_a_hand_that_is_near(cast, legs):
    scan = cast(legs(5.5, 0.3))
    found = measure_people(hands_toward((1.5, 0.0)), CAMERA, AT_ORIGIN, scan, Config())
    assert found.values[0] == pytest.approx([0.0, 1.5], abs=0.02)


def test_a_palm_that_tilts_away_is_as_near_as_it_is_broad(cast, legs):
    scan = cast(legs(1.5, 0.25) + legs(3.4, 0.25))
    hands = hands_toward((1.5, 0.0))
    landmarks = hands.landmarks_px.copy()
    landmarks[0, 9] = landmarks[0, 0] - [0.0, 460.0 * 0.04 / 1.5]
    landmarks[0, 5] = landmarks[0, 9] + [460.0 * 0.0323 / 1.5, 0.0]
    landmarks[0, 17] = landmarks[0, 9] - [460.0 * 0.0323 / 1.5, 0.0]
    tilted = replace(hands, landmarks_px=landmarks)
    found = measure_people(tilted, CAMERA, AT_ORIGIN, scan, Config())
    assert positions(found)[0] == pytest.approx([1.5, 0.25], abs=0.08)


def with_torso(hands, *points):
    """The same hands, whose owners' torsos stand at points (x, y) of the camera's body frame."""
    torso = [(320.0 - 460.0 * y / x, 240.0) for x, y in points]
    return replace(hands, torso_px=np.array(torso))


def test_of_two_people_at_the_hand_the_one_whose_torso_is_known(cast, legs):
    scan = cast(legs(1.5, 0.35) + legs(1.5, -0.35))
    for y in (0.35, -0.35):
        hands = with_torso(hands_toward((1.5, 0.0)), (1.5, y))
        found = measure_people(hands, CAMERA, AT_ORIGIN, scan, Config())
        assert positions(found)[0] == pytest.approx([1.5, y], abs=0.07)


def test_a_torso_s_bearing_is_surer_than_a_wrist_s():
    hands = hands_toward((2.0, 0.3))
    config = Config()
    wrist, torso = (
        measure_people(each, CAMERA, AT_ORIGIN, None, config)
        for each in (hands, with_torso(hands, (2.0, 0.0)))
    )
    assert torso.values[0, 0] == pytest.approx(0.0, abs=1e-9)
    # Two parts: the offset at the hand's range, and the noise of the pixel.
    length = hands.length_px[0]
    pixel = np.hypot(0.3 + 0.005 * length, 1.0 + 0.02 * length) / 460.0
    expected = np.hypot(np.arctan2(config.torso_offset_std_m, np.hypot(2.0, 0.3)), pixel)
    assert np.sqrt(torso.covariance[0, 0, 0]) == pytest.approx(expected, rel=1e-2)
    assert torso.covariance[0, 0, 0] < wrist.covariance[0, 0, 0] / 4


def test_who_sits_has_the_body_behind_the_shins_and_is_less_certain(cast, legs):
    scan, hands = cast(legs(2.0, 0.3)), hands_toward((2.0, 0.0))
    stands, sits, maybe, unknown = (
        measure_people(replace(hands, seated=np.array([share])), CAMERA, AT_ORIGIN, scan, Config())
        for share in (0.0, 1.0, 0.5, np.nan)
    )
    assert positions(unknown) == pytest.approx(positions(stands))
    back_m = [each.values[0, 1] - stands.values[0, 1] for each in (maybe, sits)]
    assert back_m == pytest.approx([0.05, 0.1])
    lasting_m2 = [np.trace(each.bias_covariance[0]) for each in (stands, maybe, sits)]
    assert sorted(lasting_m2) == lasting_m2
    assert lasting_m2[2] > 2.0 * lasting_m2[0]
    assert sits.covariance[0, 1, 1] > maybe.covariance[0, 1, 1] > stands.covariance[0, 1, 1]


def test_what_lasts_of_a_hand_without_a_body_is_across_its_ray():
    (bias,) = measure_people(
        hands_toward((2.0, 0.0)), CAMERA, AT_ORIGIN, None, Config(mounting_std_deg=0.0)
    ).bias_covariance
    assert np.sqrt(np.diag(bias)) == pytest.approx([0.08, 0.2], abs=1e-6)
