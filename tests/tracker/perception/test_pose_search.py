import numpy as np

from tracker.perception.pose_search import (
    INPUT_PX,
    POSE_LAYERS,
    regions_from_alignment,
)
from tracker.perception.single_shot import decode_rows, make_anchors


def rows_of(*people):
    """What the model would answer: one row for each (center, side, score logit)."""
    anchors = np.zeros((len(people), 2))
    boxes = np.zeros((len(people), 12))
    for row, (center, side, _) in zip(boxes, people, strict=True):
        row[:4] = *center, side, side
        row[4:] = np.tile(center, 4)
        row[7] -= side  # the second key point above the first
    return boxes, np.array([logit for *_, logit in people], float), anchors


def test_there_is_an_anchor_for_each_row_of_the_model():
    assert len(make_anchors(INPUT_PX, POSE_LAYERS)) == 2254


def test_rows_below_the_confidence_are_nobody():
    found = decode_rows(*rows_of(((50, 50), 20, 2.0), ((150, 50), 20, -2.0)), 0.5)
    np.testing.assert_allclose(found.keypoints_px[:, :2], [[[50, 50], [50, 30]]])


def test_overlapping_rows_are_one_person_and_the_surest_comes_first():
    found = decode_rows(
        *rows_of(((50, 50), 20, 1.0), ((150, 60), 20, 3.0), ((51, 50), 20, 1.0)), 0.5
    )
    np.testing.assert_allclose(found.keypoints_px[:, 0], [[150, 60], [50.5, 50]])


def test_rows_that_are_not_finite_are_nobody():
    boxes, logits, anchors = rows_of(((50, 50), 20, 2.0))
    boxes[0, 5] = np.nan
    assert len(decode_rows(boxes, logits, anchors, 0.5)) == 0


def test_a_region_is_a_quarter_larger_than_the_circle_around_the_person():
    regions = regions_from_alignment(np.array([[[100.0, 100.0], [140.0, 100.0]]]))
    np.testing.assert_allclose(regions.center_px, [[100, 100]])
    np.testing.assert_allclose(regions.side_px, [100.0])
    np.testing.assert_allclose(regions.rotation_rad, [np.pi / 2])  # lies to the right
