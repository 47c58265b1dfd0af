import json
from dataclasses import replace

import cv2
import numpy as np
import pytest

from tracker import CameraImage, Config
from tracker.dashboard.parameters import changed, live_parameters
from tracker.errors import ConfigError


def test_a_frame_is_json_and_a_jpeg(watched):
    assert watched.dashboard.show() is None
    watched.run(10)
    shown = watched.dashboard.show()
    state = json.loads(json.dumps(shown.state))
    (anna,) = state["callers"]
    assert (anna["id"], anna["state"], anna["up"], anna["selected"]) == (1, "waiting", True, True)
    assert anna["called_s"] == pytest.approx(0.8)
    (person,) = state["people"]
    assert len(person["trail"]) == 9
    assert person["ellipse"][0] >= person["ellipse"][1] > 0.0
    assert {item["kind"] for item in state["timeline"]} == {"up", "waiting"}
    picture = cv2.imdecode(np.frombuffer(shown.jpeg, np.uint8), cv2.IMREAD_COLOR)
    assert picture.shape == (480, 640, 3)


def test_the_map_has_a_number_and_a_place_and_its_picture_is_asked_for(watched):
    watched.run(1)
    assert "map" not in watched.dashboard.show().state
    assert watched.dashboard.map_png() is None
    watched.mount()
    watched.run(2)
    first = watched.dashboard.show().state["map"]
    assert first == {"number": 1, "origin": [0.0, -1.5, 0.0], "pixel_m": pytest.approx(0.1)}
    assert watched.dashboard.map_png()[:4] == b"\x89PNG"
    watched.mount()
    watched.run(1)
    assert watched.dashboard.show().state["map"]["number"] == 2


@pytest.mark.parametrize(("std_m", "is_fan"), [(0.3, False), (2.0, True)])
def test_who_is_known_by_direction_alone_is_a_fan(watched, std_m, is_fan):
    watched.mount()
    watched.run(8)
    image = CameraImage(10**12 + 800_000_000, "", np.zeros((480, 640, 3), np.uint8))
    result = watched.pipeline.process(image)
    spread = np.diag([std_m**2, 0.01, 1.0, 1.0])[None]
    ahead = replace(result.tracks, mean=np.array([[3.5, 0.0, 0.0, 0.0]]), covariance=spread)
    watched.dashboard.watch(image, replace(result, tracks=ahead), 0.02)
    (person,) = watched.dashboard.show().state["people"]
    half_rad = 2 * np.arctan2(0.1, 3.0)  # the camera stands at x = .5 m
    expected = pytest.approx([-half_rad, half_rad], abs=1e-3) if is_fan else None
    assert person.get("fan") == expected


def test_a_frame_is_drawn_once_for_all_browsers(watched):
    watched.run(3)
    assert watched.dashboard.show() is watched.dashboard.show()


def test_buttons_and_sliders_are_followed_before_the_next_frame(watched):
    watched.run(8)
    watched.dashboard.ask({"do": "serve 1"})
    watched.dashboard.ask({"set": ["selection", "nearest"]})
    watched.dashboard.ask({"set": ["pose_max_age_s", -1]})
    watched.dashboard.ask({"do": "dance"})
    watched.run(2)
    state = watched.dashboard.show().state
    assert state["callers"][0]["state"] == "being_served"
    assert watched.pipeline.config.selection == "nearest"
    assert state["said"][0] == "customer 1 is being served"
    assert "`pose_max_age_s` is -1" in state["said"][2]
    assert "is not a command" in state["said"][3]


def test_a_page_that_only_shows_changes_nothing(make_watched):
    watched = make_watched(can_steer=False)
    watched.run(8)
    watched.dashboard.ask({"do": "serve 1"})
    watched.run(1)
    assert watched.dashboard.show().state["callers"][0]["state"] == "waiting"
    assert watched.dashboard.parameters() == []


def test_requests_that_make_no_sense_are_left_out(watched):
    for request in ({}, {"set": "x"}, {"set": [1]}, {"other": 1}):
        watched.dashboard.ask(request)
    watched.run(1)
    assert watched.dashboard.show().state["said"] == []


def test_health_says_what_is_missing(watched):
    watched.run(5)
    lines = {line["name"]: line for line in watched.dashboard.show().state["health"]}
    assert lines["camera"]["level"] == "ok"
    assert lines["laser"]["words"] == "no scan is used: directions without distances"
    assert lines["transforms"]["level"] == "warn"


def test_every_live_parameter_is_described_and_fixed_ones_cannot_change():
    described = {item["name"]: item for item in live_parameters(Config())}
    assert described["processing_rate"]["max"] == 240.0
    assert described["selection"]["choices"] == ["first", "nearest", "newest"]
    assert "model_complexity" not in described
    with pytest.raises(ConfigError, match="cannot change now"):
        changed(Config(), "model_complexity", 1)
    with pytest.raises(ConfigError, match="unknown parameter"):
        changed(Config(), "nonsense", 1)
