"""Which detector does the configuration ask for?"""

from __future__ import annotations

from pathlib import Path

from tracker.config import Config
from tracker.perception.arm_watch import ArmWatch
from tracker.perception.body_detector import BodyDetector
from tracker.perception.body_finder import BodyFinder
from tracker.perception.detector import HandDetector
from tracker.perception.hand_finder import HandFinder
from tracker.perception.mediapipe_hands import MediapipeHands
from tracker.perception.models import ModelStore
from tracker.perception.owner_finder import OwnerFinder, file_look, mediapipe_look
from tracker.perception.pose_file import PoseFileFinder
from tracker.perception.pose_hands import PoseHands
from tracker.perception.second_opinion import SecondOpinion


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
        return PoseHands(_open_bodies(config, store, everyone=True), config)
    if config.detector == "mediapipe":
        return MediapipeHands(config)
    hands = HandFinder(config, store)
    if config.pose_opinion == "none":
        return hands
    if config.pose_opinion == "full":
        return SecondOpinion(hands, _open_bodies(config, store, everyone=False), config)
    look = file_look(config) if config.pose_model else mediapipe_look(store, config)
    return SecondOpinion(hands, OwnerFinder(look), config, ArmWatch(look))


def _open_bodies(config: Config, store: ModelStore, *, everyone: bool) -> BodyDetector:
    if config.pose_model:
        return PoseFileFinder.open(Path(config.pose_model), config, everyone=everyone)
    return BodyFinder.open(config, store, everyone=everyone)
