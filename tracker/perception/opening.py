"""Which detector does the configuration ask for?"""

from __future__ import annotations

from tracker.config import Config
from tracker.perception.bodies.body_look import BodyLook, MediapipeLook
from tracker.perception.bodies.people_watch import PeopleWatch
from tracker.perception.bodies.pose_file import PoseFile
from tracker.perception.call_finder import CallFinder
from tracker.perception.detector import HandDetector
from tracker.perception.hands.hand_finder import HandFinder
from tracker.perception.hands.mediapipe_hands import MediapipeHands
from tracker.perception.models import ModelStore
from tracker.perception.pose_hands import PoseHands


def open_detector(config: Config, store: ModelStore | None = None) -> HandDetector:
    """Open what `detector`, `pose_model` and `pose_opinion` name.

    Args:
        config: Every parameter.
        store: Where the model files live; None takes the default place.

    Raises:
        ModelFileError: A model file is absent, unusable, or of a layout that is not understood.
        ConfigError: mediapipe is not installed, or ONNX Runtime has no such execution provider.
    """
    store = store or ModelStore()
    if config.detector == "pose":
        return PoseHands(_open_look(config, store), config)
    if config.detector == "mediapipe":
        return MediapipeHands(config)
    hands = HandFinder(config, store)
    if config.pose_opinion == "none":
        return CallFinder(hands, None, config)

    def open_watch(config: Config) -> PeopleWatch:
        return PeopleWatch(_open_look(config, store))

    watch = open_watch(config) if config.raise_rule == "evidence" else None
    return CallFinder(hands, watch, config, open_watch)


def _open_look(config: Config, store: ModelStore) -> BodyLook:
    return PoseFile.open(config) if config.pose_model else MediapipeLook.open(store, config)
