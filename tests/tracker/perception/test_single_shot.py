import numpy as np
import pytest

from tracker.perception.single_shot import (
    POSE_LAYERS,
    Detections,
    SingleShot,
    decode_rows,
    make_anchors,
    merge_rows,
)

# Row 0 of the model belongs to the anchor at (4, 4) px. These offsets put a palm of 19.2 x 9.6 px
# into the middle of the 192 px input, the wrist 9.6 px below it, the middle root 9.6 px above.
MIDDLE = np.zeros(18, np.float32)
MIDDLE[:4] = [92, 92, 19.2, 9.6]
MIDDLE[4:] = 92
MIDDLE[5] += 9.6
MIDDLE[9] -= 9.6


class FakePalmModel:
    """Sees one palm in the middle of whatever it is shown, and keeps what it was shown."""

    def __init__(self, logit=3.0):
        self.logit = logit
        self.seen = None

    def run(self, names, feed):
        assert names == ["boxes", "scores"]
        self.seen = feed["image"]
        boxes, scores = np.zeros((1, 2016, 18), np.float32), np.full((1, 2016, 1), -9, np.float32)
        boxes[0, 0], scores[0, 0] = MIDDLE, self.logit
        return [boxes, scores]


def picture(width=640, height=480):
    return np.full((height, width, 3), 255, np.uint8)


def palms(boxes, score):
    boxes = np.array(boxes, dtype=float)
    keypoints = np.repeat(boxes[:, None, :2], 7, axis=1)
    return Detections(boxes, keypoints, np.array(score, dtype=float))


def test_a_palm_in_the_model_is_a_palm_in_the_image():
    # 640 px are squeezed into 192: 10 / 3 image pixels for one of the input.
    found = SingleShot(FakePalmModel()).find(picture(), 0.6)
    np.testing.assert_allclose(found.boxes_px, [[288, 224, 352, 256]], rtol=1e-6)
    np.testing.assert_allclose(found.keypoints_px[0, 0], [320, 272], rtol=1e-6)
    np.testing.assert_allclose(found.keypoints_px[0, 2], [320, 208], rtol=1e-6)
    np.testing.assert_allclose(found.score, [1 / (1 + np.exp(-3))])


def test_the_model_sees_the_picture_between_black_bars():
    model = FakePalmModel()
    SingleShot(model).find(picture(), 0.6)
    assert model.seen.shape == (1, 192, 192, 3)
    # 480 of 640 rows: (192 - 144) / 2 = 24 rows of black above and below.
    assert (model.seen[0, :23] == 0).all()
    assert (model.seen[0, 25:167, 1:-1] == 1).all()
    assert (model.seen[0, 169:] == 0).all()


def test_a_window_is_searched_alone_and_gives_pixels_of_the_full_image():
    found = SingleShot(FakePalmModel()).find(picture(), 0.6, window=(100, 50, 192, 192))
    np.testing.assert_allclose(found.boxes_px, [[186.4, 141.2, 205.6, 150.8]], rtol=1e-6)


def test_a_window_is_cut_to_the_picture():
    found = SingleShot(FakePalmModel()).find(picture(), 0.6, window=(448, 288, 400, 400))
    np.testing.assert_allclose(found.boxes_px[0, :2], [544 - 9.6, 384 - 4.8], rtol=1e-6)
    outside = SingleShot(FakePalmModel()).find(picture(), 0.6, window=(700, 0, 50, 50))
    assert len(outside) == 0


@pytest.mark.parametrize("shrink", [2, 3, 7, 16])
def test_shrinking_does_not_move_the_palm(shrink):
    found = SingleShot(FakePalmModel()).find(picture(), 0.6, shrink=shrink)
    np.testing.assert_allclose(found.keypoints_px[0, 1], [320, 240], rtol=1e-6)


