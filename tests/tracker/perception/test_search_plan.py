import numpy as np
import pytest

from tracker.perception.search_plan import (
    MOVED_IMAGES,
    SearchPlan,
    clip_boxes,
    moved_windows,
    rotation_windows,
)

SIZE = (640, 480)
NOWHERE = np.zeros((0, 4))


def choices(frames, count=1, expected=NOWHERE, moved=NOWHERE, plan=None):
    """The windows of each frame, as tuples."""
    plan = plan or SearchPlan(SIZE)
    return [
        [tuple(window) for window in plan.choose(count, expected, moved).tolist()]
        for _ in range(frames)
    ]


def shows(frame, person):
    """Whether one of the windows is a person's, which sways from side to side."""
    x_min, y_min, x_max, y_max = person
    sway = 0.2 * (x_max - x_min) + 1
    return any(
        abs(window[0] - x_min) <= sway and (window[1], window[3]) == (y_min, y_max)
        for window in frame
    )


def all_places(width, height):
    return {
        tuple(window) for window in rotation_windows(width, height).round().astype(int).tolist()
    }


def test_a_vga_picture_has_the_whole_fifteen_tiles_and_eighteen_for_far_hands():
    windows = rotation_windows(*SIZE)
    far, windows = windows[16:], windows[:16]
    assert len(far) == 18
    assert sorted(set(far[:, 1])) == [80, 160]
    np.testing.assert_allclose(far[:, 2:] - far[:, :2], 160)
    assert windows[0].tolist() == [0, 0, 640, 480]
    assert sorted(set(windows[1:, 0])) == [0, 100, 200, 300, 400]
    assert sorted(set(windows[1:, 1])) == [0, 120, 240]
    assert set((windows[1:, 2:] - windows[1:, :2]).ravel()) == {240}


@pytest.mark.parametrize("size", [(1920, 1080), (480, 640), (300, 300), (1000, 100), (1, 1)])
def test_tiles_of_any_picture_cover_every_part_and_lie_close(size):
    windows = rotation_windows(*size)[1:]
    side = min(size) / 2
    windows = windows[np.isclose(windows[:, 2] - windows[:, 0], side)]
    np.testing.assert_allclose(windows[:, 2:] - windows[:, :2], side)
    assert windows.min() == 0
    np.testing.assert_allclose(windows.max(axis=0)[2:], size)
    for axis, step in ((0, 0.42), (1, 0.5)):
        assert np.all(np.diff(np.unique(windows[:, axis])) <= step * side + 1e-9)


def test_a_picture_at_rest_is_searched_all_over_and_as_a_whole_every_other_time():
    seen = [window for (window,) in choices(70)]
    assert set(seen) == all_places(*SIZE)
    assert {place for place in seen[::2]} == {(0, 0, 640, 480)}
    assert (0, 0, 640, 480) not in seen[1::2]


@pytest.mark.parametrize("count", [1, 2, 3])
def test_no_place_waits_longer_than_a_bound_whatever_is_expected_and_moves(count):
    rng = np.random.default_rng(4)
    plan, last, longest = SearchPlan(SIZE), {place: 0 for place in all_places(*SIZE)}, 0
    for frame in range(1000):
        # A robot that turns: six people and as many movements are somewhere else each time.
        corner = rng.uniform(0, 400, (6, 2))
        boxes = np.concatenate([corner, corner + rng.uniform(60, 240, (6, 1))], axis=1)
        for window in plan.choose(count, boxes, boxes).tolist():
            if tuple(window) in last:
                last[tuple(window)] = frame
        longest = max(longest, *(frame - then for then in last.values()))
    # An expected place with movement needs 12 * 10 * 2 = 240 at most: a tile that waits longer
    # comes first. Half a place of each image goes to the whole.
    assert longest <= 240 + 33 / (count - 0.5)


