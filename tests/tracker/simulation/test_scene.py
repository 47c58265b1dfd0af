import re
from pathlib import Path

import pytest

from tracker.errors import SceneError
from tracker.simulation import load_scene, scene_from_mapping, scene_names


@pytest.mark.parametrize("name", ["restaurant", "dining_hall", "bistro", "lonely"])
def test_the_scenes_of_the_project_are_found_by_name(name):
    assert name in scene_names()
    assert load_scene(name).people


def test_the_restaurant_has_two_hands_up_at_once_and_somebody_who_raises_twice():
    people = load_scene("restaurant").people
    assert len(people) == 3
    spans = [(person.id, each.from_s, each.until_s) for person in people for each in person.raises]
    overlaps = [
        min(end, other_end) - max(start, other_start)
        for one, start, end in spans
        for other, other_start, other_end in spans
        if one < other
    ]
    assert max(overlaps) >= 2.0
    pauses = [
        later.from_s - earlier.until_s
        for person in people
        for earlier, later in zip(person.raises[:-1], person.raises[1:], strict=True)
    ]
    assert max(pauses) >= 3.0


def test_a_file_of_ones_own_is_read(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("duration_s: 3\npeople:\n  - {id: 1, path: [{x_m: 1, y_m: 0}]}\n")
    assert load_scene(path).duration_s == 3.0
    assert load_scene(str(path)).people[0].path[0].x_m == 1.0


def test_an_unknown_name_is_answered_with_the_known_ones():
    with pytest.raises(
        SceneError, match=r"'pizzeria'; there are bistro, dining_hall, lonely, restaurant"
    ):
        load_scene("pizzeria")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"duraton_s": 3.0}, r"unknown key `duraton_s`; did you mean `duration_s`\?"),
        ({"duration_s": -1.0}, r"`duration_s` is -1.0; allowed is greater than 0"),
        ({"duration_s": "long"}, r"`duration_s` is 'long'; allowed is a valid number"),
        ({"duration_s": float("nan")}, r"`duration_s` is nan; allowed is a finite number"),
        ({"floor": "brown"}, r"`floor` is 'brown'; allowed is a color like '#d6a078'"),
        ({"laser": {"range_max_m": 0.1}}, r"laser.range_max_m is 0.1; allowed is above"),
        ({"camera": {"frame": "eye"}}, r"`camera.frame` is 'eye'; allowed is 'camera_link' or"),
    ],
    ids=["misspelled", "negative", "text", "nan", "color", "range", "frame"],
)
def test_a_bad_value_is_named_with_what_is_allowed(room, change, words):
    with pytest.raises(SceneError, match=words):
        scene_from_mapping({**room, **change})


@pytest.mark.parametrize(
    ("poster", "words"),
    [
        ({"piece": 1, "at_m": 1.0}, r"walls.0: posters: piece is 1; this wall has the pieces 0"),
        ({"at_m": 0.2}, r"posters: at_m is 0.2; allowed is 0.3 to 1.7 on piece 0"),
        ({"at_m": 1.0, "shows": "cat"}, r"`walls.0.posters.0.shows` is 'cat'; allowed is 'menu'"),
    ],
    ids=["piece", "place", "content"],
)
def test_a_poster_that_hangs_nowhere_is_refused(room, poster, words):
    room["walls"] = [{"corners_m": [[0.0, 0.0], [2.0, 0.0]], "posters": [poster]}]
    with pytest.raises(SceneError, match=words):
        scene_from_mapping(room)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"hnd": "left"}, r"unknown key `people.0.hnd`; did you mean `hand`\?"),
        ({"hand": "both"}, r"`people.0.hand` is 'both'; allowed is 'left' or 'right'"),
        ({"id": 9}, r"people: the id 9 occurs twice"),
        ({"seat_m": 0.5}, r"people.0: path has 2 places, but seat_m is 0.5"),
        ({"path": []}, r"`people.0.path` is \[\]; allowed is"),
        (
            {"path": [{"at_s": 1, "x_m": 0, "y_m": 0}, {"at_s": 1, "x_m": 1, "y_m": 0}]},
            r"path: at_s is 1.0 after 1.0; times must grow",
        ),
        ({"raises": [{"from_s": 2.0, "until_s": 1.0}]}, r"raises: .* is 1.0 after 2.0"),
        (
            {"raises": [{"from_s": 0, "until_s": 1}, {"from_s": 1.5, "until_s": 2}]},
            r"up until 1.0 and again from 1.5; at least 0.8 s must lie between",
        ),
    ],
    ids=["misspelled", "choice", "twice", "sits", "empty", "times", "raise", "pause"],
)
def test_an_impossible_person_is_refused(room, change, words):
    room["people"][0].update(change)
    with pytest.raises(SceneError, match=words):
        scene_from_mapping(room)


def test_a_missing_key_is_named(room):
    del room["duration_s"]
    with pytest.raises(SceneError, match="`duration_s` is missing"):
        scene_from_mapping(room)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"a: [1\nb: 2\n", "is not YAML at line 2"),
        (b"- 1\n", "contains no scene"),
        (b"\xff\xfe\x00", "is not UTF-8"),
        (b"duration_s: 2024-99-99\n", "`duration_s` is '2024-99-99'"),
    ],
    ids=["syntax", "list", "binary", "date"],
)
def test_a_file_that_is_no_scene_is_refused_by_name(tmp_path, content, words):
    path = tmp_path / "odd.yaml"
    path.write_bytes(content)
    with pytest.raises(SceneError, match=re.escape(str(path))) as caught:
        load_scene(path)
    assert words in str(caught.value)


def test_a_missing_file_is_refused():
    with pytest.raises(SceneError, match="cannot be read"):
        load_scene(Path("nowhere.yaml"))
