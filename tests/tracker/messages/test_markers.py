import numpy as np
import pytest

from tracker.containers import Pose, Tracks
from tracker.messages import encode_markers
from tracker.messages.markers import ellipse
from tracker.messages.types import deserialize


def two_people(selected_id=None):
    return Tracks(
        stamp_ns=3_000_000_004, id=[4, 9], mean=[[1, 2, 0, 0], [3, 4, 0, 0]],
        covariance=np.stack([np.diag([0.04, 0.01, 1, 1])] * 2), existence=[0.9, 0.5],
        confirmed=[True, True], raised=[True, False], raised_since_ns=[0, -1], age_s=[1, 1],
        unseen_s=[0, 0], hand=[0, -1], selected_id=selected_id,
    )  # fmt: skip


def test_the_first_marker_deletes_all_others():
    for tracks in (two_people(), Tracks.none(5)):
        first, *others = deserialize(*encode_markers(tracks)).markers
        assert first.action == 3
        assert all(marker.action == 0 for marker in others)


def test_each_person_has_a_body_a_label_and_an_ellipse_in_the_fixed_frame():
    markers = deserialize(*encode_markers(two_people(), frame_id="odom")).markers[1:]
    assert {(m.ns, m.id) for m in markers} == {
        (name, number) for name in ("people", "labels", "ellipses") for number in (4, 9)
    }
    assert {m.header.frame_id for m in markers} == {"odom"}
    body = next(m for m in markers if (m.ns, m.id) == ("people", 9))
    assert (body.pose.position.x, body.pose.position.y) == (3.0, 4.0)
    label = next(m for m in markers if (m.ns, m.id) == ("labels", 4))
    assert label.text == "#4 hand up (0.90)"


def test_the_selected_person_looks_different():
    plain = deserialize(*encode_markers(two_people())).markers
    chosen = deserialize(*encode_markers(two_people(selected_id=4))).markers
    assert plain[1].color != chosen[1].color
    assert "served" in chosen[2].text
    assert plain[4].color == chosen[4].color


def test_the_approach_pose_is_an_arrow_in_its_own_frame():
    pose = Pose(7, "odom", (1.0, 2.0, 0.0), (0.0, 0.0, 0.6, 0.8))
    arrow = deserialize(*encode_markers(Tracks.none(7), approach=pose)).markers[-1]
    assert (arrow.ns, arrow.type, arrow.header.frame_id) == ("approach", 0, "odom")
    assert arrow.pose.orientation.z == 0.6


def test_the_ellipse_holds_95_percent():
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    covariance = turn @ np.diag([0.25, 0.04]) @ turn.T
    length, width, yaw = ellipse(covariance)

    points = np.random.default_rng(2).multivariate_normal([0, 0], covariance, 20_000)
    along = points @ [np.cos(yaw), np.sin(yaw)]
    across = points @ [-np.sin(yaw), np.cos(yaw)]
    inside = (2 * along / length) ** 2 + (2 * across / width) ** 2 < 1
    assert inside.mean() == pytest.approx(0.95, abs=0.006)


def test_a_certain_position_still_has_a_size_that_rviz_takes():
    length, width, _ = ellipse(np.zeros((2, 2)))
    assert length > 0
    assert width > 0
