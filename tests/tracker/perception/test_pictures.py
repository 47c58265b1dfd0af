import itertools

import cv2
import numpy as np
import pytest

from tracker.perception.pictures import cut_out, shrink_picture, upright_strips

IDENTITY = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


def test_factor_1_leaves_the_picture_alone():
    picture = np.zeros((3, 5, 3), np.uint8)
    assert shrink_picture(picture, 1) is picture


def test_shrinking_averages_whole_blocks():
    picture = np.zeros((2, 4, 3), np.uint8)
    picture[:, :2] = [[[40], [80]], [[120], [160]]]
    np.testing.assert_array_equal(shrink_picture(picture, 2)[..., 0], [[100, 0]])


@pytest.mark.parametrize("shape", [(1, 1), (1, 7), (2, 3)])
def test_a_tiny_picture_keeps_at_least_one_pixel(shape):
    small = shrink_picture(np.full((*shape, 3), 9, np.uint8), 16)
    assert small.shape == (1, 1, 3)
    assert (small == 9).all()


def test_a_cut_is_rgb_between_0_and_1():
    blue = np.zeros((4, 4, 3), np.uint8)
    blue[..., 0] = 255
    cut = cut_out(blue, IDENTITY, 4, cv2.BORDER_CONSTANT)
    assert cut.shape == (1, 4, 4, 3)
    assert cut.dtype == np.float32
    np.testing.assert_allclose(cut, np.broadcast_to([0.0, 0.0, 1.0], (1, 4, 4, 3)))


def test_a_cut_follows_the_map_and_fills_the_outside_as_told():
    picture = np.arange(0, 48, 3, dtype=np.uint8).reshape(4, 4)[..., None].repeat(3, axis=-1)
    moved = np.array([[1.0, 0.0, 2.0], [0.0, 1.0, 1.0]])  # input (0, 0) is picture (2, 1)
    black = cut_out(picture, moved, 4, cv2.BORDER_CONSTANT)[0, ..., 0] * 255
    edge = cut_out(picture, moved, 4, cv2.BORDER_REPLICATE)[0, ..., 0] * 255
    np.testing.assert_allclose(black[0], [18, 21, 0, 0], atol=1e-4)
    np.testing.assert_allclose(edge[0], [18, 21, 21, 21], atol=1e-4)
    np.testing.assert_allclose(edge[3], [42, 45, 45, 45], atol=1e-4)


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
