import cv2
import numpy as np
import pytest

from tracker.config import Config
from tracker.containers import CameraImage
from tracker.perception.hands.following import HandFollower
from tracker.perception.hands.gray import is_gray, tint_gray
from tracker.perception.hands.landmarks import Landmarks
from tracker.perception.single_shot import Detections

SHADES = np.tile(np.arange(0, 240, dtype=np.uint8)[:, None, None], (1, 160, 3))


def colored(bgr=(90, 120, 180)):
    return np.full((240, 160, 3), bgr, np.uint8)


def test_a_colored_picture_is_left_as_it_is():
    picture = colored()
    assert tint_gray(picture) is picture


def test_one_colored_thing_makes_a_picture_colored():
    picture = SHADES.copy()
    picture[96:160, 40:80] = (60, 90, 200)
    assert not is_gray(picture)


@pytest.mark.parametrize("quality", [95, 60], ids=["fine JPEG", "coarse JPEG"])
def test_a_gray_picture_is_gray_after_jpeg_in_color_as_well(quality):
    noise = np.random.default_rng(4).normal(0.0, 8.0, SHADES.shape[:2])[..., None]
    noisy = np.clip(SHADES + noise, 0, 255).astype(np.uint8)
    _, data = cv2.imencode(".jpg", noisy, [cv2.IMWRITE_JPEG_QUALITY, quality])
    assert is_gray(cv2.imdecode(data, cv2.IMREAD_COLOR))


def test_a_gray_picture_becomes_rosy_and_about_as_bright():
    tinted = tint_gray(SHADES)
    assert (tinted[100] == tinted[100, 0]).all()
    blue, green, red = tinted[100, 0].astype(int)
    assert red > blue > green
    luminance = cv2.cvtColor(tinted, cv2.COLOR_BGR2GRAY)[:170, 0].astype(int)
    np.testing.assert_allclose(luminance, np.arange(170), atol=0.05 * 170)


class Watched:
    """Finds one palm; keeps the pictures it was shown."""

    def __init__(self):
        self.searched, self.read = [], []

    def find(self, bgr, confidence, *, window=None, shrink=1):
        self.searched.append(bgr)
        return Detections.none()

    def read_beside(self, bgr, regions, calls):
        self.read.append(bgr)
        count = len(regions)
        hands = Landmarks(np.zeros((count, 21, 2)), np.zeros(count), np.zeros(count))
        return hands, [call() for call in calls]


def test_palms_are_searched_in_the_tinted_picture_and_landmarks_read_in_the_gray_one():
    models = Watched()
    HandFollower(models, models, models).step(CameraImage(0, "", SHADES), Config())
    assert all(not is_gray(picture) for picture in models.searched)
    assert models.searched
    assert all(is_gray(picture) for picture in models.read)