def test_a_few_expected_places_come_every_few_frames_and_the_rest_still():
    people = np.array([[100.0, 50, 220, 170], [400, 60, 520, 180]])
    frames = choices(200, count=2, expected=people)
    for place in people.astype(int).tolist():
        turns = np.flatnonzero([shows(frame, place) for frame in frames])
        assert turns[0] <= 2
        assert np.diff(turns).max() <= 8
    assert all_places(*SIZE) <= {window for frame in frames for window in frame}


def test_tiles_where_something_moved_come_before_the_rest():
    plan = SearchPlan(SIZE)
    choices(60, plan=plan)
    moved = np.array([[500.0, 330, 520, 350]])
    seen = [window for frame in choices(400, moved=moved, plan=plan) for window in frame]
    for holds in [(400, 240, 640, 480), (400, 120, 640, 360), (300, 240, 540, 480)]:
        assert seen.count(holds) >= 1.7 * seen.count((0, 0, 240, 240)) > 0


def test_a_person_in_whose_window_something_moved_comes_soon():
    people = np.array([[60.0 * n, 50, 60.0 * n + 70, 120] for n in range(8)])
    plan = SearchPlan(SIZE)
    choices(60, expected=people, plan=plan)
    arm = np.array([[325.0, 60, 345, 90]])
    for _ in range(8):
        if shows(plan.choose(2, people, arm).tolist(), people[5]):
            return
    pytest.fail("the moving arm was not looked at within eight frames")


def test_windows_around_people_sway_to_both_sides():
    person = np.array([[300.0, 100, 400, 200]])
    frames = choices(60, count=3, expected=person)
    lefts = [w[0] for frame in frames for w in frame if (w[1], w[3]) == (100, 200)]
    assert 280 <= min(lefts) < 290 < 310 < max(lefts) <= 320


def test_places_of_one_frame_differ():
    for frame in choices(20, count=5, expected=np.array([[100.0, 50, 220, 170]])):
        assert len(set(frame)) == 5


def test_there_are_no_more_choices_than_places():
    assert len(choices(1, count=64)[0]) == 34


def test_the_same_calls_make_the_same_choices():
    assert choices(30) == choices(30)


def test_boxes_outside_of_the_picture_are_left_out_and_others_cut():
    boxes = np.array([[-50.0, -20, 30, 40], [700, 0, 800, 90], [600, 470, 900, 900]])
    assert clip_boxes(boxes, SIZE).tolist() == [[0, 0, 30, 40], [600, 470, 640, 480]]


def test_the_window_around_a_small_movement_is_a_quarter_of_the_picture_high():
    arm = np.array([[300.0, 200.0, 320.0, 240.0]])
    assert moved_windows(arm, SIZE).tolist() == [[250, 140, 370, 260]]
    near = np.array([[200.0, 200.0, 300.0, 400.0]])
    assert moved_windows(near, SIZE).tolist() == [[100, 50, 400, 350]]
    assert moved_windows(NOWHERE, SIZE).shape == (0, 4)


def test_where_something_moved_is_searched_often_for_a_while():
    plan, arm = SearchPlan(SIZE), np.array([[300.0, 200.0, 320.0, 240.0]])
    place = (250, 140, 370, 260)
    choices(1, 1, moved=arm, plan=plan)
    seen = [shows(frame, place) for frame in choices(MOVED_IMAGES - 1, 3, plan=plan)]
    assert sum(seen) >= 4
    later = [shows(frame, place) for frame in choices(30, 3, plan=plan)]
    assert not any(later)


def test_movements_do_not_starve_the_rest():
    plan, rng = SearchPlan(SIZE), np.random.default_rng(5)
    seen = set()
    for _ in range(400):
        low = rng.uniform(0, 400, (10, 2))
        (frame,) = choices(1, 3, moved=np.concatenate([low, low + 30], axis=1), plan=plan)
        seen |= set(frame)
    assert all_places(*SIZE) <= seen
