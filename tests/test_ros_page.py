"""docs/ros.md names every topic, command and service that there is."""

import re
from pathlib import Path

import numpy as np
import pytest

from nodes.shared.topics import (
    ENABLE_SERVICE,
    INPUT_TOPICS,
    OUTPUT_TYPES,
    RELEASE_SERVICE,
    RESET_SERVICE,
    Output,
)
from tracker import Config, Tracks
from tracker.containers import CallState
from tracker.gesture import Gesture
from tracker.messages import encode_tracks, encode_waiting_list
from tracker.messages.types import deserialize
from tracker.service import CallKeeper, Verb

PAGE = (Path(__file__).parents[1] / "docs/ros.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("output", list(Output), ids=lambda output: output.name)
def test_every_output_stands_there_with_its_type(output):
    package, _, kind = OUTPUT_TYPES[output].split("/")
    assert f"| `{output.value}` | {package}/{kind} |" in PAGE


def test_every_input_and_service_stands_there():
    for topic in INPUT_TOPICS.values():
        assert f"`{topic.name}`" in PAGE
    for name, _ in (RELEASE_SERVICE, ENABLE_SERVICE, RESET_SERVICE):
        assert f"| `{name}` |" in PAGE


def test_every_command_and_state_stands_there():
    for verb in Verb:
        assert f"| `{verb.value}" in PAGE
    for state in CallState:
        assert f"`{state.value}`" in PAGE


def test_every_class_of_tracks_and_waiting_list_stands_there():
    everything = wire_words()
    for word in everything:
        assert re.search(rf"`{word.partition('/')[0]}[`/]", PAGE), word


def wire_words():
    """The classes under which a person with a raised hand that waves is said."""
    one = np.ones(1)
    tracks = Tracks(
        stamp_ns=10**9, id=[7], mean=np.zeros((1, 4)), covariance=np.eye(4)[None], existence=one,
        confirmed=[True], raised=[True], raised_since_ns=[10**9], age_s=one, unseen_s=one,
        hand=[-1], gesture=[Gesture.WAVE], selected_id=7,
    )  # fmt: skip
    keeper = CallKeeper(Config())
    calls = keeper.step(tracks, np.array([-1.0, 0.0]))
    said = [
        encode_tracks(tracks, frame_id="map"),
        encode_waiting_list(
            calls, frame_id="map", robot_xy_m=np.array([-1.0, 0.0]), approach_distance_m=0.8
        ),
    ]
    return {
        result.hypothesis.class_id
        for message in said
        for person in deserialize(*message).detections
        for result in person.results
    }
