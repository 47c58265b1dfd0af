"""docs/ros.md names every topic, command and service that there is."""

from pathlib import Path

import pytest

from nodes.shared.topics import (
    ENABLE_SERVICE,
    INPUT_TOPICS,
    OUTPUT_TYPES,
    RELEASE_SERVICE,
    RESET_SERVICE,
    Output,
)
from tracker.containers import CallState
from tracker.service import Verb

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
