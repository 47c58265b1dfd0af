import json

import cv2
import numpy as np
import pytest

from tracker import Config
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
