from nodes.shared.qos import PROFILES
from nodes.shared.topics import (
    DEPTH_TOPICS,
    IMAGE_TOPICS,
    INPUT_TOPICS,
    OUTPUT_TYPES,
    Input,
    Output,
)
from tracker.messages import definition


def test_every_topic_has_a_profile_with_its_reason_and_a_bounded_depth():
    assert set(PROFILES) == {*Input, *Output}
    for profile in PROFILES.values():
        assert profile.reason.endswith(".")
        assert 1 <= profile.depth <= 100


def test_sensors_are_heard_best_effort_and_the_state_is_latched():
    for item in (Input.IMAGES, Input.SCAN, Input.CAMERA_INFO):
        assert not PROFILES[item].reliable
    latched = {item for item, profile in PROFILES.items() if profile.transient_local}
    states = {Output.HAND_RAISED, Output.RAISED_HANDS, Output.WAITING_LIST}
    assert latched == {*states, Input.STATIC_TRANSFORMS, Input.MAP}
    assert PROFILES[Output.HAND_RAISED].depth == 1


def test_every_topic_has_a_type_that_is_spoken():
    topics = [IMAGE_TOPICS, DEPTH_TOPICS, INPUT_TOPICS]
    kinds = [topic.type_name for named in topics for topic in named.values()]
    for kind in [*kinds, *OUTPUT_TYPES.values()]:
        assert definition(kind)
    assert set(INPUT_TOPICS) == set(Input) - {Input.IMAGES, Input.DEPTH}
    assert set(OUTPUT_TYPES) == set(Output)
