import numpy as np
import pytest

from tracker.perception.hands.clearing import GAIN_MAX, LIGHT, PictureClearer, measure_noise

SIZE = (120, 160)


def wall(level=150.0, noise_std=0.0, seed=0):
    """A wall that is lighter on one side, as a camera with noise sees it."""
    slope = np.linspace(0.9, 1.0, SIZE[1])[None, :, None] * level
    noise = np.random.default_rng(seed).normal(0.0, noise_std, (*SIZE, 3))
    return np.clip(np.round(slope + noise), 0, 255).astype(np.uint8)


def test_a_clear_picture_is_left_alone():
    clearer = PictureClearer()
    for seed in range(3):
        picture = wall(noise_std=1.5, seed=seed)
        assert clearer.clear(picture) is picture


@pytest.mark.parametrize("noise_std", [2.0, 5.0, 10.0])
def test_noise_is_measured_on_a_slope(noise_std):
    measured = measure_noise(wall(noise_std=noise_std)[:, :, 1])
    # The median of 1,200 values is within 5 % of its own in all but one of a hundred cases.
    assert measured == pytest.approx(noise_std, rel=0.1)


def test_edges_are_no_noise():
    picture = np.zeros(SIZE, np.uint8)
    picture[:, ::20] = 255
    assert measure_noise(picture) == 0.0


def test_the_noise_of_what_stays_still_is_averaged_away():
    clearer = PictureClearer()
    for seed in range(20):
        cleared = clearer.clear(wall(noise_std=10.0, seed=seed))
    off = cleared - wall().astype(float)
    # Weights of 1/4, 3/16, 9/64 and so on leave sqrt(1/7) of the noise; some count as moved.
    assert 0.3 * 10.0 < off.std() < 0.5 * 10.0


def test_what_moves_is_seen_where_it_is_now():
    clearer = PictureClearer()
    for seed in range(10):
        clearer.clear(wall(noise_std=10.0, seed=seed))
    picture = wall(noise_std=10.0, seed=99)
    picture[40:80, 60:100] = 20
    cleared = clearer.clear(picture)
    np.testing.assert_array_equal(cleared[44:76, 64:96], 20)
    gone = clearer.clear(wall(noise_std=10.0, seed=100))
    assert gone[44:76, 64:96].mean() > 120.0


def test_a_dark_picture_is_brightened_up_to_a_limit():
    cleared = PictureClearer().clear(wall(level=80.0))
    assert np.percentile(cleared, 98.0) == pytest.approx(LIGHT, abs=3.0)
    black = PictureClearer().clear(wall(level=10.0))
    assert black.max() == pytest.approx(10.0 * GAIN_MAX)


def test_a_dark_picture_with_a_bright_window_keeps_its_light():
    picture = wall(level=80.0)
    picture[:40] = 240
    assert PictureClearer().clear(picture) is picture


@pytest.mark.parametrize("change", ["reset", "size"])
def test_nothing_of_earlier_pictures_is_left_after(change):
    clearer = PictureClearer()
    clearer.clear(wall(noise_std=10.0, seed=1))
    picture = wall(noise_std=10.0, seed=2)
    if change == "reset":
        clearer.reset()
    else:
        picture = np.ascontiguousarray(picture[:, :100])
    np.testing.assert_array_equal(clearer.clear(picture), picture)


@pytest.mark.parametrize("shape", [(1, 1, 3), (2, 3, 3)])
def test_tiny_pictures_pass(shape):
    picture = np.full(shape, 200, np.uint8)
    assert PictureClearer().clear(picture) is picture
