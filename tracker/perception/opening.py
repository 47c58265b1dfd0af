"""Which detector does the configuration ask for?"""

from __future__ import annotations

from pathlib import Path

from tracker.config import Config
from tracker.perception.body_detector import BodyDetector
from tracker.perception.body_finder import BodyFinder
from tracker.perception.body_look import FileLook, MediapipeLook
from tracker.perception.call_finder import CallFinder
from tracker.perception.detector import HandDetector
from tracker.perception.hand_finder import HandFinder
from tracker.perception.mediapipe_hands import MediapipeHands
from tracker.perception.models import ModelStore
from tracker.perception.people_watch import PeopleWatch
from tracker.perception.pose_file import PoseFileFinder
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
        return PoseHands(_open_bodies(config, store), config)
    if config.detector == "mediapipe":
        return MediapipeHands(config)
    hands = HandFinder(config, store)
    if config.raise_rule != "evidence":
        return hands
    look = FileLook(config) if config.pose_model else MediapipeLook(store, config)
    watch = None if config.pose_opinion == "none" else PeopleWatch(look)
    return CallFinder(hands, watch, config)


def _open_bodies(config: Config, store: ModelStore) -> BodyDetector:
    if config.pose_model:
        return PoseFileFinder.open(Path(config.pose_model), config)
    return BodyFinder.open(config, store)
