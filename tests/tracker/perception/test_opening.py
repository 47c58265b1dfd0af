import sys
from types import SimpleNamespace

import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.errors import ConfigError, ModelFileError
from tracker.perception import HandDetector, open_detector
from tracker.perception.call_finder import CallFinder
from tracker.perception.hands.mediapipe_hands import MediapipeHands
from tracker.perception.models import ModelStore
from tracker.perception.pose_hands import PoseHands
from tracker.pipeline import Pipeline


@pytest.mark.model
@pytest.mark.parametrize(
    ("parameters", "kind"),
    [
        ({}, CallFinder),
        ({"pose_opinion": "none"}, CallFinder),
        ({"raise_rule": "palm"}, CallFinder),
        ({"raise_rule": "image"}, CallFinder),
        ({"detector": "pose"}, PoseHands),
    ],
)
def test_the_parameters_name_the_detector(model_store, parameters, kind):
    detector = open_detector(Config().replace(**parameters), model_store)
    assert type(detector) is kind
    assert isinstance(detector, HandDetector)
    empty = CameraImage(0, "", np.full((480, 640, 3), 128, np.uint8))
    assert len(detector.find(empty)) == 0


def test_mediapipe_is_opened_without_model_files(monkeypatch, tmp_path):
    hands = SimpleNamespace(Hands=lambda **settings: None)
    module = SimpleNamespace(solutions=SimpleNamespace(hands=hands))
    monkeypatch.setitem(sys.modules, "mediapipe", module)
    detector = open_detector(Config(detector="mediapipe"), ModelStore(tmp_path))
    assert isinstance(detector, MediapipeHands)


@pytest.mark.parametrize("detector", ["hands", "pose"])
def test_absent_model_files_are_an_error(tmp_path, detector):
    with pytest.raises(ModelFileError, match="models fetch"):
        open_detector(Config(detector=detector), ModelStore(tmp_path))


def test_a_model_of_ones_own_needs_no_model_files(tmp_path):
    config = Config(detector="pose", pose_model=str(tmp_path / "mine.onnx"))
    with pytest.raises(ModelFileError, match=r"mine\.onnx"):
        open_detector(config, ModelStore(tmp_path))


def test_the_pipeline_opens_what_the_configuration_names(monkeypatch):
    monkeypatch.setitem(sys.modules, "mediapipe", None)
    with pytest.raises(ConfigError, match="pip install"):
        Pipeline(Config(detector="mediapipe"))
