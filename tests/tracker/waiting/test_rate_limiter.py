import numpy as np
import pytest

from tracker.waiting.rate_limiter import RateLimiter


def mean_rate(rate_hz, stamps_ns):
    limiter = RateLimiter(rate_hz)
    admitted = [stamp for stamp in stamps_ns if limiter.admits(int(stamp))]
    return (len(admitted) - 1) / (admitted[-1] - admitted[0]) * 1e9


@pytest.mark.parametrize("rate_hz", [10.0, 8.0, 7.3, 15.0, 30.0])
def test_a_stream_of_30_images_a_second_is_processed_at_the_rate_asked_for(rate_hz):
    stamps = np.arange(3000) * 1e9 / 30
    assert mean_rate(rate_hz, stamps) == pytest.approx(rate_hz, rel=0.01)


def test_jittering_stamps_do_not_lower_the_rate():
    rng = np.random.default_rng(4)
    stamps = np.arange(3000) * 1e9 / 30 + rng.uniform(-3e6, 3e6, 3000)
    assert mean_rate(10.0, stamps) == pytest.approx(10.0, rel=0.01)


def test_a_slower_stream_is_processed_whole():
    limiter = RateLimiter(10.0)
    assert all(limiter.admits(int(stamp)) for stamp in np.arange(50) * 2e8)


def test_a_pause_in_the_stream_is_not_caught_up():
    limiter = RateLimiter(10.0)
    limiter.admits(0)
    stamps = 5_000_000_000 + np.arange(4) * 10_000_000
    assert [limiter.admits(int(stamp)) for stamp in stamps] == [True, False, False, False]


def test_a_clock_that_jumps_back_does_not_freeze_the_stream():
    limiter = RateLimiter(10.0)
    limiter.admits(10**12)
    assert limiter.admits(5)
    assert not limiter.admits(6)
    assert limiter.admits(100_000_005)
