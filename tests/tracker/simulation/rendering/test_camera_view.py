import numpy as np
import pytest

from tracker.simulation import load_scene, scene_from_mapping
from tracker.simulation.motion import people_at
from tracker.simulation.projection import Viewpoint
from tracker.simulation.rendering.camera_view import CameraView, hands_in_view, is_from_behind
from tracker.simulation.stream import map_from_camera


def view_at(scene, time_s):
    return Viewpoint.of(scene.camera, map_from_camera(scene, time_s))


def quiet(room):
    """The scene without noise and blur, so that pixels can be compared."""
    room["camera"].update(noise_std=0.0, blur_px=0.0)
    return scene_from_mapping(room)


def painted(scene, time_s):
    view = CameraView(scene, np.random.default_rng(0))
    return view.render(view_at(scene, time_s), people_at(scene, time_s))


def test_what_was_painted_before_does_not_change_a_picture(room):
    scene = quiet(room)
    painter = CameraView(scene, np.random.default_rng(0))
    for time_s in (0.0, 0.7, 0.7, 1.5):
        again = painter.render(view_at(scene, time_s), people_at(scene, time_s))
        np.testing.assert_array_equal(again, painted(scene, time_s))


def test_the_near_hides_the_far(room):
    here, behind = {"x_m": 1.5, "y_m": 0.0}, {"x_m": 3.5, "y_m": 0.0}
    room["robot"], room["tables"] = {}, []
    front = {"id": 1, "path": [here], "look": {"shirt": "#00ff00"}}
    back = {"id": 2, "path": [behind], "look": {"shirt": "#ff0000"}}
    for people in ([front, back], [back, front]):
        room["people"] = people
        picture = painted(quiet(room), 0.0).astype(int)
        blue, green, red = picture[60, 80]
        assert green > 150 > red + blue


def test_a_table_hides_the_legs_behind_it(room):
    room["robot"] = {}
    room["people"] = [{"id": 1, "path": [{"x_m": 2.5, "y_m": 0.0}]}]
    room["tables"] = [{"x_m": 1.6, "y_m": 0.0, "plates": 0, "color": "#00ff00"}]
    picture = painted(quiet(room), 0.0).astype(int)
    row = round(60 + 115 * (1.2 - 0.74) / (1.6 - 0.1))  # the middle of its top
    assert picture[row, 80].tolist() == [0, 255, 0]


def test_a_chair_hides_what_is_behind_its_back_and_not_who_sits_on_it(room):
    room["robot"], room["tables"] = {}, []
    room["people"] = [
        {
            "id": 1, "seat_m": 0.45, "stool": False, "look": {"shirt": "#ff0000"},
            "path": [{"x_m": 2.0, "y_m": 0.0, "facing_deg": 180.0}],
        }
    ]  # fmt: skip
    chair = {"x_m": 2.0, "y_m": 0.0, "color": "#00ff00"}
    trunk = np.s_[round(60 + 115 * (1.2 - 0.72) / 1.9), 80]
    for yaw_deg, strongest in ((180.0, 2), (0.0, 1)):  # facing the camera, and its back to it
        room["chairs"] = [chair | {"yaw_deg": yaw_deg}]
        assert painted(quiet(room), 0.0)[trunk].argmax() == strongest


@pytest.mark.parametrize("shows", ["menu", "person", "raised_hand"])
def test_a_poster_hangs_where_it_is_said_to_and_is_hidden_by_who_stands_before_it(room, shows):
    room["robot"], room["tables"], room["people"] = {}, [], []
    # Across the view at 2 m; its middle is straight ahead, at the camera's height.
    wall = {"corners_m": [[2.1, -2.0], [2.1, 2.0]], "pictures": False}
    bare = painted(quiet(room | {"walls": [wall]}), 0.0).astype(int)
    wall["posters"] = [{"at_m": 2.0, "z_m": 1.2, "shows": shows}]
    changed = np.any(painted(quiet(room | {"walls": [wall]}), 0.0) != bare, axis=-1)
    rows, columns = np.nonzero(changed)
    assert np.mean(columns) == pytest.approx(80, abs=1.5)
    assert np.mean(rows) == pytest.approx(60, abs=1.5)
    assert np.ptp(columns) == pytest.approx(115 * 0.6 / 2.0, abs=2)
    assert np.ptp(rows) == pytest.approx(115 * 0.9 / 2.0, abs=2)