@pytest.mark.parametrize("size", [(1, 1), (2, 3), (1, 500), (500, 1)])
def test_tiny_pictures_are_searched_without_complaint(size):
    assert len(SingleShot(FakePalmModel()).find(picture(*size), 0.6, shrink=2)) == 1


def test_unsure_rows_are_no_palms():
    # A logit of 0.4 is a score of 0.5987.
    assert len(SingleShot(FakePalmModel(0.4)).find(picture(), 0.6)) == 0
    assert len(SingleShot(FakePalmModel(0.4)).find(picture(), 0.59)) == 1


def test_extreme_logits_stay_scores():
    found = decode_rows(np.tile(MIDDLE, (2, 1)), np.array([1e4, -1e4]), make_anchors(192)[:2], 0.5)
    np.testing.assert_array_equal(found.score, [1.0])


def test_a_row_that_is_not_finite_is_no_palm():
    broken = MIDDLE.copy()
    broken[7] = np.nan
    assert len(decode_rows(broken[None], np.array([5.0]), make_anchors(192)[:1], 0.5)) == 0


def test_overlapping_palms_are_averaged_by_score():
    # Overlap 9 * 10 / (100 + 100 - 90) = 0.82. Weights 0.75 and 0.25.
    merged = merge_rows(palms([[1, 0, 11, 10], [0, 0, 10, 10]], [0.3, 0.9]))
    np.testing.assert_allclose(merged.boxes_px, [[0.25, 0, 10.25, 10]])
    np.testing.assert_allclose(merged.keypoints_px[0, 3], [0.25, 0])
    np.testing.assert_allclose(merged.score, [0.9])


def test_palms_that_overlap_little_stay_apart_and_are_sorted_by_score():
    # Overlap 40 / 160 = 0.25, less than 0.3.
    merged = merge_rows(palms([[6, 0, 16, 10], [0, 0, 10, 10]], [0.7, 0.8]))
    np.testing.assert_allclose(merged.boxes_px, [[0, 0, 10, 10], [6, 0, 16, 10]])


def test_what_was_merged_is_compared_with_the_surest_palm_only():
    # The third overlaps the second (0.43), not the first (0.18): it is a palm of its own.
    merged = merge_rows(palms([[0, 0, 10, 10], [3, 0, 13, 10], [7, 0, 17, 10]], [0.9, 0.8, 0.7]))
    np.testing.assert_allclose(merged.score, [0.9, 0.7])


def test_palms_without_area_end_the_search_too():
    assert len(merge_rows(palms([[5, 5, 5, 5], [5, 5, 5, 5]], [0.9, 0.8]))) == 2
    assert len(merge_rows(Detections.none())) == 0


@pytest.mark.parametrize(("input_px", "count"), [(192, 2016), (160, 1400)])
def test_every_row_of_the_palm_model_has_an_anchor(input_px, count):
    # 192: 24 * 24 * 2 + 12 * 12 * 6; 160: 20 * 20 * 2 + 10 * 10 * 6.
    assert make_anchors(input_px).shape == (count, 2)


def test_anchors_go_row_by_row_through_the_middles_of_the_cells():
    anchors = make_anchors(192)
    fine, coarse = anchors[: 24 * 24 * 2], anchors[24 * 24 * 2 :]
    np.testing.assert_array_equal(fine[:4], [[4, 4], [4, 4], [12, 4], [12, 4]])
    np.testing.assert_array_equal(fine[48], [4, 12])  # 24 cells of two fill the first row
    np.testing.assert_array_equal(fine[-1], [188, 188])
    np.testing.assert_array_equal(coarse[:7], [[8, 8]] * 6 + [[24, 8]])
    np.testing.assert_array_equal(coarse[72], [8, 24])
    np.testing.assert_array_equal(coarse[-1], [184, 184])


def test_other_layers_are_possible():
    np.testing.assert_array_equal(make_anchors(4, ((2, 1),)), [[1, 1], [3, 1], [1, 3], [3, 3]])


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
    assert len(make_anchors(224, POSE_LAYERS)) == 2254


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
