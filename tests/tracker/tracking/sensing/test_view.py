import numpy as np
import pytest

from tracker import Config, Measurements, PersonTracker
from tracker.tracking import View
from tracker.tracking.sensing.view import view_numbers, visibility

pytestmark = pytest.mark.usefixtures("machine_code")

AHEAD = View(np.zeros(3), np.deg2rad(70), 8.0)


def seen(places_m, view):
    """Chance of being in sight of people at these places."""
    mean = np.pad(np.asarray(places_m, dtype=float), ((0, 0), (0, 2)))
    return visibility(mean[None], view_numbers(view))


def test_outside_the_field_of_view_or_too_far_nobody_is_seen():
    xy = np.array([[3.0, 0.0], [-3.0, 0.0], [1.0, 3.0], [9.0, 0.0]])
    assert seen(xy, AHEAD).tolist() == [1.0, 0.0, 0.0, 0.0]


def test_whoever_stands_on_the_edge_is_half_in_view():
    edge = np.deg2rad(35)
    xy = 3.0 * np.array([[np.cos(edge), np.sin(edge)], [np.cos(edge), -np.sin(edge)]])
    assert seen(xy, AHEAD) == pytest.approx([0.5, 0.5])


def test_a_view_may_reach_farther_to_one_side():
    view = View.between([1.0, 0.0, np.pi / 2], np.deg2rad(-10), np.deg2rad(80))
    left_behind, right_behind = [-2.0, 1.5], [4.0, 1.5]
    assert seen(np.array([left_behind, right_behind]), view).tolist() == [1.0, 0.0]


def test_the_field_of_view_turns_with_the_sensor_across_pi():
    xy = np.array([[-3.0, 0.1], [-3.0, -0.1]])
    view = View(np.array([0.0, 0.0, np.pi]), np.deg2rad(40))
    assert (seen(xy, view) == 1.0).all()


def test_who_stands_behind_somebody_is_hardly_seen():
    xy = np.array([[2.0, 0.0], [4.0, 0.1], [4.0, 1.5]])
    chance = seen(xy, AHEAD)
    assert chance[[0, 2]] == pytest.approx(1.0)
    assert 0.0 < chance[1] < 0.5


def test_without_a_view_everybody_could_be_seen():
    assert seen(np.zeros((2, 2)), None).tolist() == [1.0, 1.0]


def test_silence_tells_nothing_of_people_out_of_view():
    behind = View(np.array([0.0, 0.0, np.pi]), np.deg2rad(70))
    remaining = {}
    for name, view in [("in view", AHEAD), ("out of view", behind)]:
        tracker = PersonTracker(Config(delete_after_s=2.0))
        claims = Measurements.cartesian([[3.0, 0.0]], 0.01 * np.eye(2))
        for number in range(5):
            tracker.step(number * 10**8, claims)
        for number in range(5, 60):
            tracks = tracker.step(number * 10**8, Measurements.none(), view=view)
        remaining[name] = len(tracks)
    assert remaining == {"in view": 0, "out of view": 1}


BEHIND = View(np.array([0.0, 0.0, np.pi]), np.deg2rad(70))


def gone_after_s(config):
    """When a customer is gone who was seen for half a second, and then is out of view."""
    tracker = PersonTracker(config)
    claims = Measurements.cartesian([[3.0, 0.0]], 0.01 * np.eye(2))
    for number in range(5):
        tracker.step(number * 10**8, claims)
    while len(tracker.step(number * 10**8, Measurements.none(), view=BEHIND)):
        number += 1
    return number / 10 - 0.4


def test_who_is_out_of_view_for_long_is_forgotten_nevertheless():
    assert gone_after_s(Config(forget_after_s=4.0)) == pytest.approx(4.1)


def test_whose_place_is_unknown_by_now_is_gone_though_nobody_looked():
    gone_s = gone_after_s(Config(forget_after_s=1000.0, delete_after_s=2.0))
    assert 2.0 < gone_s < 60.0


def test_a_view_is_read_only_for_the_loops_and_none_at_all_is_everywhere():
    numbers = view_numbers(AHEAD)
    assert numbers == pytest.approx([0.0, 0.0, 0.0, np.deg2rad(70), 8.0])
    assert not numbers.flags.writeable
    assert len(view_numbers(None)) == 0


ALL_AROUND = View(np.zeros(3), 2 * np.pi)


@pytest.mark.parametrize(
    ("scan_view", "remaining"), [(ALL_AROUND, 0), (None, 1)], ids=["scan", "no scan"]
)
def test_who_is_out_of_the_camera_s_view_fades_only_where_a_scan_would_show_them(
    scan_view, remaining
):
    tracker = PersonTracker(Config(delete_after_s=2.0))
    claims = Measurements.cartesian([[3.0, 0.0]], 0.01 * np.eye(2))
    for number in range(5):
        tracker.step(number * 10**8, claims)
    behind = View(np.array([0.0, 0.0, np.pi]), np.deg2rad(70))
    for number in range(5, 60):
        tracks = tracker.step(
            number * 10**8, Measurements.none(), view=behind, scan_view=scan_view
        )
    assert len(tracks) == remaining