def test_pixel_noise_has_the_asked_size(room):
    clean = painted(quiet(room), 0.0).astype(float)
    room["camera"].update(noise_std=4.0, blur_px=0.0)
    noisy = painted(scene_from_mapping(room), 0.0).astype(float)
    middle = (clean > 40) & (clean < 215)  # away from the ends of the scale
    assert (noisy - clean)[middle].std() == pytest.approx(4.0, rel=0.05)


def test_a_hand_is_in_view_where_all_of_it_falls_into_the_picture(room):
    room["robot"] = {}
    for y_m, expected in ((0.0, True), (0.9, True), (1.3, False), (-0.6, False)):
        room["people"][1]["path"] = [{"x_m": 1.3, "y_m": y_m}]
        scene = scene_from_mapping(room)
        assert hands_in_view(scene, view_at(scene, 0.0), people_at(scene, 0.0))[1] == expected


def test_nobody_behind_the_camera_is_in_view(room):
    room["people"][1]["path"] = [{"x_m": -1.5, "y_m": 0.0}]
    scene = scene_from_mapping(room)
    assert not hands_in_view(scene, view_at(scene, 0.0), people_at(scene, 0.0))[1]


def test_who_walks_away_shows_the_back(room):
    room["robot"] = {}
    room["people"][0]["path"] = [
        {"at_s": 0.0, "x_m": 2.0, "y_m": 0.0},
        {"at_s": 1.0, "x_m": 3.0, "y_m": 0.0},
        {"at_s": 2.0, "x_m": 2.0, "y_m": 0.0},
    ]
    scene = scene_from_mapping(room)
    assert is_from_behind(view_at(scene, 0.5), people_at(scene, 0.5), 0)
    assert not is_from_behind(view_at(scene, 1.5), people_at(scene, 1.5), 0)


@pytest.mark.parametrize("name", ["restaurant", "dining_hall", "bistro", "lonely"])
def test_every_hand_of_the_projects_scenes_is_in_view_while_it_is_up(name):
    scene = load_scene(name)
    for time_s in np.arange(0.0, scene.duration_s, 0.1):
        people = people_at(scene, time_s)
        in_view = hands_in_view(scene, view_at(scene, time_s), people)
        assert in_view[people.hand_up].all(), f"at {time_s:.1f} s"


def test_exposure_darkens_everything_and_backlight_what_is_behind(room):
    room["robot"], room["tables"] = {}, []
    room["people"] = [{"id": 1, "path": [{"x_m": 2.0, "y_m": 0.0}], "look": {"shirt": "#406080"}}]
    normal = painted(quiet(room), 0.0).astype(float)
    room["backlight"], room["camera"]["exposure"] = 1.5, 0.5
    shown = painted(quiet(room), 0.0).astype(float)
    np.testing.assert_allclose(shown[60, 80], 0.5 * normal[60, 80], atol=1.5)  # the shirt
    np.testing.assert_allclose(shown[30, 10], 0.75 * normal[30, 10], atol=1.5)  # the wall


def test_motion_smears_sideways_alone(room):
    room["camera"]["motion_px"] = 5
    smeared = painted(quiet(room), 0.0).astype(float)
    room["camera"]["motion_px"] = 1
    sharp = painted(quiet(room), 0.0).astype(float)
    mean = sum(sharp[:, 2 + shift : 158 + shift] for shift in (-2, -1, 0, 1, 2)) / 5
    np.testing.assert_allclose(smeared[:, 2:158], mean, atol=1.0)


def test_an_activity_moves_the_hands_and_a_raise_interrupts_it(room):
    room["robot"], room["tables"] = {}, []
    guest = {"id": 1, "path": [{"x_m": 2.0, "y_m": 0.0}]}
    room["people"] = [guest]
    idle = painted(quiet(room), 0.1)
    guest["activities"] = [{"what": "phone", "from_s": 0.0, "until_s": 1.0}]
    busy = quiet(room)
    assert np.any(painted(busy, 0.1) != idle)
    np.testing.assert_array_equal(painted(busy, 1.1), painted(busy, 1.9))
    np.testing.assert_array_equal(painted(busy, 1.1), idle)
    guest["raises"] = [{"from_s": 0.5, "until_s": 1.5}]
    assert people_at(quiet(room), 0.6).doing == (None,)


def test_tempo_hurries_an_activity(room):
    doing = {"what": "talk", "from_s": 0.0, "until_s": 9.0, "tempo": 2.0}
    room["people"] = [{"id": 1, "path": [{"x_m": 2.0, "y_m": 0.0}], "activities": [doing]}]
    assert people_at(scene_from_mapping(room), 0.4).doing == (("talk", 2),)
