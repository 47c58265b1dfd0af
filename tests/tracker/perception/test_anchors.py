import numpy as np
import pytest

from tracker.perception.anchors import make_anchors


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
