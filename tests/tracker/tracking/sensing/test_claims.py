"""Measurements as the loops take them."""

from dataclasses import replace

import numpy as np
import pytest

from tracker import Measurements
from tracker.tracking.sensing.claims import Claims, claims_of


@pytest.fixture
def measured():
    """A raised bearing, a lowered one, a raised bearing with a range, and a position."""
    return Measurements.concatenate(
        Measurements.bearings([0.1, 0.2], 0.05, raised=[True, False], hand=[0, 1]),
        Measurements.polar(0.3, 2.0, 0.05, 0.1, (1.0, 2.0, 3.0), person=4, identity=7),
        Measurements.cartesian([1.0, 2.0], np.eye(2), raised=False),
    )


def test_claims_are_the_arrays_of_the_measurements(measured):
    claims = claims_of(measured)
    assert claims.values is measured.values
    assert claims.noise is measured.covariance
    assert claims.kind.tolist() == measured.kind.tolist()
    assert claims.pose is measured.sensor_pose
    assert claims.body.tolist() == [-1, -1, 4, -1]
    assert claims.hand.tolist() == [0, 1, -1, -1]
    assert claims.tag.tolist() == [-1, -1, 7, -1]
    assert claims.bias.tolist() == np.zeros((4, 2, 2)).tolist()


def test_however_arrays_lie_in_memory_claims_are_read_only_and_row_by_row(measured):
    broad = np.broadcast_to(np.diag([0.1, 0.1, 0.01]), (4, 3, 3))
    measured = replace(
        measured,
        values=np.asfortranarray(measured.values),
        covariance=np.asfortranarray(measured.covariance),
        raised=np.repeat(measured.raised, 2)[::2],
        sensor_pose_covariance=broad,
    )
    claims = claims_of(measured)
    for name, each in zip(Claims._fields, claims, strict=True):
        assert each.flags.c_contiguous, name
        assert not each.flags.writeable, name
    assert (claims.doubt == broad).all()
    assert (claims.values[:2] == measured.values[:2])[:, 0].all()
