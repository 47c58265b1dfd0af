from types import SimpleNamespace

import numpy as np
import pytest

from tracker.replay.outputs import _reach_m


@pytest.mark.parametrize(
    ("customers_x_m", "reach_m"),
    [((), 4.0), ((1.5, 2.0), 4.0), ((1.5, 5.0), 6.0), ((7.0,), 8.0), ((40.0,), 8.0)],
    ids=["nobody", "near", "far", "farther", "out of sight"],
)
def test_the_picture_from_above_reaches_as_far_as_customers_stand(customers_x_m, reach_m):
    count = len(customers_x_m)
    mean = np.zeros((count + 1, 4))
    mean[:, 0] = 1.0 + np.array([*customers_x_m, 90.0])  # the last one is not confirmed
    tracks = SimpleNamespace(mean=mean, confirmed=np.arange(count + 1) < count)
    result = SimpleNamespace(tracks=tracks, sensor_pose=np.array([1.0, 0.0, 0.5]))
    assert _reach_m(result) == reach_m
    assert _reach_m(SimpleNamespace(tracks=tracks, sensor_pose=None)) == 4.0
