"""What the tests of the evaluation share: random sets of points, and Stone Soup as the oracle."""

from datetime import datetime, timedelta

import numpy as np
import pytest

START = datetime(2026, 1, 1)  # noqa: DTZ001 (Stone Soup's stamps are naive)


@pytest.fixture
def stonesoup():
    return pytest.importorskip("stonesoup", reason="Stone Soup is not installed")


@pytest.fixture
def at():
    """Stone Soup's stamp of a second."""
    return lambda seconds: START + timedelta(seconds=float(seconds))


@pytest.fixture
def random_sets():
    """Pairs of point sets of all small sizes, some points near, some far."""
    rng = np.random.default_rng(5)

    def near_or_far(count):
        return rng.uniform(-1.5, 1.5, (count, 2)) * rng.choice([0.3, 1.0, 3.0])

    return [(near_or_far(n), near_or_far(p)) for n in range(6) for p in range(6) for _ in range(5)]
