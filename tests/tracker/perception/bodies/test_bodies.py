from dataclasses import replace

import numpy as np
import pytest

from tracker.errors import ShapeError
from tracker.perception.bodies.bodies import Bodies, Joint, one_row_each, same_people


def test_the_torso_is_the_middle_of_shoulders_and_hips(body):
    np.testing.assert_allclose(body().torso_px, [[200, 128]])


def test_without_a_hip_the_torso_is_the_middle_of_the_shoulders(body):
    np.testing.assert_allclose(body(left_hip=None).torso_px, [[200, 100]])


def test_without_a_shoulder_there_is_neither_torso_nor_yardstick(body):
    somebody = body(right_shoulder=None)
    assert np.isnan(somebody.torso_px).all()
    assert np.isnan(somebody.shoulder_px).all()


def test_a_shoulder_beyond_the_pictures_edge_is_where_the_model_supposes_it(body):
    somebody = body()
    unsure = somebody.visibility.copy()
    unsure[0, Joint.LEFT_SHOULDER] = 0.1
    cut_off = replace(somebody, visibility=unsure)
    np.testing.assert_allclose(cut_off.shoulder_px, somebody.shoulder_px)
    uneven = somebody.points_px.copy()
    uneven[0, Joint.LEFT_SHOULDER, 0] = 245.0  # 45 px from the nose, the other 20
    assert np.isnan(replace(cut_off, points_px=uneven).shoulder_px).all()


@pytest.mark.parametrize(
    ("fall_px", "share"), [(49, 0.0), (32, 0.51), (20, 1.0), (-5, 1.0)],
    ids=["stands", "in between", "sits facing", "feet up"],
)  # fmt: skip
def test_who_has_the_knees_at_the_height_of_the_hips_sits(body, fall_px, share):
    somebody = body(left_knee=(212, 156 + fall_px), right_knee=(188, 156 + fall_px))
    assert somebody.seated == pytest.approx([share], abs=0.01)


@pytest.mark.parametrize("hidden", ["left_knee", "right_hip", "left_shoulder"])
def test_without_knees_or_hips_nobody_knows_who_sits(body, hidden):
    assert np.isnan(body(**{hidden: None}).seated).all()


def test_the_yardstick_is_the_width_of_the_shoulders(body):
    np.testing.assert_allclose(body().shoulder_px, [40.0])


def test_somebody_sideways_is_measured_by_the_trunk(body):
    sideways = body(left_shoulder=(202, 100), right_shoulder=(198, 100))
    np.testing.assert_allclose(sideways.shoulder_px, [0.7 * 56.0])


def test_a_nose_at_the_shoulders_is_misread(body):
    assert body().is_misread.tolist() == [False]
    assert body(nose=(200, 91)).is_misread.tolist() == [False]
    assert body(nose=(200, 93)).is_misread.tolist() == [True]
    assert body(nose=None).is_misread.tolist() == [False]


def test_shoulders_on_one_spot_are_no_yardstick(body):
    flat = body(left_shoulder=(200, 100), right_shoulder=(200, 100), left_hip=None)
    assert np.isnan(flat.shoulder_px).all()


def test_points_that_are_not_finite_are_not_visible(body):
    points = body().points_px.copy()
    points[0, Joint.NOSE] = np.nan
    somebody = Bodies.seen_now(points, np.ones((1, 17)), np.ones(1))
    assert not somebody.is_visible[0, Joint.NOSE]
    assert somebody.is_visible.sum() == 16


def test_a_small_move_is_the_same_person_and_a_step_aside_is_not(body):
    assert same_people(body(), body(shift_px=(15, 0))).tolist() == [[True]]
    assert same_people(body(), body(shift_px=(30, 0))).tolist() == [[False]]


def test_of_two_rows_of_a_person_the_freshest_stays_then_the_surest(body):
    rows = Bodies.concatenate(
        body(age_s=0.5), body(score=0.7), body(score=0.9), body(shift_px=(200, 0), age_s=3.0)
    )
    assert one_row_each(rows).tolist() == [False, False, True, True]


def test_nobody_is_a_batch_of_none(body):
    nobody = Bodies.none()
    assert len(nobody) == 0
    assert nobody.torso_px.shape == (0, 2)
    assert same_people(nobody, body()).shape == (0, 1)
    assert len(one_row_each(nobody)) == 0


def test_a_batch_grows_older_and_cannot_be_written_to(body):
    older = body(age_s=0.2).grown_older(0.3)
    assert older.age_s.tolist() == [0.5]
    with pytest.raises(ValueError, match="read-only"):
        older.points_px[0] = 0.0


def test_arrays_that_disagree_are_refused():
    with pytest.raises(ShapeError, match=r"\(2, 17\)"):
        Bodies.seen_now(np.zeros((1, 17, 2)), np.zeros((2, 17)), np.zeros(1))


def test_joints_are_numbered_as_in_coco():
    assert [joint.value for joint in Joint] == list(range(17))
    assert Joint.RIGHT_WRIST == 10
