"""Measurements as the loops take them."""

from dataclasses import replace

import numpy as np
import pytest

from tracker import Config, Measurements
from tracker.tracking.claims import Claims, claims_of


@pytest.fixture
def measured():
    """A raised bearing, a lowered one, a raised bearing with a range, and a position."""
    return Measurements.concatenate(
        Measurements.bearings([0.1, 0.2], 0.05, raised=[True, False], hand=[0, 1]),
        Measurements.polar(0.3, 2.0, 0.05, 0.1, (1.0, 2.0, 3.0), person=4, identity=7),
        Measurements.cartesian([1.0, 2.0], np.eye(2), raised=False),
    )


def test_claims_are_the_arrays_of_the_measurements(measured):
    claims = claims_of(measured, 0.1, Config(hand_bias_duration_s=0.0))
    assert claims.values is measured.values
    assert claims.noise is measured.covariance
    assert claims.kind.tolist() == measured.kind.tolist()
    assert claims.pose is measured.sensor_pose
    assert claims.body.tolist() == [-1, -1, 4, -1]
    assert claims.hand.tolist() == [0, 1, -1, -1]
    assert claims.tag.tolist() == [-1, -1, 7, -1]


def test_a_bias_that_lasts_widens_bearings_of_raised_hands_alone(measured):
    claims = claims_of(measured, 0.1, Config(hand_bias_duration_s=0.5))
    alike = np.exp(-0.1 / 0.5)
    widened = claims.noise[:, 0, 0] / measured.covariance[:, 0, 0]
    assert widened == pytest.approx([(1 + alike) / (1 - alike), 1.0, 1.0, 1.0])
    assert measured.covariance[0, 0, 0] == pytest.approx(0.05**2)


def test_many_looks_at_one_biased_hand_tell_as_much_as_the_mean_of_correlated_errors():
    # Of n errors with correlation rho^|i - j|, the mean's variance times n tends to the factor.
    alike, count = np.exp(-0.1 / 0.5), 4000
    apart = np.abs(np.subtract.outer(np.arange(count), np.arange(count)))
    claims = claims_of(Measurements.bearings(0.0, 1.0), 0.1, Config(hand_bias_duration_s=0.5))
    expected = (alike**apart).mean() * count
    assert claims.noise[0, 0, 0] == pytest.approx(expected, rel=0.01)


def test_a_bearing_is_never_wider_than_a_full_turn():
    claims = claims_of(Measurements.bearings(0.0, 3.0), 0.0, Config(hand_bias_duration_s=5.0))
    assert claims.noise[0, 0, 0] == pytest.approx((2 * np.pi) ** 2)


@pytest.mark.parametrize("hand_bias_duration_s", [0.0, 1.0])
def test_however_arrays_lie_in_memory_claims_are_read_only_and_row_by_row(
    measured, hand_bias_duration_s
):
    broad = np.broadcast_to(np.diag([0.1, 0.1, 0.01]), (4, 3, 3))
    measured = replace(
        measured,
        values=np.asfortranarray(measured.values),
        covariance=np.asfortranarray(measured.covariance),
        raised=np.repeat(measured.raised, 2)[::2],
        sensor_pose_covariance=broad,
    )
    claims = claims_of(measured, 0.1, Config(hand_bias_duration_s=hand_bias_duration_s))
    for name, each in zip(Claims._fields, claims, strict=True):
        assert each.flags.c_contiguous, name
        assert not each.flags.writeable, name
    assert (claims.doubt == broad).all()
    assert (claims.values[:2] == measured.values[:2])[:, 0].all()
