import sys
from types import SimpleNamespace
from typing import ClassVar

import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.errors import ConfigError
from tracker.perception import HandDetector
from tracker.perception.hands.mediapipe_hands import MediapipeHands


class FakeGraph:
    """What mediapipe.solutions.hands.Hands offers: one hand, upright, in the picture's middle."""

    opened: ClassVar[list] = []

    def __init__(self, **settings):
        self.settings = settings
        self.pictures = []
        self.resets = self.closed = 0
        self.label = "Left"
        self.opened.append(self)

    def process(self, rgb):
        self.pictures.append(rgb)
        points = np.full((21, 2), 0.5)
        points[9:13, 1] -= 0.1 * np.array([1.0, 1.4, 1.7, 1.9])
        landmarks = [SimpleNamespace(x=x, y=y, z=0.0) for x, y in points]
        side = SimpleNamespace(label=self.label, score=0.9, index=0)
        if not self.label:
            return SimpleNamespace(multi_hand_landmarks=None, multi_handedness=None)
        return SimpleNamespace(
            multi_hand_landmarks=[SimpleNamespace(landmark=landmarks)],
            multi_handedness=[SimpleNamespace(classification=[side])],
        )

    def reset(self):
        self.resets += 1

    def close(self):
        self.closed += 1


@pytest.fixture
def graphs(monkeypatch):
    FakeGraph.opened = []
    hands = SimpleNamespace(Hands=FakeGraph)
    module = SimpleNamespace(solutions=SimpleNamespace(hands=hands))
    monkeypatch.setitem(sys.modules, "mediapipe", module)
    return FakeGraph.opened


def image(stamp_ns=0, width=640):
    bgr = np.zeros((480, width, 3), np.uint8)
    bgr[..., 0] = 200
    return CameraImage(stamp_ns, "", bgr)


def test_landmarks_come_in_pixels_of_the_full_image_with_the_verdict(graphs):
    detector = MediapipeHands(Config(downscale_factor=2))
    assert isinstance(detector, HandDetector)
    found = detector.find(image())
    np.testing.assert_allclose(found.wrist_px, [[320, 240]])
    assert found.raised.tolist() == [True]
    np.testing.assert_allclose(found.raise_measure, [1.9])


def test_mediapipe_gets_the_shrunk_picture_in_red_green_blue(graphs):
    MediapipeHands(Config(downscale_factor=2)).find(image())
    (picture,) = graphs[0].pictures
    assert picture.shape == (240, 320, 3)
    assert picture[0, 0].tolist() == [0, 0, 200]


@pytest.mark.parametrize(("label", "right"), [("Left", 0.9), ("Right", 0.1)])
def test_its_left_is_a_right_hand_in_a_picture_that_is_not_mirrored(graphs, label, right):
    detector = MediapipeHands(Config())
    graphs[0].label = label
    np.testing.assert_allclose(detector.find(image()).right, [right])


def test_no_hand_is_an_empty_batch(graphs):
    detector = MediapipeHands(Config())
    graphs[0].label = ""
    assert len(detector.find(image())) == 0


def test_it_is_opened_with_the_parameters_of_table_1(graphs):
    MediapipeHands(
        Config(model_complexity=1, max_hands=3, detection_confidence=0.7, tracking_confidence=0.4)
    )
    assert graphs[0].settings == {
        "static_image_mode": False,
        "model_complexity": 1,
        "max_num_hands": 3,
        "min_detection_confidence": 0.7,
        "min_tracking_confidence": 0.4,
    }


def test_it_is_opened_anew_only_when_its_own_parameters_change(graphs):
    detector = MediapipeHands(Config())
    detector.configure(Config(palm_raised_threshold=2.5))
    assert len(graphs) == 1
    assert detector.find(image()).raised.tolist() == [False]
    detector.configure(Config(max_hands=2))
    assert len(graphs) == 2
    assert graphs[0].closed == 1


@pytest.mark.parametrize("jump", [image(1), image(9, width=320)], ids=["time", "size"])
def test_a_jump_starts_anew(graphs, jump):
    detector = MediapipeHands(Config())
    detector.find(image(5))
    detector.find(image(6))
    assert graphs[0].resets == 0
    detector.find(jump)
    assert graphs[0].resets == 1


@pytest.mark.parametrize("module", [None, SimpleNamespace()], ids=["absent", "too new"])
def test_without_mediapipe_the_message_names_the_command(monkeypatch, module):
    monkeypatch.setitem(sys.modules, "mediapipe", module)
    with pytest.raises(ConfigError, match=r"pip install \"mediapipe==0\.10\.21\""):
        MediapipeHands(Config())
