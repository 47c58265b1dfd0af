import itertools

import pytest

from tracker.perception.strips import upright_strips


def test_a_picture_of_640_by_480_has_five_strips():
    strips = upright_strips(640, 480)
    assert strips == [(left, 0, 240, 480) for left in (0, 100, 200, 300, 400)]


@pytest.mark.parametrize("size", [(1920, 1080), (641, 479), (300, 300), (241, 480)])
def test_strips_cover_the_picture_and_overlap_by_more_than_half(size):
    width, height = size
    strips = upright_strips(width, height)
    assert strips[0][0] == 0
    assert strips[-1][0] + strips[-1][2] == width
    assert all(strip[3] == height for strip in strips)
    for before, after in itertools.pairwise(strips):
        assert 0 < after[0] - before[0] < before[2] / 2 + 1


@pytest.mark.parametrize("size", [(240, 480), (100, 480), (1, 1)])
def test_a_narrow_picture_is_one_strip(size):
    assert upright_strips(*size) == [(0, 0, *size)]
