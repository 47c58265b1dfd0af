import numpy as np
import pytest

from tracker.evaluation.trials.clothes_sensing import draw_clothes, look_at_clothes
from tracker.tracking.appearance import hellinger

UP = np.array([[0, 1], [1, 1], [1, 0], [0, 1], [1, 1]], bool)


def looks(noise, hand_up=UP, seed=2):
    return look_at_clothes(hand_up, noise, np.random.default_rng(seed))


def test_every_look_is_a_histogram():
    seen = looks(0.6)
    assert (seen >= 0.0).all()
    np.testing.assert_allclose(seen.sum(axis=-1), 1.0)


def test_without_noise_everybody_always_looks_the_same():
    seen = looks(0.0)
    np.testing.assert_array_equal(seen, np.broadcast_to(seen[0], seen.shape))
    assert hellinger(seen[0, 0], seen[0, 1]) > 0.1


def test_a_look_stays_while_the_hand_is_up_and_is_another_in_the_next_raise():
    first, again = looks(0.6)[[1, 2, 4], 0], looks(0.6)[[0, 1, 3, 4], 1]
    np.testing.assert_array_equal(first[0], first[1])
    assert hellinger(first[1], first[2]) > 0.0
    np.testing.assert_array_equal(again[[0, 2]], again[[1, 3]])


def test_people_are_as_far_apart_as_in_pictures():
    raises = np.tile([[True], [False]], (2, 500))  # up in every second frame
    seen = looks(0.6, raises)
    same = hellinger(seen[0], seen[2]).mean()
    other = hellinger(seen[0], np.roll(seen[2], 1, axis=0)).mean()
    # Means over the pairs of benchmarks/clothes.py, half rendered guests, half photos.
    assert same == pytest.approx(0.39, abs=0.05)
    assert other == pytest.approx(0.73, abs=0.05)


def test_nobody_wears_nothing():
    assert len(draw_clothes(np.random.default_rng(1), 0)) == 0
