import numpy as np
import pytest

from tracker.perception.hands.landmarks import LandmarkReader
from tracker.perception.regions import Regions


class FakeLandmarkModel:
    """Puts every landmark at a corner, the middle, or the brightest pixel of its input."""

    def __init__(self, point=None):
        self.point = point

    def run(self, names, feed):
        assert names == ["landmarks", "presence", "handedness"]
        image = feed["image"]
        assert image.shape == (1, 224, 224, 3)
        point = self.point
        if point is None:
            row, column = np.unravel_index(image[0, ..., 0].argmax(), (224, 224))
            point = (column, row)
        landmarks = np.tile([*point, 0.0], 21).astype(np.float32)[None]
        return [landmarks, image.mean().reshape(1, 1), np.full((1, 1), 0.25, np.float32)]


def region(center, side, rotation_rad=0.0):
    return Regions(np.array([center], float), np.array([side], float), np.array([rotation_rad]))


def reader(point=None, threads=1):
    model = FakeLandmarkModel(point)
    whole = LandmarkReader(model, model, threads)
    return lambda picture, regions: whole.read_beside(picture, regions, ())[0]


@pytest.mark.parametrize(
    ("rotation", "corner"),
    [(0.0, (50, 150)), (np.pi / 2, (150, 150)), (np.pi, (150, 250)), (-np.pi / 2, (50, 250))],
    ids=["upright", "right", "down", "left"],
)
def test_the_upper_left_corner_of_the_input_turns_with_the_region(rotation, corner):
    found = reader((0, 0))(np.zeros((400, 400, 3), np.uint8), region((100, 200), 100, rotation))
    np.testing.assert_allclose(found.points_px[0], [corner] * 21, atol=1e-4)


def test_the_middle_of_the_input_is_the_middle_of_the_region():
    found = reader((112, 112))(np.zeros((9, 9, 3), np.uint8), region((3, 4), 77, 0.3))
    np.testing.assert_allclose(found.points_px[0, 7], [3, 4], atol=1e-5)


@pytest.mark.parametrize("rotation", [0.0, 0.6, -2.5])
def test_a_bright_spot_is_found_where_it_is(rotation):
    picture = np.zeros((480, 640, 3), np.uint8)
    picture[298:303, 418:423] = 60
    picture[300, 420] = 255
    found = reader()(picture, region((400, 310), 150, rotation))
    np.testing.assert_allclose(found.points_px[0, 0], [420, 300], atol=0.75)


def test_what_lies_outside_repeats_the_edge_of_the_picture():
    found = reader((0, 0))(np.full((20, 20, 3), 255, np.uint8), region((0, 0), 200))
    assert found.score[0] == pytest.approx(1.0)  # the fake's score is the mean brightness


def test_several_hands_side_by_side_keep_their_order():
    regions = Regions(np.array([[10.0, 20], [30, 40], [50, 60]]), np.full(3, 10.0), np.zeros(3))
    one_by_one = reader((112, 112))(np.zeros((90, 90, 3), np.uint8), regions)
    abreast = reader((112, 112), threads=2)(np.zeros((90, 90, 3), np.uint8), regions)
    np.testing.assert_allclose(abreast.points_px[:, 0], regions.center_px, atol=1e-5)
    np.testing.assert_array_equal(abreast.points_px, one_by_one.points_px)
    np.testing.assert_array_equal(abreast.right, [0.25] * 3)


@pytest.mark.parametrize("threads", [1, 2])
def test_no_regions_give_no_hands(threads):
    found = reader((0, 0), threads)(np.zeros((9, 9, 3), np.uint8), Regions.none())
    assert found.points_px.shape == (0, 21, 2)
    assert len(found) == 0
